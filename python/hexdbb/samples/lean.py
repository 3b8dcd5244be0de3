"""How the platform leans: where gravity points in its frame, by which what hangs loosely on it sinks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.kinematics import rotation_from_rpy

Floats = NDArray[np.float64]

GRAVITY, TILT = "gravity_in_platform", "tilt_rad"
LEANS = (GRAVITY, TILT)
LEANS_FROM = ("platform_rpy_rad",)
"""Columns that these follow from."""


def leans(platform_rpy_rad: Floats) -> dict[str, Floats]:
    """Return the columns `LEANS`: gravity's direction, a unit vector, and the platform's angle to the vertical.

    Parameters
    ----------
    platform_rpy_rad : ndarray, shape (n, 3)
    """
    rotation = rotation_from_rpy(platform_rpy_rad)
    down: Floats = -rotation[:, 2, :]
    aside = np.hypot(down[:, 0], down[:, 1])
    return {GRAVITY: down, TILT: np.arctan2(aside, -down[:, 2])}
