"""How far the platform is from the machine's axis: what pulls, or gives way, farther out goes by that."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

RADIUS = "radius_mm"
RADIUS_FROM = "position_mm"


def radii_mm(position_mm: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the distance of positions, shape (n, 3), from the z axis of the base frame, shape (n,)."""
    return np.hypot(position_mm[:, 0], position_mm[:, 1])
