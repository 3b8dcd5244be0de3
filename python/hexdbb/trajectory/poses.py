"""Paths of the platform: pose as a function of the path length travelled.

Formula (thesis chapter 2): the ball on the platform is at b = cup + R_plane (r cos φ, r sin φ, 0), and the platform
reference point at p = b - R(rpy) · ball_offset, with R = Rz(yaw) Ry(pitch) Rx(roll).
Assumption users get wrong: φ is the polar angle in the circle's own plane, counted from its x axis; direction +1 is
counter-clockwise seen from above that plane.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.kinematics import rotation_from_rpy
from hexdbb.plan import CircleRun

Array = NDArray[np.float64]
Poses = tuple[Array, Array]
"""Position (n, 3) mm of the platform reference point and roll, pitch, yaw (n, 3) rad."""

ROTATION_ARM_MM = 300.0
"""Radius at which a rotation of the platform counts as path length, so that a pure rotation has a length too: about the
extent of the platform and the bar; rotations are scaled by 1/300 mm in condition numbers too."""
PARALLEL_SINE = 1e-12
"""Limits the sine of the angle below which two bars count as parallel: above the rounding of unit vectors (1e-16), and
a turn by this angle moves the ball of a 100 mm bar by 1e-10 mm only."""


@dataclass(frozen=True)
class PosePath:
    """A path and its length.

    Attributes
    ----------
    length_mm : length of the path
    poses : path length travelled (n,) mm -> position (n, 3) mm, roll, pitch, yaw (n, 3) rad
    """

    length_mm: float
    poses: Callable[[Array], Poses]


def circle_poses(run: CircleRun, angle_rad: Array, radius_mm: Array) -> Poses:
    """Compute poses with the ball at polar angles (n,) and distances (n,) from the cup, platform orientation held."""
    cup = np.asarray(run.mount.cup_mm, dtype=float)
    on_circle = run.circle.ball_mm(angle_rad, cup) - cup
    bar = on_circle * np.reshape(radius_mm / run.circle.radius_mm, (-1, 1))
    return _poses_with_ball_at(run, bar, run.circle.platform_rpy_rad[None, :])


def radial_path(run: CircleRun, angle_rad: float, from_radius_mm: float, to_radius_mm: float) -> PosePath:
    """Return the straight path along the bar, inwards or outwards, at one polar angle."""
    length_mm = abs(to_radius_mm - from_radius_mm)
    sign = np.sign(to_radius_mm - from_radius_mm)

    def poses(u_mm: Array) -> Poses:
        return circle_poses(run, np.full_like(u_mm, angle_rad), from_radius_mm + sign * u_mm)

    return PosePath(length_mm, poses)


def constant_bar_path(run: CircleRun, begin: Poses, end: Poses) -> PosePath:
    """Return the path between two poses with the ball at a constant distance from the cup: the bar may stay mounted.

    Both poses belong to circles of one mount, radius and ball offset; the ball moves on a great circle about the cup.
    """
    rpy0, rpy1 = begin[1], end[1]
    bar0, bar1 = _bar_vector(run, begin), _bar_vector(run, end)
    radius_mm = float(np.linalg.norm(bar0))
    axis0 = bar0 / radius_mm
    across = bar1 / np.linalg.norm(bar1) - axis0 * float(axis0 @ bar1) / float(np.linalg.norm(bar1))
    sine = float(np.linalg.norm(across))
    turn_rad = float(np.arctan2(sine, axis0 @ bar1 / np.linalg.norm(bar1)))
    axis1 = across / sine if sine > PARALLEL_SINE else _any_normal(axis0)
    length_mm = max(turn_rad * radius_mm, ROTATION_ARM_MM * float(np.linalg.norm(rpy1[0] - rpy0[0])))

    def poses(u_mm: Array) -> Poses:
        part = (u_mm / length_mm)[:, None]
        bars = radius_mm * (np.cos(part * turn_rad) * axis0 + np.sin(part * turn_rad) * axis1)
        return _poses_with_ball_at(run, bars, rpy0 + part * (rpy1 - rpy0))

    return PosePath(length_mm, poses)


def straight_path(begin: Poses, end: Poses) -> PosePath:
    """Return the straight path between two poses, roll, pitch and yaw interpolated linearly."""
    (p0, rpy0), (p1, rpy1) = begin, end
    length_mm = max(float(np.linalg.norm(p1 - p0)), ROTATION_ARM_MM * float(np.linalg.norm(rpy1 - rpy0)))

    def poses(u_mm: Array) -> Poses:
        part = (u_mm / length_mm)[:, None]
        return p0 + part * (p1 - p0), rpy0 + part * (rpy1 - rpy0)

    return PosePath(length_mm, poses)


def _poses_with_ball_at(run: CircleRun, bar: Array, rpy_rad: Array) -> Poses:
    """Return poses with the ball at `bar` (n, 3), mm, from the cup and orientation `rpy_rad` (n, 3) or (1, 3)."""
    offset = rotation_from_rpy(rpy_rad) @ np.asarray(run.circle.ball_offset_mm, dtype=float)
    return np.asarray(run.mount.cup_mm, dtype=float) + bar - offset, np.broadcast_to(rpy_rad, bar.shape)


def _bar_vector(run: CircleRun, pose: Poses) -> Array:
    """Return the vector (3,) from the cup to the ball at one pose, mm."""
    offset = rotation_from_rpy(pose[1][0]) @ np.asarray(run.circle.ball_offset_mm, dtype=float)
    return np.asarray(pose[0][0] + offset - np.asarray(run.mount.cup_mm, dtype=float), dtype=np.float64)


def _any_normal(axis: Array) -> Array:
    """Return a unit vector (3,) normal to `axis`."""
    across = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    return np.asarray(across / np.linalg.norm(across), dtype=np.float64)
