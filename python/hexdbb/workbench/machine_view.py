"""The machine as it stands at one angle of a circle: nominal, and displaced by the model's errors, magnified."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from hexdbb.kinematics import platform_points, rotation_from_rpy, slider_points
from hexdbb.model import Model
from hexdbb.samples import Samples, effect_pushes, predict_poses
from hexdbb.workbench.selection import Selection

Floats = NDArray[np.float64]
UM_PER_MM = 1e3
SHOWN_MM = 40.0
"""Largest displacement of the ball as drawn: a third of the platform, so that the picture stays that of the machine."""
SERIES = (5.0, 2.0, 1.0)
LEAST_MM = 1e-7
"""Displacements below are rounding: nothing is magnified."""


@dataclass(frozen=True)
class Stand:
    """Points of the machine, base frame, mm.

    Attributes
    ----------
    sliders, joints : ndarray, shape (6, 3)
        Ends of the legs.
    position, rotation : ndarray, shape (3,) and (3, 3)
        Of the platform.
    ball, cup : ndarray, shape (3,)
    moved_position, moved_rotation, moved_ball : ndarray
        The platform and the ball displaced by the model's errors, magnified.
    forces : ndarray, shape (6,)
        Axial force of each leg per newton of load, tension positive.
    corrections_um : ndarray, shape (6,)
        How much longer than nominal each leg acts in the model.
    """

    sliders: Floats
    joints: Floats
    position: Floats
    rotation: Floats
    ball: Floats
    cup: Floats
    moved_position: Floats
    moved_rotation: Floats
    moved_ball: Floats
    forces: Floats
    corrections_um: Floats


class MachineView:
    """A machine on one circle.

    What the platform is displaced by on average over the circle belongs to the set-up as much as to the machine: it is
    left out, as a polar chart leaves out the centre's offset.
    """

    def __init__(self, samples: Samples, selection: Selection, model: Model) -> None:
        self._part = part = samples.part(np.flatnonzero(selection.rows(samples)))
        self._angle_deg = np.degrees(part["angle_rad"]) % 360.0
        self._position = part["position_mm"]
        self._rotation = rotation_from_rpy(part["platform_rpy_rad"])
        position, rotation = predict_poses(part, model)
        turned = Rotation.from_matrix(rotation @ np.swapaxes(self._rotation, 1, 2)).as_rotvec()
        self._shift, self._turn = _about_mean(position - self._position), _about_mean(turned)
        self._set_up = samples.set_ups[int(part["set_up"][0])]
        ball = np.asarray(self._set_up.ball_offset_mm)
        moved = self._shift + np.cross(self._turn, self._rotation @ ball)
        self.magnification = _magnification(float(np.linalg.norm(moved, axis=1).max()))
        self._forces = part["leg_force"]
        pushes = effect_pushes(part, model)["leg"]
        self._corrections_um = UM_PER_MM * (pushes @ model.values)
        self._joints = platform_points(samples.machine)
        self._sliders = slider_points(samples.machine, part["sliders_mm"])

    @property
    def largest_correction_um(self) -> float:
        """Largest correction of a leg on the circle."""
        return float(np.abs(self._corrections_um).max())

    @property
    def largest_force(self) -> float:
        """Largest force of a leg on the circle, per newton of load."""
        return float(np.abs(self._forces).max())

    def at(self, angle_deg: float) -> Stand:
        """Return the machine at the reading whose commanded angle is nearest."""
        row = int(np.argmin(np.abs((self._angle_deg - angle_deg + 180.0) % 360.0 - 180.0)))
        position, rotation = self._position[row], self._rotation[row]
        ball = np.asarray(self._set_up.ball_offset_mm)
        moved_position = position + self.magnification * self._shift[row]
        moved_rotation = Rotation.from_rotvec(self.magnification * self._turn[row]).as_matrix() @ rotation
        return Stand(
            sliders=self._sliders[row],
            joints=position + self._joints @ rotation.T,
            position=position,
            rotation=rotation,
            ball=position + rotation @ ball,
            cup=np.asarray(self._set_up.cup_mm),
            moved_position=moved_position,
            moved_rotation=moved_rotation,
            moved_ball=moved_position + moved_rotation @ ball,
            forces=self._forces[row],
            corrections_um=self._corrections_um[row],
        )


def _about_mean(values: Floats) -> Floats:
    centred: Floats = values - values.mean(axis=0)
    return centred


def _magnification(largest_mm: float) -> float:
    """Return the largest of 1, 2, 5, 10 … that draws a displacement no larger than `SHOWN_MM`."""
    if largest_mm < LEAST_MM:
        return 1.0
    wanted = SHOWN_MM / largest_mm
    decade = 10.0 ** np.floor(np.log10(wanted))
    return float(next(step * decade for step in SERIES if step * decade <= wanted))
