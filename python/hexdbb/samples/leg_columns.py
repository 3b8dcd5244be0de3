"""Columns that follow from where the six legs of the nominal machine stand: how they share a load, where they point."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.kinematics import rotation_from_rpy
from hexdbb.kinematics.legs import Legs
from hexdbb.machine import MachineFile
from hexdbb.samples.leg_directions import LEG_DIRECTIONS, leg_directions
from hexdbb.samples.load_shares import SHARES, load_shares

Floats = NDArray[np.float64]

OF_LEGS = (*SHARES, *LEG_DIRECTIONS)
"""Columns, each of shape (n, 6)."""
OF_LEGS_FROM = ("position_mm", "platform_rpy_rad", "sliders_mm")
"""Columns that these follow from."""


def leg_columns(
    machine: MachineFile, position_mm: Floats, platform_rpy_rad: Floats, sliders_mm: Floats
) -> dict[str, Floats]:
    """Return the columns `OF_LEGS`.

    Parameters
    ----------
    machine : MachineFile
    position_mm, platform_rpy_rad : ndarray, shape (n, 3)
    sliders_mm : ndarray, shape (n, 6)
    """
    rotation = rotation_from_rpy(platform_rpy_rad)
    legs = Legs.at(machine, position_mm, rotation, sliders_mm)
    return load_shares(machine, legs) | leg_directions(machine, legs, rotation)
