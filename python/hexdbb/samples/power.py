"""What each drive does to its carriage's motion: positive where it speeds up, negative where it brakes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

POWER = "power_mm2_s3"
POWER_FROM = ("velocity_mm_s", "acceleration_mm_s2")
"""Columns that it follows from."""


def power_mm2_s3(velocity_mm_s: Floats, acceleration_mm_s2: Floats) -> Floats:
    """Return velocity times acceleration, the power of a drive per mass; both of shape (n, 6)."""
    return np.asarray(velocity_mm_s * acceleration_mm_s2)
