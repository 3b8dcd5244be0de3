"""What geometry and set-up cannot take of some readings: their nonlinear fit on the truth's own kinematics.

Model: the 33 errors of geometry, the cup of each mount and the ball, each with the prior of a new model, are fitted by
least squares to readings without noise, weighted as if each had the gauge's. What remains, root mean square, is how
large a fault shows to whoever has fitted everything else.
Formula: a leg's closure f_k = |R q_k + p - B_k| - L_k changes with a free value by df_k; the reading by
-g J^-1 df, J = df / dpose and g = dreading / dpose, from which the derivatives by all values follow at once.
What the readings hardly see is a narrow valley that bends: steps are damped (Levenberg) and take its bend along.
Source: geodesic acceleration, Transtrum and Sethna, arXiv:1201.5885.
Units: mm, rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from hexdbb.rig.geometry import Array, GeometryErrors, TrueGeometry, true_geometry
from hexdbb.rig.mechanisms import Push
from hexdbb.rig.plant import Machine, SetupErrors
from hexdbb.rig.pose_solver import Poses
from hexdbb.rig.truth import TruthFile
from hexdbb_truth.forms.history import History, Rows

LENGTH_PRIOR_MM, ANGLE_PRIOR_RAD, SETUP_PRIOR_MM = 0.1, 0.1 / 300.0, 1.0
"""Standard deviations of a new model's geometry and set-up: what is expected of an unknown machine."""
GEOMETRY_SIZE = 33
STEP = 1e-4
"""Central difference of points (not of readings) by a free value, mm or rad: exact to rounding, points being smooth."""
MAX_ITERATIONS, ENOUGH = 100, 1e-3
"""Share by which the sum to be minimised must still fall: 0.05 % of the remaining RMS."""
PROBE, BENDS_MAX, DAMPING_MAX = 0.1, 3.0, 1e8
"""Share of a step at which its bend is measured; bend over step beyond which it is not believed; and damping, in
multiples of the priors' stiffness, at which no step leads down any more."""


@dataclass(frozen=True)
class Fitted:
    """Readings and their best fit by geometry and set-up.

    Attributes
    ----------
    left_mm : (n,) array
        What remains.
    slopes : (n, free values) array
        Derivatives of the readings at the fit.
    value, prior : (free values,) arrays
        Fitted values and their prior standard deviations.
    noise_mm : float
        Of one of the n readings, so that they count as much as all of the record.
    """

    left_mm: Array
    slopes: Array
    value: Array
    prior: Array
    noise_mm: float

    @property
    def rms_mm(self) -> float:
        """Root mean square of what remains."""
        return float(np.sqrt(np.mean(self.left_mm**2)))

    def rms_with_mm(self, columns: Array) -> float:
        """Return the root mean square that remains when the readings' changes `columns` (n, m) are fitted along.

        To first order about the fit; geometry and set-up move on under their priors, the new columns freely.
        """
        scale = np.maximum(np.sqrt(np.mean(columns**2, axis=0)), 1e-300)
        top = np.hstack([self.slopes, columns / scale]) / self.noise_mm
        bottom = np.hstack([np.diag(1.0 / self.prior), np.zeros((len(self.prior), columns.shape[1]))])
        target = np.concatenate([self.left_mm / self.noise_mm, -self.value / self.prior])
        free = np.linalg.lstsq(np.vstack([top, bottom]), target, rcond=1e-12)[0]
        left = self.left_mm - self.noise_mm * (top @ free)
        return float(np.sqrt(np.mean(left**2)))


