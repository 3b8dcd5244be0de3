"""The way from where the sliders stand to where a programme begins.

Model: straight in position and in roll, pitch and yaw, at rest at both ends, every pose checked. It begins with the
pose that would have brought the sliders to where they stand, compensation included, so that nothing jumps, and ends
with every slider coming from the side on which the programme begins.
Assumption users get wrong: no bar is mounted on this way.
"""

from __future__ import annotations

import numpy as np

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.trajectory.limits import TRAVEL_SHARES, path_limits, slow_enough
from hexdbb.trajectory.poses import Array, Poses, straight
from hexdbb.trajectory.programme import Phase, Programme, Stretch, Table, Tabulator
from hexdbb.trajectory.runs import SAME_POSE_MM, SETTLE_S
from hexdbb.trajectory.time_law import rest_to_rest

START_TOLERANCE_MM = 1e-3
"""The table's first row may be this far from where a slider stands."""
NO_SIDE = np.zeros(6)
"""Nobody knows from which side a slider came to where it stands."""


def approach(sliders_mm: Array, programme: Programme, machine: MachineFile, origin: str) -> Table:
    """Compute the targets from where the sliders stand to the first row of a programme, at rest there.

    Parameters
    ----------
    sliders_mm : (6,) where the sliders stand
    programme : what comes next
    machine : its motion limits
    origin : names the plan in errors

    Raises
    ------
    InputError
        The sliders stand where the machine has no pose, or the straight way is out of reach.
    """
    here, nowhere = programme.targets.pose(sliders_mm)
    if nowhere is not None:
        raise InputError(f"{_stand(sliders_mm)}: {nowhere}")
    first = programme.targets.sliders(*here, programme.cycle_s, NO_SIDE, NO_SIDE)
    if first.refused is not None or np.abs(first.sliders_mm[0] - sliders_mm).max() > START_TOLERANCE_MM:
        why = first.refused[1] if first.refused is not None else "another pose (expected one within travel and gap)"
        raise InputError(f"{_stand(sliders_mm)}: {why}")
    path = straight(here, programme.first_pose)
    tabulator = Tabulator(programme.runs, machine, programme.cycle_s, origin, programme.targets)

    def made(share: float) -> Table:
        poses = here
        if path.length_mm > SAME_POSE_MM:
            limits = path_limits(path, machine, share, lambda _: f"{origin}: approach")
            poses = path.poses(rest_to_rest(path.length_mm, limits, programme.cycle_s))
        move = Stretch.uncaptured(Phase.APPROACH, -1, poses)
        ways = [_rest(here, programme.cycle_s), move, _rest(move.end, programme.cycle_s)]
        return tabulator.tabulate(ways, before=NO_SIDE, after=programme.first_side)[0]

    return slow_enough([share for share in TRAVEL_SHARES if share <= programme.share], made)


def _rest(pose: Poses, cycle_s: float) -> Stretch:
    position_mm, rpy_rad = pose
    rows = max(1, round(SETTLE_S / cycle_s))
    return Stretch.uncaptured(Phase.SETTLE, -1, (np.tile(position_mm, (rows, 1)), np.tile(rpy_rad, (rows, 1))))


def _stand(sliders_mm: Array) -> str:
    return "sliders stand at " + ", ".join(f"{s:.3f}" for s in sliders_mm) + " mm"
