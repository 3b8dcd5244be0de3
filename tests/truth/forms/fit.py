"""What geometry and set-up cannot take of some readings: their nonlinear fit on the truth's own kinematics.

Model: the 33 errors of geometry, the cup of each mount and the ball, each with the prior of a new model, are fitted by
Gauss-Newton to readings without noise, weighted as if each had the gauge's. What remains, root mean square, is how
large a fault shows to whoever has fitted everything else.
Formula: a leg's closure f_k = |R q_k + p - B_k| - L_k changes with a free value by df_k; the reading by
-g J^-1 df, J = df / dpose and g = dreading / dpose, from which the derivatives by all values follow at once.
Units: mm, rad.
"""

from __future__ import annotations

import numpy as np
from tests.truth.forms.history import History, Rows

from hexdbb.rig.geometry import Array, GeometryErrors, TrueGeometry, true_geometry
from hexdbb.rig.mechanisms import Push
from hexdbb.rig.plant import Machine, SetupErrors
from hexdbb.rig.pose_solver import Poses

LENGTH_PRIOR_MM, ANGLE_PRIOR_RAD, SETUP_PRIOR_MM = 0.1, 0.1 / 300.0, 1.0
"""Standard deviations of a new model's geometry and set-up: what somebody expects who knows nothing of the machine."""
GEOMETRY_SIZE = 33
STEP = 1e-4
"""Central difference of points (not of readings) by a free value, mm or rad: exact to rounding, as points are smooth."""
MAX_ITERATIONS, ENOUGH = 25, 1e-4
"""Share by which the sum to be minimised must still fall."""


def remaining_mm(readings_mm: Array, rows: Rows, history: History, noise_mm: float) -> Array:
    """Return readings less their best fit by geometry and set-up, shape (n,).

    Parameters
    ----------
    readings_mm : (n,) array
        Without noise.
    rows : (n,) array of int
        Their instants.
    history : History
    noise_mm : float
        Of one reading, against which priors are weighed; the record has as many readings as the history has samples.
    """
    model = _Geometry(history, rows)
    weight = len(history.samples) / len(rows) / noise_mm**2
    value = np.zeros(len(model.prior))
    left = readings_mm - model.readings_mm(value)
    cost = weight * left @ left
    for _ in range(MAX_ITERATIONS):
        slopes = model.slopes(value)
        normal = weight * slopes.T @ slopes + np.diag(model.prior**-2)
        step = np.linalg.solve(normal, weight * slopes.T @ left - value / model.prior**2)
        for _ in range(6):
            tried = readings_mm - model.readings_mm(value + step)
            lower = weight * tried @ tried + np.sum(((value + step) / model.prior) ** 2)
            if lower < cost:
                break
            step = 0.5 * step
        else:
            break
        fall, value, left, cost = cost - lower, value + step, tried, lower
        if fall < ENOUGH * cost:
            break
    return left


class _Geometry:
    """Readings of a machine without faults as a function of its 33 errors, cups and ball."""

    def __init__(self, history: History, rows: Rows) -> None:
        self._history, self._rows = history, rows
        run = history.run[rows]
        mounts = [mount.id for mount in history.plan.mounts]
        self._mount = np.array([mounts.index(each.mount.id) for each in history.runs])[run]
        self._ball = np.array([each.circle.ball_offset_mm for each in history.runs])[run]
        self._cup = np.array([each.mount.cup_mm for each in history.runs])[run]
        self._drive, self._guess = history.drive_mm[rows], history.poses(rows)
        angles = np.zeros(GEOMETRY_SIZE, dtype=bool)
        angles[21:30] = True
        lengths = np.where(angles, ANGLE_PRIOR_RAD, LENGTH_PRIOR_MM)
        self.prior = np.concatenate([lengths, np.full(3 * len(mounts) + 3, SETUP_PRIOR_MM)])
        self._known: tuple[Array, TrueGeometry, Poses] | None = None

    def readings_mm(self, value: Array) -> Array:
        geometry, poses = self._solved(value)
        bar, _ = self._bar(value, poses)
        return np.asarray(np.linalg.norm(bar, axis=1) - self._history.plan.gauge.bar_length_mm)

    def slopes(self, value: Array) -> Array:
        """Derivatives of the readings, shape (n, free values)."""
        geometry, poses = self._solved(value)
        bar, arm = self._bar(value, poses)
        along = bar / np.linalg.norm(bar, axis=1)[:, None]
        rotation = poses.rotation
        arms = geometry.joints_mm @ np.swapaxes(rotation, 1, 2)
        legs = arms + poses.position_mm[:, None, :] - geometry.slider_joints_mm(self._drive)
        unit = legs / np.linalg.norm(legs, axis=2)[:, :, None]
        jacobian = np.concatenate([unit, np.cross(arms, unit)], axis=2)
        by_pose = np.concatenate([along, np.cross(arm, along)], axis=1)
        by_leg = np.linalg.solve(np.swapaxes(jacobian, 1, 2), by_pose[:, :, None])[:, :, 0]
        push = by_leg[:, :, None] * unit
        columns = np.empty((len(self._rows), len(self.prior)))
        for j, step in enumerate(STEP * np.eye(GEOMETRY_SIZE)):
            after, before = (self._geometry(value[:GEOMETRY_SIZE] + sign * step) for sign in (1.0, -1.0))
            anchors = (after.anchors_mm - before.anchors_mm) / (2.0 * STEP)
            directions = (after.directions - before.directions) / (2.0 * STEP)
            joints = (after.joints_mm - before.joints_mm) / (2.0 * STEP)
            lengths = (after.lengths_mm - before.lengths_mm) / (2.0 * STEP)
            column = by_leg @ lengths + np.einsum("nki,ki->n", push, anchors)
            if np.any(directions):
                column += np.einsum("nk,nki,ki->n", self._drive, push, directions)
            if np.any(joints):
                column -= np.einsum("nki,nij,kj->n", push, rotation, joints)
            columns[:, j] = column
        for mount in range(len(self._history.plan.mounts)):
            first = GEOMETRY_SIZE + 3 * mount
            columns[:, first : first + 3] = np.where((self._mount == mount)[:, None], -along, 0.0)
        columns[:, -3:] = np.einsum("nij,ni->nj", rotation, along)
        return columns

    def _bar(self, value: Array, poses: Poses) -> tuple[Array, Array]:
        arm = np.einsum("nij,nj->ni", poses.rotation, self._ball + value[-3:])
        cups = value[GEOMETRY_SIZE:-3].reshape(-1, 3)
        return poses.position_mm + arm - self._cup - cups[self._mount], arm

    def _solved(self, value: Array) -> tuple[TrueGeometry, Poses]:
        if self._known is None or not np.array_equal(self._known[0], value):
            geometry = self._geometry(value[:GEOMETRY_SIZE])
            machine = Machine(geometry, SetupErrors({}, (0.0, 0.0, 0.0), 0.0), [])
            guess = self._guess if self._known is None else self._known[2]
            poses = machine.poses(self._drive, Push(len(self._rows)), guess)
            self._known = (value.copy(), geometry, poses)
        return self._known[1], self._known[2]

    def _geometry(self, value: Array) -> TrueGeometry:
        errors = GeometryErrors(
            leg_length_mm=value[0:6],
            slider_offset_mm=value[6:12],
            guideway_translation_mm=value[12:21].reshape(3, 3),
            guideway_rotation_xy_rad=value[21:24],
            guideway_rotation_yz_rad=value[24:27],
            guideway_rotation_centre_rad=value[27:30],
            platform_side_mm=value[30:33],
        )
        return true_geometry(self._history.machine, errors)
