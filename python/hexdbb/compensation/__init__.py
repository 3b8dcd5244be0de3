"""Compensation: a model as a controller loads it, paths and tables of slider targets corrected by it.

`file` makes, writes and reads compensation files; `tables` and `own_tables` state learned and users' effects as tables,
the latter by asking them in the states of `probe`; `path` corrects a path pose by pose; `targets` corrects whole tables
and looks ahead at `reversals`; `csv_tables` reads poses and writes slider coordinates.
"""

from hexdbb.compensation.csv_tables import POSE_COLUMNS, read_poses, sliders_csv
from hexdbb.compensation.file import (
    MAX_CORRECTION_MM,
    REVERSAL_TRAVEL_MM,
    SUFFIX,
    make_compensation,
    read_compensation,
    reference_temperature_of,
    write_compensation,
)
from hexdbb.compensation.path import PathTargets, path_targets
from hexdbb.compensation.reversals import smooth_changes, travel_directions
from hexdbb.compensation.targets import CompensatedTargets

__all__ = [
    "MAX_CORRECTION_MM",
    "POSE_COLUMNS",
    "REVERSAL_TRAVEL_MM",
    "SUFFIX",
    "CompensatedTargets",
    "PathTargets",
    "make_compensation",
    "path_targets",
    "read_compensation",
    "read_poses",
    "reference_temperature_of",
    "sliders_csv",
    "smooth_changes",
    "travel_directions",
    "write_compensation",
]
