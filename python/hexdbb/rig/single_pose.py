"""Pose of the platform at one instant: the iteration of `pose_solver` in plain numbers.

A rig that is clocked by SYNC asks for one pose at a time. Of six legs NumPy's calls take several times what their
arithmetic does in plain numbers; only the inverse is left to it. Both agree to rounding (tests).
Units: mm, rad.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from hexdbb.rig.geometry import Array

Vector = tuple[float, float, float]
Rotation = tuple[Vector, Vector, Vector]
"""Rows of the matrix."""


class Legs:
    """Six legs between points that do not move while the pose is sought.

    Parameters
    ----------
    slider_joints_mm : (6, 3) array
        Base frame, mm.
    platform_joints_mm : (6, 3) array
        Platform frame, mm.
    lengths_mm : (6,) array
    """

    def __init__(self, slider_joints_mm: Array, platform_joints_mm: Array, lengths_mm: Array) -> None:
        self._ends = [*zip(slider_joints_mm.tolist(), platform_joints_mm.tolist(), lengths_mm.tolist(), strict=True)]

    def missing_mm(self, position: Vector, rotation: Rotation) -> list[float]:
        """Return the leg lengths minus the distances of their joints at a pose."""
        x, y, z = position
        (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = rotation
        sqrt = math.sqrt
        found = []
        for (bx, by, bz), (qx, qy, qz), length in self._ends:
            u = r00 * qx + r01 * qy + r02 * qz + x - bx
            v = r10 * qx + r11 * qy + r12 * qz + y - by
            w = r20 * qx + r21 * qy + r22 * qz + z - bz
            found.append(length - sqrt(u * u + v * v + w * w))
        return found

    def inverse(self, position: Vector, rotation: Rotation) -> Array:
        """Return the inverse of the derivatives of the distances by position and rotation, (6, 6).

        Raises
        ------
        numpy.linalg.LinAlgError
            The pose is singular.
        """
        x, y, z = position
        (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = rotation
        rows = []
        for (bx, by, bz), (qx, qy, qz), _ in self._ends:
            a = r00 * qx + r01 * qy + r02 * qz
            b = r10 * qx + r11 * qy + r12 * qz
            c = r20 * qx + r21 * qy + r22 * qz
            u, v, w = a + x - bx, b + y - by, c + z - bz
            reach = math.sqrt(u * u + v * v + w * w)
            u, v, w = u / reach, v / reach, w / reach
            rows.append((u, v, w, b * w - c * v, c * u - a * w, a * v - b * u))
        found: Array = np.linalg.inv(np.array(rows))
        return found


def turned(rotation: Rotation, by_rad: Sequence[float]) -> Rotation:
    """Return Cayley's map of a rotation vector times a rotation (`pose_solver`)."""
    a, b, c = 0.5 * by_rad[0], 0.5 * by_rad[1], 0.5 * by_rad[2]
    scale = 2.0 / (1.0 + a * a + b * b + c * c)
    turn = (
        (1.0 - scale * (b * b + c * c), scale * (a * b - c), scale * (a * c + b)),
        (scale * (a * b + c), 1.0 - scale * (a * a + c * c), scale * (b * c - a)),
        (scale * (a * c - b), scale * (b * c + a), 1.0 - scale * (a * a + b * b)),
    )
    return _product(turn, rotation)


def orthonormal(rotation: Rotation) -> Rotation:
    """Return a rotation without the rounding of many samples (`pose_solver`)."""
    columns = tuple(zip(*rotation, strict=True))
    rest = [[-0.5 * (a * d + b * e + c * f) for d, e, f in columns] for a, b, c in columns]
    for axis in range(3):
        rest[axis][axis] += 1.5
    (a, b, c), (d, e, f), (g, h, i) = rest
    return _product(rotation, ((a, b, c), (d, e, f), (g, h, i)))


def bar_mm(position_mm: Array, rotation: Array, ball_mm: Array, cup_mm: Array) -> float:
    """Return the distance of ball and cup, mm.

    Parameters
    ----------
    position_mm : (3,) array
        Platform, base frame.
    rotation : (3, 3) array
    ball_mm, cup_mm : (3,) array
        Platform frame; base frame.
    """
    qx, qy, qz = ball_mm.tolist()
    ends = zip(rotation.tolist(), position_mm.tolist(), cup_mm.tolist(), strict=True)
    u, v, w = [a * qx + b * qy + c * qz + at - cup for (a, b, c), at, cup in ends]
    return math.sqrt(u * u + v * v + w * w)


def _product(one: Rotation, other: Rotation) -> Rotation:
    (a, b, c), (d, e, f), (g, h, i) = other
    first, second, third = [(u * a + v * d + w * g, u * b + v * e + w * h, u * c + v * f + w * i) for u, v, w in one]
    return first, second, third
