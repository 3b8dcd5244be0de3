"""Motion of the other slider on the guideway: what one carriage does may multiply what the other suffers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

NEIGHBOURS = {f"neighbour_{each}": each for each in ("velocity_mm_s", "acceleration_mm_s2", "travel_direction")}
"""Columns of the other slider, each with the column that holds it for the slider itself."""


def of_neighbours(column: NDArray[Any]) -> NDArray[Any]:
    """Return a column of sliders, shape (n, 6), with those of each guideway exchanged."""
    return column[:, np.arange(column.shape[1]) ^ 1]
