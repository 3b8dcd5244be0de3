"""Paths of the platform: pose as a function of the way along the path.

Ball-bar geometry (thesis chapter 2, `geometry.md`): the ball on the platform is at b = cup + R_plane (r cos φ, r sin
φ, 0), and the platform reference point at p = b - R(rpy) · ball_offset, with R = Rz(yaw) Ry(pitch) Rx(roll).
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
"""A turn of the platform counts as the way of a point this far from its reference point."""
PARALLEL = 1e-12
"""Sine below which two bars count as parallel."""


@dataclass(frozen=True)
class PosePath:
    """A path and its length.

    Attributes
    ----------
    length_mm : length of the path
    poses : way along the path (n,) mm -> position (n, 3) mm, rpy (n, 3) rad
    """

    length_mm: float
    poses: Callable[[Array], Poses]


def circle_poses(run: CircleRun, angle_rad: Array, radius_mm: Array) -> Poses:
    """Poses with the ball at polar angles (n,) and distances (n,) from the cup, platform orientation held."""
    cup = np.asarray(run.mount.cup_mm, dtype=float)
    on_circle = run.circle.ball_mm(angle_rad, cup) - cup
    bar = on_circle * np.reshape(radius_mm / run.circle.radius_mm, (-1, 1))
    return _carrying(run, bar, run.circle.platform_rpy_rad[None, :])


def radial(run: CircleRun, angle_rad: float, from_radius_mm: float, to_radius_mm: float) -> PosePath:
    """Straight in or out along the bar at one polar angle."""
    length_mm = abs(to_radius_mm - from_radius_mm)
    sign = np.sign(to_radius_mm - from_radius_mm)

    def poses(u_mm: Array) -> Poses:
        return circle_poses(run, np.full_like(u_mm, angle_rad), from_radius_mm + sign * u_mm)

    return PosePath(length_mm, poses)


def along_the_bar(run: CircleRun, begin: Poses, end: Poses) -> PosePath:
    """From one pose to another with the ball at a constant distance from the cup, so that the bar may stay mounted.

    Both poses belong to circles of one mount, radius and ball offset; the ball goes along a great circle about the cup.
    """
    rpy0, rpy1 = begin[1], end[1]
    bar0, bar1 = _bar(run, begin), _bar(run, end)
    radius_mm = float(np.linalg.norm(bar0))
    axis0 = bar0 / radius_mm
    across = bar1 / np.linalg.norm(bar1) - axis0 * float(axis0 @ bar1) / float(np.linalg.norm(bar1))
    sine = float(np.linalg.norm(across))
    turn_rad = float(np.arctan2(sine, axis0 @ bar1 / np.linalg.norm(bar1)))
    axis1 = across / sine if sine > PARALLEL else _any_normal(axis0)
    length_mm = max(turn_rad * radius_mm, ROTATION_ARM_MM * float(np.linalg.norm(rpy1[0] - rpy0[0])))

    def poses(u_mm: Array) -> Poses:
        share = (u_mm / length_mm)[:, None]
        bars = radius_mm * (np.cos(share * turn_rad) * axis0 + np.sin(share * turn_rad) * axis1)
        return _carrying(run, bars, rpy0 + share * (rpy1 - rpy0))

    return PosePath(length_mm, poses)


def straight(begin: Poses, end: Poses) -> PosePath:
    """Straight line of the platform reference point, roll, pitch and yaw in proportion."""
    (p0, rpy0), (p1, rpy1) = begin, end
    length_mm = max(float(np.linalg.norm(p1 - p0)), ROTATION_ARM_MM * float(np.linalg.norm(rpy1 - rpy0)))

    def poses(u_mm: Array) -> Poses:
        share = (u_mm / length_mm)[:, None]
        return p0 + share * (p1 - p0), rpy0 + share * (rpy1 - rpy0)

    return PosePath(length_mm, poses)


def _carrying(run: CircleRun, bar: Array, rpy_rad: Array) -> Poses:
    """Poses whose ball is `bar` (n, 3) away from the cup, platform held at `rpy_rad` (n, 3) or (1, 3)."""
    offset = rotation_from_rpy(rpy_rad) @ np.asarray(run.circle.ball_offset_mm, dtype=float)
    return np.asarray(run.mount.cup_mm, dtype=float) + bar - offset, np.broadcast_to(rpy_rad, bar.shape)


def _bar(run: CircleRun, pose: Poses) -> Array:
    """Give the vector (3,) from the cup to the ball at one pose."""
    offset = rotation_from_rpy(pose[1][0]) @ np.asarray(run.circle.ball_offset_mm, dtype=float)
    return np.asarray(pose[0][0] + offset - np.asarray(run.mount.cup_mm, dtype=float), dtype=np.float64)


def _any_normal(axis: Array) -> Array:
    """Some unit vector across `axis`."""
    across = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    return np.asarray(across / np.linalg.norm(across), dtype=np.float64)
