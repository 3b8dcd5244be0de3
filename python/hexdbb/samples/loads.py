"""What of a leg's force a drive and a carriage feel: its parts along the guideway and across it.

A screw yields, and a drive falls behind, by what pushes along its guideway; a carriage tips by what presses across.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LOADS = ("drive_load", "carriage_load")
LOADS_FROM = ("leg_force", "slider_joint_angle_rad")
"""Columns that these follow from."""


def load_columns(leg_force: Floats, slider_joint_angle_rad: Floats) -> dict[str, Floats]:
    """Return the columns `LOADS`, each shape (n, 6), per newton of vertical load, tension positive.

    Parameters
    ----------
    leg_force : ndarray, shape (n, 6)
        Axial, per newton of vertical load.
    slider_joint_angle_rad : ndarray, shape (n, 6)
        Between the leg and its guideway's direction.
    """
    along, across = leg_force * np.cos(slider_joint_angle_rad), leg_force * np.sin(slider_joint_angle_rad)
    return dict(zip(LOADS, (along, across), strict=True))