def fitted(readings_mm: Array, rows: Rows, history: History, noise_mm: float, begin: Array | None = None) -> Fitted:
    """Return the best fit of readings by geometry and set-up.

    Parameters
    ----------
    readings_mm : (n,) array
        Without noise.
    rows : (n,) array of int
        Their instants.
    history : History
    noise_mm : float
        Of one reading of the record, which has as many readings as the history has samples.
    begin : (free values,) array, optional
        Values to begin with; the nominal machine's, all zero, where none are given.
    """
    model = _Geometry(history, rows)
    noise_mm = noise_mm * math.sqrt(len(rows) / len(history.samples))
    weight, stiffness = noise_mm**-2, model.prior**-2

    def judged(value: Array) -> tuple[Array, float]:
        left = readings_mm - model.readings_mm(value)
        return left, float(weight * left @ left + stiffness @ value**2)

    value = np.zeros(len(model.prior)) if begin is None else begin
    left, cost = judged(value)
    slopes, damping = model.slopes(value), 0.0
    for _ in range(MAX_ITERATIONS):
        normal = weight * slopes.T @ slopes + np.diag((1.0 + damping) * stiffness)
        step = np.linalg.solve(normal, weight * slopes.T @ left - stiffness * value)
        bend = 2.0 / PROBE * ((judged(value + PROBE * step)[0] - left) / PROBE + slopes @ step)
        turn = np.linalg.solve(normal, weight * slopes.T @ bend)
        if 2.0 * np.linalg.norm(turn / model.prior) < BENDS_MAX * np.linalg.norm(step / model.prior):
            step = step + 0.5 * turn
        tried, lower = judged(value + step)
        if lower >= cost:
            damping = max(5.0 * damping, 1.0)
            if damping > DAMPING_MAX:
                break
            continue
        fall, value, left, cost = cost - lower, value + step, tried, lower
        slopes, damping = model.slopes(value), damping / 10.0 if damping > 0.05 else 0.0
        if fall < ENOUGH * cost:
            break
    return Fitted(left, slopes, value, model.prior, noise_mm)


def true_values(truth: TruthFile, mounts: int) -> Array:
    """Return a machine's own geometry, cups and ball in the order of the fit."""
    errors, setup = truth.geometry.errors(), truth.setup.errors()
    cups = [setup.cup_mm.get(mount, (0.0, 0.0, 0.0)) for mount in range(mounts)]
    parts: list[ArrayLike] = [
        errors.leg_length_mm,
        errors.slider_offset_mm,
        errors.guideway_translation_mm,
        errors.guideway_rotation_xy_rad,
        errors.guideway_rotation_yz_rad,
        errors.guideway_rotation_centre_rad,
        errors.platform_side_mm,
        cups,
        setup.ball_offset_mm,
    ]
    return np.concatenate([np.ravel(part) for part in parts])


def geometry_readings_mm(value: Array, rows: Rows, history: History) -> Array:
    """Return the readings of a machine of fitted geometry and set-up, without faults."""
    return _Geometry(history, rows).readings_mm(value)


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
        _, poses = self._solved(value)
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
        anchors, directions, lengths, joints = self._points_slopes(value)
        flat = (len(self._rows), 18)
        columns = np.empty((len(self._rows), len(self.prior)))
        columns[:, :GEOMETRY_SIZE] = (
            by_leg @ lengths
            + push.reshape(flat) @ anchors
            + (self._drive[:, :, None] * push).reshape(flat) @ directions
            - (push @ rotation).reshape(flat) @ joints
        )
        for mount in range(len(self._history.plan.mounts)):
            first = GEOMETRY_SIZE + 3 * mount
            columns[:, first : first + 3] = np.where((self._mount == mount)[:, None], -along, 0.0)
        columns[:, -3:] = np.einsum("nij,ni->nj", rotation, along)
        return columns

    def _points_slopes(self, value: Array) -> tuple[Array, Array, Array, Array]:
        """Derivatives of anchors, directions (18 coordinates), lengths (6) and joints (18) by the 33 errors."""
        both = [
            [self._geometry(value[:GEOMETRY_SIZE] + sign * step) for step in STEP * np.eye(GEOMETRY_SIZE)]
            for sign in (1.0, -1.0)
        ]
        names = ("anchors_mm", "directions", "lengths_mm", "joints_mm")
        after, before = (
            [np.stack([getattr(each, name).reshape(-1) for each in side], axis=1) for name in names] for side in both
        )
        anchors, directions, lengths, joints = (
            (more - less) / (2.0 * STEP) for more, less in zip(after, before, strict=True)
        )
        return anchors, directions, lengths, joints

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
