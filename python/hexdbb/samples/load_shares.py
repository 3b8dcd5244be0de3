"""How a load on the platform is shared among the legs: what a hose that pulls, a spring or a cable does to them.

In equilibrium the forces of the legs, each along its leg's unit vector u at the lever arm r, hold the load: the sum of
f u is the pull, that of f (r x u) the couple (Merlet, Parallel Robots, 2006, 9.1: J^-T). Legs are elastic, so that each
yields in proportion to its force.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.kinematics.legs import Legs
from hexdbb.machine import MachineFile

Floats = NDArray[np.float64]

SHARES = {f"force_by_pull_{axis}": f"a pull of 1 N on the platform along {axis}" for axis in "xyz"} | {
    f"force_by_turn_{axis}": f"a couple on it about {axis}, of 1 N at the radius of its joints" for axis in "xyz"
}
"""Columns, and the loads that they are by. So both sorts are of one size."""
SINGULAR = 1e-6
"""Determinant below which a pose counts as singular: legs would bear thousands of times the load."""


def load_shares(machine: MachineFile, legs: Legs) -> dict[str, Floats]:
    """Return the columns `SHARES`, shape (n, 6) each: axial forces of the legs, tension positive; nan where singular.

    Parameters
    ----------
    machine : MachineFile
    legs : Legs
        At n poses.

    Returns
    -------
    dict of str to ndarray
        Of pulls at the platform's reference point.
    """
    turning = np.cross(legs.lever_mm, legs.unit) / machine.platform.circumradius_mm
    held = np.concatenate([legs.unit, turning], axis=2).transpose(0, 2, 1)
    forces = np.full_like(held, np.nan)
    whole = np.isfinite(held).all(axis=(1, 2))
    whole[whole] = np.abs(np.linalg.det(held[whole])) > SINGULAR
    forces[whole] = np.linalg.inv(held[whole])
    return {name: forces[:, :, axis] for axis, name in enumerate(SHARES)}
