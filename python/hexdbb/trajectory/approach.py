"""The way from where the sliders stand to where a programme begins.

Model: straight in position and in roll, pitch and yaw, at rest at both ends, every pose checked by inverse kinematics.
Assumption users get wrong: no bar is mounted on this way.
"""

from __future__ import annotations

import math

import numpy as np

from hexdbb.errors import InputError
from hexdbb.kinematics import forward, inverse, rpy_from_rotation, status_name
from hexdbb.machine import MachineFile
from hexdbb.trajectory.limits import path_limits
from hexdbb.trajectory.poses import Array, straight
from hexdbb.trajectory.programme import Phase, Programme, Stretch, Table, describe, tabulate
from hexdbb.trajectory.runs import SAME_POSE_MM, SETTLE_S
from hexdbb.trajectory.time_law import rest_to_rest

START_TOLERANCE_MM = 1e-3
"""The table's first row may be this far from where a slider stands."""


def approach(sliders_mm: Array, programme: Programme, machine: MachineFile, origin: str) -> Table:
    """Compute the targets from where the sliders stand to the first row of a programme, at rest there.

    Parameters
    ----------
    sliders_mm : (6,) where the sliders stand
    programme : what comes next
    machine : nominal machine
    origin : names the plan in errors

    Raises
    ------
    InputError
        The sliders stand where the nominal machine has no pose, or the straight way is out of reach.
    """
    position_mm, rotation, status = forward(machine, sliders_mm[None, :])
    if status[0]:
        raise InputError(
            f"{_stand(sliders_mm)}: {status_name(int(status[0]))} (expected a pose of the nominal machine)"
        )
    here = (position_mm, rpy_from_rotation(rotation[0])[None, :])
    first, status = inverse(machine, *here)
    if status[0] or np.abs(first[0] - sliders_mm).max() > START_TOLERANCE_MM:
        raise InputError(f"{_stand(sliders_mm)}: {status_name(int(status[0]))} (expected a pose within travel and gap)")
    path = straight(here, programme.first_pose)
    poses = here
    if path.length_mm > SAME_POSE_MM:
        limits = path_limits(path, machine, lambda _: describe(origin, programme.runs, Phase.APPROACH, -1, math.nan))
        poses = path.poses(rest_to_rest(path.length_mm, limits, programme.cycle_s))
    move = Stretch.uncaptured(Phase.APPROACH, -1, poses)
    rest = max(1, round(SETTLE_S / programme.cycle_s))
    stand = Stretch.uncaptured(Phase.SETTLE, -1, (np.tile(move.end[0], (rest, 1)), np.tile(move.end[1], (rest, 1))))
    return tabulate([move, stand], programme.runs, machine, programme.cycle_s, origin)


def _stand(sliders_mm: Array) -> str:
    return "sliders stand at " + ", ".join(f"{s:.3f}" for s in sliders_mm) + " mm"
