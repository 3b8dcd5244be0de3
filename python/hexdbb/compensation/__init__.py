"""Compensation: a model as a controller loads it, paths and tables of targets corrected by it."""

from hexdbb.compensation.file import (
    MAX_CORRECTION_MM,
    POSE_COLUMNS,
    REVERSAL_TRAVEL_MM,
    SUFFIX,
    PathTargets,
    fitted_temperature_c,
    make_compensation,
    path_targets,
    read_compensation,
    read_poses,
    sliders_csv,
    write_text,
)
from hexdbb.compensation.targets import CompensatedTargets, sides, uniform_smooth

__all__ = [
    "MAX_CORRECTION_MM",
    "POSE_COLUMNS",
    "REVERSAL_TRAVEL_MM",
    "SUFFIX",
    "CompensatedTargets",
    "PathTargets",
    "fitted_temperature_c",
    "make_compensation",
    "path_targets",
    "read_compensation",
    "read_poses",
    "sides",
    "sliders_csv",
    "uniform_smooth",
    "write_text",
]
