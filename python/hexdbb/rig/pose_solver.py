"""Pose of the platform of the true machine: Newton's method on the six pose coordinates, one ball joint per leg.

Model: residuals f_k = |R q_k + p - B_k| - L_k, k = 1 to 6. With a small rotation w in the base frame, R -> C(w) R, the
row of the Jacobian is (n_k, (R q_k) x n_k), n_k the unit vector along leg k; C is Cayley's map, a rotation for every w
and equal to exp([w]x) up to the third order; the choice affects the iterations and not the solution.
Assumption: the platform stays in the assembly mode of the first guess.
All instants of a stretch are solved at once, each from its own first guess; with quadratic convergence two or three
iterations suffice.
Units: mm, rad, N.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import RunError
from hexdbb.rig.geometry import Array

STEP_TOLERANCE = 1e-6
"""Largest last step, mm and rad. Convergence is quadratic: the remaining error is the square of the step over the leg
length, below 1e-14 mm."""
MAX_ITERATIONS = 50
"""Iterations after which there is no pose; a nearby guess needs two or three."""
BLOCK = 512
"""Instants solved at once: their Jacobians (150 kB) fit into the processor's cache."""
_IDENTITY = np.eye(3)


class NoPoseError(RunError):
    """No pose satisfies the leg lengths; `instant` is the first such instant."""

    def __init__(self, instant: int) -> None:
        super().__init__(f"the true machine has no pose at instant {instant}")
        self.instant = instant


@dataclass(frozen=True)
class Hexapod:
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


@dataclass(frozen=True)
class Poses:
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
    _, jacobian = _legs(hexapod, poses.position_mm, poses.rotation)
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
    for _ in range(MAX_ITERATIONS):
        reach, jacobian = _legs(hexapod, position, rotation)
        try:
            solved = np.linalg.solve(jacobian, (hexapod.lengths_mm - reach)[:, :, None])
        except np.linalg.LinAlgError:
            break
        step = np.asarray(solved[:, :, 0], dtype=np.float64)
        position = position + step[:, :3]
        rotation = _turn(step[:, 3:]) @ rotation
        largest = np.abs(step).max(axis=1)
        if np.all(largest < STEP_TOLERANCE):
            # One step of the polar decomposition's iteration keeps R orthonormal over any number of samples.
            return position, 0.5 * rotation @ (3.0 * _IDENTITY - rotation.transpose(0, 2, 1) @ rotation)
        if not np.all(np.isfinite(largest)):
            break
    reach, _ = _legs(hexapod, position, rotation)
    wrong = ~(np.abs(hexapod.lengths_mm - reach).max(axis=1) < STEP_TOLERANCE)
    row = int(np.argmax(wrong))
    raise NoPoseError(first + row)


def _legs(hexapod: Hexapod, position: Array, rotation: Array) -> tuple[Array, Array]:
    """Return distances of the joints of each leg (n, 6) and their derivatives by position and rotation (n, 6, 6)."""
    arms = hexapod.platform_joints_mm @ rotation.transpose(0, 2, 1)
    legs = arms + position[:, None, :] - hexapod.slider_joints_mm
    reach = np.sqrt(np.einsum("nij,nij->ni", legs, legs))
    jacobian = np.empty((len(reach), 6, 6))
    n = np.divide(legs, reach[:, :, None], out=jacobian[:, :, :3])
    for axis in range(3):
        one, other = (axis + 1) % 3, (axis + 2) % 3
        jacobian[:, :, 3 + axis] = arms[:, :, one] * n[:, :, other] - arms[:, :, other] * n[:, :, one]
    return reach, jacobian


def _turn(rotation_vector: Array) -> Array:
    """Return Cayley's map I + 2 (H + H^2) / (1 + |h|^2) of half the rotation vector, h, with H = [h]x; (n, 3, 3)."""
    half = 0.5 * rotation_vector
    skew = np.zeros((len(half), 3, 3))
    skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0] = half.T
    skew[:, 1, 2], skew[:, 2, 0], skew[:, 0, 1] = -half.T
    scale = 2.0 / (1.0 + np.einsum("ni,ni->n", half, half))
    turn: Array = _IDENTITY + scale[:, None, None] * (skew + skew @ skew)
    return turn
