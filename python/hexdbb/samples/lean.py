"""How the platform leans: where gravity points in its frame, by which what hangs loosely on it sinks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.kinematics import rotation_from_rpy

Floats = NDArray[np.float64]

GRAVITY, TILT, DOWNHILL = "gravity_in_platform", "tilt_rad", "downhill_in_platform"
LEANS = (GRAVITY, TILT, DOWNHILL)
LEANS_FROM = ("platform_rpy_rad",)
"""Columns that these follow from."""
LEAST_TILT_RAD = 1e-3
"""Tilt below which a platform counts as level and leans in no direction: following errors of a tenth of a millimetre
tilt it by as much, and would set the direction."""


def leans(platform_rpy_rad: Floats) -> dict[str, Floats]:
    """Return the columns `LEANS`: gravity's direction, a unit vector, the angle to the vertical, and downhill.

    The last is the unit vector in the platform's x-y plane towards its lower side; zero where it is level.

    Parameters
    ----------
    platform_rpy_rad : ndarray, shape (n, 3)
    """
    rotation = rotation_from_rpy(platform_rpy_rad)
    down: Floats = -rotation[:, 2, :]
    aside = np.hypot(down[:, 0], down[:, 1])
    leans_at_all = aside > LEAST_TILT_RAD
    downhill = np.zeros_like(down)
    downhill[:, :2] = np.where(leans_at_all[:, None], down[:, :2] / np.where(leans_at_all, aside, 1.0)[:, None], 0.0)
    return {GRAVITY: down, TILT: np.arctan2(aside, -down[:, 2]), DOWNHILL: downhill}
