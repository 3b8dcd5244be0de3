"""Pose of the platform of the true machine: Newton's method on the six pose coordinates, one ball joint per leg.

Model: residuals f_k = |R q_k + p - B_k| - L_k, k = 1 to 6. With a small rotation w in the base frame, R -> C(w) R, the
row of the Jacobian is (n_k, (R q_k) x n_k), n_k the unit vector along leg k; C is Cayley's map, a rotation for every w
and equal to exp([w]x) up to the third order; the choice affects the iterations and not the solution.
Assumption: the platform stays in the assembly mode of the first guess.
All instants of a stretch are solved at once, each from its own first guess; two or three iterations suffice. The
Jacobian of the first serves the following ones where these are small (chord method).
Units: mm, rad, N.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import RunError
from hexdbb.rig.geometry import Array
from hexdbb.rig.single_pose import MAX_ITERATIONS, REUSE_STEP, STEP_TOLERANCE, ends_of, solved

BLOCK = 512
"""Instants solved at once: their Jacobians (150 kB) fit into the processor's cache."""
_IDENTITY, _ONES = np.eye(3), np.ones(3)
_ONE_AND_A_HALF = 1.5 * _IDENTITY
_XYZXY = np.array([0, 1, 2, 0, 1])
"""Axes in cyclic order: a vector product is the difference of two products of slices."""
_SKEW = np.array([[0, 0, 0, 0, 0, -1, 0, 1, 0], [0, 0, 1, 0, 0, 0, -1, 0, 0], [0, -1, 0, 1, 0, 0, 0, 0, 0]], float)
"""Matrices [x]x, [y]x and [z]x of the unit vectors, row by row."""


class NoPoseError(RunError):
    """No pose satisfies the leg lengths; `instant` is the first such instant."""

    def __init__(self, instant: int) -> None:
        super().__init__(f"the true machine has no pose at instant {instant}")
        self.instant = instant


class Hexapod(NamedTuple):
    """Points of the machine at n instants.

    Attributes
    ----------
    slider_joints_mm : (n, 6, 3) array
        Base frame, mm.
    platform_joints_mm : (n, 6, 3) array
        Platform frame, mm.
    lengths_mm : (n, 6) array
        Leg lengths, mm.
    """

    slider_joints_mm: Array
    platform_joints_mm: Array
    lengths_mm: Array


class Poses(NamedTuple):
    """Poses of the platform at n instants: position (n, 3), mm, base frame; rotation (n, 3, 3)."""

    position_mm: Array
    rotation: Array

    def at(self, rows: slice | NDArray[np.intp]) -> Poses:
        """Return the poses of some of the instants."""
        return Poses(self.position_mm[rows], self.rotation[rows])


def solve_poses(hexapod: Hexapod, guess: Poses) -> Poses:
    """Compute the poses that satisfy the leg lengths.

    Parameters
    ----------
    hexapod : Hexapod
        Points at n instants.
    guess : Poses
        Start of the iteration at n instants.

    Returns
    -------
    Poses
        At n instants.

    Raises
    ------
    NoPoseError
        No convergence within `MAX_ITERATIONS`: the slider positions are incompatible with the leg lengths.
    """
    if len(guess.position_mm) == 1:
        return _solve_single(hexapod, guess)
    if len(guess.position_mm) <= BLOCK:
        return Poses(*_solve_block(hexapod, guess, 0))
    position, rotation = np.empty_like(guess.position_mm), np.empty_like(guess.rotation)
    for first in range(0, len(position), BLOCK):
        rows = slice(first, first + BLOCK)
        part = Hexapod(hexapod.slider_joints_mm[rows], hexapod.platform_joints_mm[rows], hexapod.lengths_mm[rows])
        position[rows], rotation[rows] = _solve_block(part, guess.at(rows), first)
    return Poses(position, rotation)


def leg_forces_n(hexapod: Hexapod, poses: Poses, weight_n: float) -> Array:
    """Compute the forces of the legs in equilibrium with a weight at the platform's reference point.

    Parameters
    ----------
    hexapod : Hexapod
        Points at n instants.
    poses : Poses
        At n instants.
    weight_n : float
        Along -z of the base frame, N.

    Returns
    -------
    numpy.ndarray
        Compression positive, N, shape (n, 6).

    Raises
    ------
    RunError
        The pose is singular: there is no equilibrium.
    """
    jacobian = _jacobian(*_legs(hexapod, poses.position_mm, poses.rotation))
    # Legs push along n_k: sum f_k n_k = (0, 0, weight), and no moment about the reference point.
    load = np.zeros((len(jacobian), 6, 1))
    load[:, 2] = weight_n
    try:
        forces = np.linalg.solve(jacobian.transpose(0, 2, 1), load)[:, :, 0]
    except np.linalg.LinAlgError:
        raise RunError("the true machine is in a singular pose: its legs cannot carry the weight") from None
    return np.asarray(forces, dtype=np.float64)


