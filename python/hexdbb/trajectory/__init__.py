"""Cyclic slider targets of a plan, one row per SYNC, computed and checked before anything moves.

A sweep is feed-in, overshoot, captured laps, overshoot, retract, within velocity, acceleration and jerk limits of every
slider. Time laws are computed by ruckig, kinematics by the engine; `Targets` maps poses to slider targets.
"""

from hexdbb.trajectory.approach import approach
from hexdbb.trajectory.extent import ROWS_MAX, Extent, require_extent
from hexdbb.trajectory.programme import Programme
from hexdbb.trajectory.runs import plan_programme
from hexdbb.trajectory.segments import Phase
from hexdbb.trajectory.table import Table
from hexdbb.trajectory.targets import NominalTargets, PoseRows, TargetParts, TargetRows, Targets

__all__ = [
    "ROWS_MAX",
    "Extent",
    "NominalTargets",
    "Phase",
    "PoseRows",
    "Programme",
    "Table",
    "TargetParts",
    "TargetRows",
    "Targets",
    "approach",
    "plan_programme",
    "require_extent",
]
