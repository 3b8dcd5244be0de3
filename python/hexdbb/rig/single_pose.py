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


Ends = Sequence[tuple[Sequence[float], Sequence[float], float]]
"""Slider joint (base frame), platform joint (platform frame) and length of each leg, mm."""

STEP_TOLERANCE = 1e-6
"""Largest last step, mm and rad. The remaining error is this step times the one before it, over the leg length."""
REUSE_STEP = 2e-3
"""Largest step after which the Jacobian is used again, mm and rad: the next step is then below 1e-8, and the remaining
error below 1e-13 mm, the rounding of a leg length."""
MAX_ITERATIONS = 50
"""Iterations after which there is no pose; a nearby guess needs two or three."""


def ends_of(slider_joints_mm: Array, platform_joints_mm: Array, lengths_mm: Array) -> Ends:
    """Return the ends of the legs between joints of shape (6, 3), and their lengths, shape (6,)."""
    return [*zip(slider_joints_mm.tolist(), platform_joints_mm.tolist(), lengths_mm.tolist(), strict=True)]


def solved(ends: Ends, position: Vector, rotation: Rotation) -> tuple[Vector, Rotation] | None:
    """Return the pose that satisfies the leg lengths, from one nearby; None where there is none."""
    inverse: Array | None = None
    for _ in range(MAX_ITERATIONS):
        if inverse is None:
            try:
                missing_mm, inverse = _linearised(ends, position, rotation)
            except np.linalg.LinAlgError:
                return None
        else:
            missing_mm = missing(ends, position, rotation)
        u, v, w, *turn = (inverse @ missing_mm).tolist()
        x, y, z = position
        position, rotation = (x + u, y + v, z + w), turned(rotation, turn)
        largest = max(u, v, w, *turn, -min(u, v, w, *turn))
        if largest < STEP_TOLERANCE:
            return position, orthonormal(rotation)
        if not math.isfinite(largest):
            return None
        if largest > REUSE_STEP:
            inverse = None
    return None


def missing(ends: Ends, position: Vector, rotation: Rotation) -> list[float]:
    """Return the leg lengths minus the distances of their joints at a pose, mm."""
    x, y, z = position
    (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = rotation
    sqrt = math.sqrt
    found = []
    for (bx, by, bz), (qx, qy, qz), length in ends:
        u = r00 * qx + r01 * qy + r02 * qz + x - bx
        v = r10 * qx + r11 * qy + r12 * qz + y - by
        w = r20 * qx + r21 * qy + r22 * qz + z - bz
        found.append(length - sqrt(u * u + v * v + w * w))
    return found


def _linearised(ends: Ends, position: Vector, rotation: Rotation) -> tuple[list[float], Array]:
    """Return what is `missing`, and the inverse (6, 6) of the distances' derivatives by position and rotation.

    Raises
    ------
    numpy.linalg.LinAlgError
        The pose is singular.
    """
    x, y, z = position
    (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = rotation
    sqrt = math.sqrt
    found, rows = [], []
    for (bx, by, bz), (qx, qy, qz), length in ends:
        a = r00 * qx + r01 * qy + r02 * qz
        b = r10 * qx + r11 * qy + r12 * qz
        c = r20 * qx + r21 * qy + r22 * qz
        u, v, w = a + x - bx, b + y - by, c + z - bz
        reach = sqrt(u * u + v * v + w * w)
        found.append(length - reach)
        u, v, w = u / reach, v / reach, w / reach
        rows.append((u, v, w, b * w - c * v, c * u - a * w, a * v - b * u))
    inverse: Array = np.linalg.inv(np.array(rows))
    return found, inverse


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
    (a, b, c), (d, e, f), (g, h, i) = rotation
    p, q, r = -0.5 * (a * b + d * e + g * h), -0.5 * (a * c + d * f + g * i), -0.5 * (b * c + e * f + h * i)
    u = 1.5 - 0.5 * (a * a + d * d + g * g)
    v = 1.5 - 0.5 * (b * b + e * e + h * h)
    w = 1.5 - 0.5 * (c * c + f * f + i * i)
    return _product(rotation, ((u, p, q), (p, v, r), (q, r, w)))


def bar_mm(position: Vector, rotation: Rotation, ball: Vector, cup: Vector) -> float:
    """Return the distance of the ball (platform frame) and the cup (base frame) at a pose, mm."""
    (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = rotation
    x, y, z = ball
    u = r00 * x + r01 * y + r02 * z + position[0] - cup[0]
    v = r10 * x + r11 * y + r12 * z + position[1] - cup[1]
    w = r20 * x + r21 * y + r22 * z + position[2] - cup[2]
    return math.sqrt(u * u + v * v + w * w)


def _product(one: Rotation, other: Rotation) -> Rotation:
    (a, b, c), (d, e, f), (g, h, i) = other
    (u, v, w), (p, q, r), (x, y, z) = one
    return (
        (u * a + v * d + w * g, u * b + v * e + w * h, u * c + v * f + w * i),
        (p * a + q * d + r * g, p * b + q * e + r * h, p * c + q * f + r * i),
        (x * a + y * d + z * g, x * b + y * e + z * h, x * c + y * f + z * i),
    )