def _solve_block(hexapod: Hexapod, guess: Poses, first: int) -> tuple[Array, Array]:
    position, rotation = guess.position_mm, guess.rotation
    inverse: NDArray[np.floating[Any]] | None = None
    for _ in range(MAX_ITERATIONS):
        arms, legs, reach = _legs(hexapod, position, rotation)
        if inverse is None:
            try:
                inverse = np.linalg.inv(_jacobian(arms, legs, reach))
            except np.linalg.LinAlgError:
                break
        step: Array = (inverse @ (hexapod.lengths_mm - reach)[:, :, None])[:, :, 0]
        position = position + step[:, :3]
        largest = float(np.maximum.reduce(np.abs(step), axis=None))
        if largest < STEP_TOLERANCE:
            return position, _orthonormal(rotation + _skew(step[:, 3:]) @ rotation)
        rotation = _turn(step[:, 3:]) @ rotation
        if not math.isfinite(largest):
            break
        if largest > REUSE_STEP:
            inverse = None
    _, _, reach = _legs(hexapod, position, rotation)
    wrong = ~(np.abs(hexapod.lengths_mm - reach).max(axis=1) < STEP_TOLERANCE)
    row = int(np.argmax(wrong))
    raise NoPoseError(first + row)


def _solve_single(hexapod: Hexapod, guess: Poses) -> Poses:
    """Do what `_solve_block` does for one instant, in plain numbers."""
    ends = ends_of(hexapod.slider_joints_mm[0], hexapod.platform_joints_mm[0], hexapod.lengths_mm[0])
    (x, y, z), (first, second, third) = guess.position_mm[0].tolist(), guess.rotation[0].tolist()
    found = solved(ends, (x, y, z), (tuple(first), tuple(second), tuple(third)))
    if found is None:
        raise NoPoseError(0)
    return Poses(np.array([found[0]]), np.array([found[1]]))


def _legs(hexapod: Hexapod, position: Array, rotation: Array) -> tuple[Array, Array, Array]:
    """Return R q_k (n, 6, 3), the vectors along the legs (n, 6, 3) and the distances of their joints (n, 6)."""
    arms = hexapod.platform_joints_mm @ rotation.transpose(0, 2, 1)
    legs = arms + position[:, None, :] - hexapod.slider_joints_mm
    return arms, legs, np.sqrt((legs * legs) @ _ONES)


def _jacobian(arms: Array, legs: Array, reach: Array) -> Array:
    """Return the derivatives of the distances by position and rotation, (n, 6, 6)."""
    jacobian = np.empty((len(reach), 6, 6))
    n = np.divide(legs, reach[:, :, None], out=jacobian[:, :, :3])
    a, b = arms.take(_XYZXY, axis=2), n.take(_XYZXY, axis=2)
    np.subtract(a[:, :, 1:4] * b[:, :, 2:5], a[:, :, 2:5] * b[:, :, 1:4], out=jacobian[:, :, 3:])
    return jacobian


def _skew(vector: Array) -> Array:
    """Return the matrices [v]x of vectors v, (n, 3, 3)."""
    skew: Array = (vector @ _SKEW).reshape(-1, 3, 3)
    return skew


def _orthonormal(rotation: Array) -> Array:
    """Return rotations without the rounding of many samples and the second order of a last small turn, (n, 3, 3).

    One step of the polar decomposition's iteration: it squares the deviation from orthonormal.
    """
    return rotation @ (_ONE_AND_A_HALF - 0.5 * (rotation.transpose(0, 2, 1) @ rotation))


def _turn(rotation_vector: Array) -> Array:
    """Return Cayley's map I + 2 (H + H^2) / (1 + |h|^2) of half the rotation vector, h, with H = [h]x; (n, 3, 3)."""
    half = 0.5 * rotation_vector
    skew = _skew(half)
    scale = 2.0 / (1.0 + (half * half) @ _ONES)
    turn: Array = _IDENTITY + scale[:, None, None] * (skew + skew @ skew)
    return turn
