"""Distance between the carriages of a guideway: bellows between them push by it, covers rub by its rate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

GAPS = {"gap_mm": "sliders_mm", "gap_rate_mm_s": "velocity_mm_s"}
"""The distance and its rate, each with the column that it follows from."""


def between(column: Floats) -> Floats:
    """Return what a column of sliders, shape (n, 6), has more at each than at the other one on its guideway."""
    return np.asarray(column - column[:, np.arange(column.shape[1]) ^ 1])
