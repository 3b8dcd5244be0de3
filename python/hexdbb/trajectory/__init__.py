"""A plan's circles as a table of slider targets, one row per SYNC, computed and checked before anything moves.

Feed-in, overshoot, capture laps, overshoot, retract; limits on velocity, acceleration and jerk of every slider. The
time law is ruckig's, the kinematics the engine's; `Targets` says where the sliders go for a pose.
"""

from hexdbb.trajectory.approach import approach
from hexdbb.trajectory.programme import Phase, Programme, Table
from hexdbb.trajectory.runs import plan_programme
from hexdbb.trajectory.targets import NominalTargets, TargetRows, Targets

__all__ = [
    "NominalTargets",
    "Phase",
    "Programme",
    "Table",
    "TargetRows",
    "Targets",
    "approach",
    "plan_programme",
]
