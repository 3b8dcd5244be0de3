"""Kinematics of the nominal machine for NumPy arrays, computed by the engine."""

from hexdbb.kinematics.points import guideway_ends, platform_points, slider_points
from hexdbb.kinematics.poses import engine_machine, forward, inverse, rotation_from_rpy, rpy_from_rotation, status_name

__all__ = [
    "engine_machine",
    "forward",
    "guideway_ends",
    "inverse",
    "platform_points",
    "rotation_from_rpy",
    "rpy_from_rotation",
    "slider_points",
    "status_name",
]
