"""Approach: the path from the sliders' actual positions to the beginning of a programme.

Model: straight in position and in roll, pitch and yaw, at rest at both ends, every pose checked. It begins at the pose
whose targets, compensation included, are the actual positions, so that no target jumps, and ends with the direction of
travel of every slider that the programme begins with.
Assumption users get wrong: the bar is not mounted during the approach.
"""

from __future__ import annotations

import numpy as np

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.trajectory.extent import SETTLE_S
from hexdbb.trajectory.limits import LIMIT_FRACTIONS, fastest_within_limits, path_limits
from hexdbb.trajectory.poses import Array, Poses, straight_path
from hexdbb.trajectory.programme import Programme, Tabulator
from hexdbb.trajectory.runs import SAME_POSE_MM
from hexdbb.trajectory.segments import Phase, Segment
from hexdbb.trajectory.table import Table
from hexdbb.trajectory.time_law import rest_to_rest

START_TOLERANCE_MM = 1e-3
"""Limits the distance of the first row from the actual slider coordinates: ten encoder steps of the shipped machine,
so that no target jumps when the axes are enabled."""
UNKNOWN_TRAVEL = np.zeros(6)
"""Direction of travel of sliders whose earlier motion is not known."""


def approach(sliders_mm: Array, programme: Programme, machine: MachineFile, plan_name: str) -> Table:
    """Compute the targets from the actual slider positions to the first row of a programme.

    Parameters
    ----------
    sliders_mm : ndarray, shape (6,)
        Actual slider coordinates.
    programme : Programme
        Programme that follows.
    machine : MachineFile
        Its motion limits hold.
    plan_name : str
        Name of the plan in errors.

    Returns
    -------
    Table
        Begins and ends at rest.

    Raises
    ------
    InputError
        The machine has no pose for the actual positions, or the straight path is out of reach.
    """
    here, no_pose = programme.targets.pose(sliders_mm)
    if no_pose is not None:
        raise InputError(f"{_positions(sliders_mm)}: {no_pose}")
    first = programme.targets.sliders(*here, programme.cycle_s, UNKNOWN_TRAVEL, UNKNOWN_TRAVEL)
    if first.refused is not None or np.abs(first.sliders_mm[0] - sliders_mm).max() > START_TOLERANCE_MM:
        why = first.refused[1] if first.refused is not None else "another pose (expected one within travel and gap)"
        raise InputError(f"{_positions(sliders_mm)}: {why}")
    path = straight_path(here, programme.first_pose)
    tabulator = Tabulator(programme.runs, machine, programme.cycle_s, plan_name, programme.targets)

    def approach_at(limit_fraction: float) -> Table:
        move = Segment.at_rest(Phase.APPROACH, -1, 1, here)
        if path.length_mm > SAME_POSE_MM:
            where = f"{plan_name}: approach"
            limits = path_limits(path, machine, limit_fraction, lambda _: where)
            law = rest_to_rest(path.length_mm, limits, programme.cycle_s, where)
            move = Segment.uncaptured(
                Phase.APPROACH, -1, law.rows, lambda first, last: path.poses(law.u_mm(first, last))
            )
        segments = [_rest(here, programme.cycle_s), move, _rest(move.end, programme.cycle_s)]
        rows, _ = tabulator.tabulate(segments, before=UNKNOWN_TRAVEL, after=programme.first_travel)
        return rows.part(0, len(rows))

    return fastest_within_limits([each for each in LIMIT_FRACTIONS if each <= programme.limit_fraction], approach_at)


def _rest(pose: Poses, cycle_s: float) -> Segment:
    return Segment.at_rest(Phase.SETTLE, -1, max(1, round(SETTLE_S / cycle_s)), pose)


def _positions(sliders_mm: Array) -> str:
    return "sliders stand at " + ", ".join(f"{s:.3f}" for s in sliders_mm) + " mm"
