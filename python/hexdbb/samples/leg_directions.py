"""The direction of each leg at either end: in two angles a ball is out of round, and its seat worn.

Parts of the leg's unit vector, from slider to platform joint, of the nominal machine, across its direction at home (the
platform level and untwisted over the base centre, half-way up): a horizontal one, and one in the upright plane of that.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.kinematics import inverse
from hexdbb.kinematics.legs import Legs
from hexdbb.machine import MachineFile, home_heights_mm

Floats = NDArray[np.float64]

SQUARED = "_squared"
LEG_DIRECTIONS = {
    "leg_aside_in_platform": "horizontal part of the leg's unit vector across its direction at home, platform frame",
    "leg_tilt_in_platform": "part across both, platform frame",
    f"leg_tilt_in_platform{SQUARED}": "the square of that",
    "leg_aside_in_base": "horizontal part of the leg's unit vector across its direction at home, base frame",
    "leg_tilt_in_base": "part across both, base frame",
    f"leg_tilt_in_base{SQUARED}": "the square of that",
}
"""Columns, and what they are."""


def leg_directions(machine: MachineFile, legs: Legs, rotation: Floats) -> dict[str, Floats]:
    """Return the columns `LEG_DIRECTIONS`, shape (n, 6) each.

    Parameters
    ----------
    machine : MachineFile
    legs : Legs
        At n poses.
    rotation : ndarray, shape (n, 3, 3)
        Of the platform.
    """
    home = _home(machine)
    in_platform = np.einsum("nji,nkj->nki", rotation, legs.unit)
    aside = np.cross([0.0, 0.0, 1.0], home)
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    parts = []
    for unit in (in_platform, legs.unit):
        across, tilt = (np.einsum("nki,ki->nk", unit, axis) for axis in (aside, np.cross(home, aside)))
        parts += [across, tilt, tilt**2]
    return dict(zip(LEG_DIRECTIONS, parts, strict=True))


def _home(machine: MachineFile) -> Floats:
    """Return the legs' unit vectors at home, shape (6, 3)."""
    height_mm = float(np.mean(home_heights_mm(machine))) - machine.platform.joint_plane_height_mm
    position_mm = np.array([[0.0, 0.0, height_mm]])
    sliders_mm, _ = inverse(machine, position_mm, np.zeros((1, 3)))
    found: Floats = Legs.at(machine, position_mm, np.eye(3), sliders_mm).unit[0]
    return found
