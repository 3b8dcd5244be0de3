"""Where the platform of the true machine stands: Newton's method on the six pose coordinates, one ball joint per leg.

Model: residuals f_k = |R q_k + p - B_k| - L_k, k = 1 to 6. With a small rotation w in the base frame, R -> exp([w]x)
R, the row of the Jacobian is (n_k, (R q_k) x n_k), n_k the unit vector along leg k. Started from the last pose, it
needs two steps a cycle.
Assumption: the machine is assembled so that the platform stays on the branch of its last pose.
Units: mm, rad.
"""

from __future__ import annotations

import math

import numpy as np

from hexdbb.errors import RunError
from hexdbb.rig.geometry import Array, TrueGeometry

STEP_TOLERANCE = 1e-6
"""A step (mm, and rad times mm) this small leaves an error of its square over the leg length: none."""
MAX_ITERATIONS = 50
_IDENTITY3 = 3.0 * np.eye(3)


class PoseSolver:
    """Follows the pose of a machine from sample to sample.

    Parameters
    ----------
    geometry : TrueGeometry
        The machine.
    position_mm : (3,) array
        Where to start.
    rotation : (3, 3) array
        Orientation to start from.
    """

    def __init__(self, geometry: TrueGeometry, position_mm: Array, rotation: Array) -> None:
        self._geometry = geometry
        self.position_mm = np.array(position_mm, dtype=float)
        self.rotation = np.array(rotation, dtype=float)
        self.iterations = 0
        self._jacobian = np.empty((6, 6))

    def solve(self, sliders_mm: Array, longer_mm: Array | None = None) -> tuple[Array, Array]:
        """Move to the pose that these sliders hold.

        Parameters
        ----------
        sliders_mm : (6,) array
            Where the sliders really are.
        longer_mm : (6,) array, optional
            Legs longer by this at this instant.

        Returns
        -------
        position_mm : (3,) array
        rotation : (3, 3) array

        Raises
        ------
        RunError
            No pose within 50 steps: the sliders tear the machine apart.
        """
        joints = self._geometry.slider_joints_mm(sliders_mm)
        lengths = self._geometry.lengths_mm if longer_mm is None else self._geometry.lengths_mm + longer_mm
        position, rotation = self.position_mm, self.rotation
        for self.iterations in range(1, MAX_ITERATIONS + 1):
            step = self._step(position, rotation, joints, lengths)
            position = position + step[:3]
            rotation = _turn(step[3], step[4], step[5]) @ rotation
            largest = float(np.abs(step).max())
            if not math.isfinite(largest):
                break
            if largest < STEP_TOLERANCE:
                # One step of the polar decomposition's iteration keeps R orthonormal over any number of samples.
                self.position_mm = position
                self.rotation = 0.5 * rotation @ (_IDENTITY3 - rotation.T @ rotation)
                return self.position_mm, self.rotation
        raise RunError(f"the true machine has no pose for sliders {np.round(sliders_mm, 3).tolist()} mm")

    def _step(self, position: Array, rotation: Array, joints: Array, lengths: Array) -> Array:
        arms = self._geometry.joints_mm @ rotation.T
        legs = arms + position - joints
        reach = np.sqrt(np.einsum("ij,ij->i", legs, legs))
        n = legs / reach[:, None]
        jacobian = self._jacobian
        jacobian[:, :3] = n
        jacobian[:, 3] = arms[:, 1] * n[:, 2] - arms[:, 2] * n[:, 1]
        jacobian[:, 4] = arms[:, 2] * n[:, 0] - arms[:, 0] * n[:, 2]
        jacobian[:, 5] = arms[:, 0] * n[:, 1] - arms[:, 1] * n[:, 0]
        try:
            step: Array = np.linalg.solve(jacobian, lengths - reach)
        except np.linalg.LinAlgError:
            return np.full(6, np.nan)
        return step


def _turn(x: float, y: float, z: float) -> Array:
    """Exponential of the rotation vector (x, y, z) by Rodrigues' formula, shape (3, 3)."""
    square = x * x + y * y + z * z
    angle = math.sqrt(square)
    if angle < 1e-4:
        a, b = 1.0 - square / 6.0, 0.5 - square / 24.0
    else:
        a, b = math.sin(angle) / angle, (1.0 - math.cos(angle)) / square
    return np.array(
        [
            [1.0 - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y],
            [b * x * y + a * z, 1.0 - b * (x * x + z * z), b * y * z - a * x],
            [b * x * z - a * y, b * y * z + a * x, 1.0 - b * (x * x + y * y)],
        ]
    )
