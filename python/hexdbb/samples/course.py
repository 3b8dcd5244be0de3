"""The direction in which the platform moves, as a unit vector: friction and play at a joint act against it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.kinematics import rotation_from_rpy

Floats = NDArray[np.float64]

COURSE, COURSE_IN_PLATFORM = "course", "course_in_platform"
COURSE_X, COURSE_Y = "course_x", "course_y"
COURSES = (COURSE, COURSE_IN_PLATFORM, COURSE_X, COURSE_Y)
COURSES_FROM = ("platform_velocity_mm_s", "platform_rpy_rad")
"""Columns that these follow from."""
LEAST_SPEED_MM_S = 0.01
"""Below this speed the steps of the encoders (0.1 µm) set the direction; feeds are a thousand times faster."""


def courses(platform_velocity_mm_s: Floats, platform_rpy_rad: Floats) -> dict[str, Floats]:
    """Return the columns `COURSES`, unit vectors, in the base's frame and in the platform's; zero where it stands.

    Then the former's parts along x and y, shape (n,).

    Parameters
    ----------
    platform_velocity_mm_s, platform_rpy_rad : ndarray, shape (n, 3)
    """
    speed = np.linalg.norm(platform_velocity_mm_s, axis=1, keepdims=True)
    moves = speed > LEAST_SPEED_MM_S
    course = np.where(moves, platform_velocity_mm_s / np.where(moves, speed, 1.0), 0.0)
    in_platform = np.einsum("nij,ni->nj", rotation_from_rpy(platform_rpy_rad), course)
    return dict(zip(COURSES, (course, in_platform, course[:, 0], course[:, 1]), strict=True))
