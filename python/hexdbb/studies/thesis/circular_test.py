"""The thesis' circular test: slider coordinates of one circle about one cup, and the readings there.

Formula: contour(values) = reading(values) - reading(0) at the slider coordinates of the nominal machine on its circle,
equation (5.3). The slider coordinates come from inverse kinematics, or from a record as the encoders reported them.
Assumption users get wrong: a misplaced cup contributes to the contour too, and the thesis has no unknown for it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.kinematics import inverse, status_name
from hexdbb.machine import MachineFile
from hexdbb.model import Model, new_model
from hexdbb.plan import Circle, Mount, Plan, load_plan
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb.studies.thesis.unknowns import SHORT_NAMES, UNKNOWNS

Floats = NDArray[np.float64]

SAMPLES = 360
"""Samples of a computed contour: one per degree resolves its harmonics, of which the sixth is below 1 % already."""


@dataclass(frozen=True)
class CircularTest:
    """Samples of a circular test with one mount of the cup."""

    machine: MachineFile
    samples: _core.Samples
    sliders_mm: Floats
    """Slider coordinates of the samples, shape (n, 6), mm."""
    angle_rad: Floats
    """Polar angle of each sample, shape (n,), rad."""
    origin: str
    """Name of the test in error messages and titles."""

    @cached_property
    def nominal_mm(self) -> Floats:
        """Reading on the nominal machine, shape (n,), mm."""
        return self._predict(np.zeros(len(UNKNOWNS)), False).reading_mm

    def contour_mm(self, values: Floats) -> Floats:
        """Return the radial deviation that errors cause together, by exact kinematics.

        Parameters
        ----------
        values : ndarray, shape (len(UNKNOWNS),)
            Errors, mm and rad.

        Returns
        -------
        ndarray, shape (n,)
            mm.

        Raises
        ------
        InputError
            Naming the first sample at which the machine with these errors has no pose.
        """
        contour: Floats = self._predict(values, False).reading_mm - self.nominal_mm
        return contour

    @cached_property
    def first_order(self) -> Floats:
        """Derivative of the contour with respect to every unknown, mm per mm or rad, shape (n, len(UNKNOWNS))."""
        return self._predict(np.zeros(len(UNKNOWNS)), True).jacobian

    def model(self, values: Floats) -> Model:
        """Return the model whose values are the unknowns, in their order."""
        model = new_model(self.machine, list(SHORT_NAMES))
        return model.with_values(values, np.full(len(values), np.nan), np.zeros(len(values), bool))

    def _predict(self, values: Floats, want_jacobian: bool) -> _core.Prediction:
        prediction = _core.predict(self.model(values).engine(), self.samples, want_jacobian)
        row = prediction.first_failure
        if row >= 0:
            reason = status_name(int(prediction.status[row]))
            raise InputError(f"{self.origin}: sample {row + 1}: no pose with these errors ({reason})")
        return prediction


def circle_test(
    machine: MachineFile, circle: Circle, mount: Mount, bar_length_mm: float, origin: str = "circle"
) -> CircularTest:
    """Return the test of one circle: `SAMPLES` samples, evenly spaced from angle 0.

    Parameters
    ----------
    machine : MachineFile
    circle : Circle
    mount : Mount
    bar_length_mm : float
    origin : str
        Name of the test in error messages.

    Raises
    ------
    InputError
        Naming the first angle that is out of reach.
    """
    angle_rad = np.arange(SAMPLES) / SAMPLES * 2.0 * np.pi
    sliders_mm, status = inverse(machine, circle.poses(angle_rad, mount.cup_mm), circle.platform_rpy_rad)
    failed = np.flatnonzero(status)
    if failed.size:
        row = int(failed[0])
        reason = status_name(int(status[row]))
        raise InputError(f"{origin}: circle {circle.id}: {np.degrees(angle_rad[row]):g} deg: {reason}")
    rows = np.zeros(SAMPLES, dtype=np.int32)
    set_up = _core.SetUp(
        cup_mm=np.array(mount.cup_mm), ball_offset_mm=np.array(circle.ball_offset_mm), bar_length_mm=bar_length_mm
    )
    samples = _core.Samples(sliders_mm=sliders_mm, set_up=rows, mount=rows, set_ups=[set_up])
    return CircularTest(machine, samples, sliders_mm, angle_rad, origin)


def plan_test(plan: Plan, identity: int, origin: str) -> CircularTest:
    """Return the test of the circle with an id in a plan.

    Raises
    ------
    InputError
        The plan has no circle with that id, or it is out of reach.
    """
    circle = next((each for each in plan.circles if each.id == identity), None)
    if circle is None:
        known = ", ".join(str(each.id) for each in plan.circles)
        raise InputError(f"{origin}: circle {identity}: not in the plan (expected one of: {known})")
    return circle_test(plan.machine_file(), circle, plan.mount_of(circle), plan.gauge.bar_length_mm, origin)


def joint_plane_circle() -> tuple[MachineFile, Circle, Mount, float]:
    """Return the circle of the shipped plan `thesis`, with the ball in the plane of the ball joints.

    The cup is lowered by the same amount. The thesis does not state the height of its ball; with the ball in the joint
    plane one level circle identifies exactly the seven errors that the thesis found.

    Returns
    -------
    machine : MachineFile
    circle : Circle
    mount : Mount
    bar_length_mm : float
    """
    plan = load_plan("thesis")
    machine, circle = plan.machine_file(), plan.circles[0]
    mount = plan.mount_of(circle)
    height_mm = machine.platform.joint_plane_height_mm
    lower_mm = circle.ball_offset_mm[2] - height_mm
    x_mm, y_mm, z_mm = mount.cup_mm
    level = circle.model_copy(update={"ball_offset_mm": (0.0, 0.0, height_mm)})
    cup = mount.model_copy(update={"cup_mm": (x_mm, y_mm, z_mm - lower_mm)})
    return machine, level, cup, plan.gauge.bar_length_mm


def joint_plane_test() -> CircularTest:
    """Return the test of `joint_plane_circle`."""
    return circle_test(*joint_plane_circle(), origin="level circle, ball in the joint plane")


def record_test(record: Record) -> CircularTest:
    """Return the test of a record, at the slider coordinates that the encoders reported.

    Raises
    ------
    InputError
        The record has no samples, or several mounts: the thesis' estimator assumes one.
    """
    if not len(record):
        raise InputError(f"{record.name}: no samples (expected a circular test)")
    used = sorted({record.circle(int(each)).mount for each in np.unique(record.columns["circle"])})
    if len(used) > 1:
        mounts = ", ".join(map(str, used))
        raise InputError(
            f"{record.name}: samples of mounts {mounts} (expected one: the thesis' estimator assumes one mount;"
            " hexdbb diagnose takes several)"
        )
    nominal = new_model(record.machine, list(SHORT_NAMES))
    angle_rad = np.radians(record.columns["angle_deg"])
    return CircularTest(record.machine, Samples.of([record]).block(nominal), record.sliders_mm, angle_rad, record.name)
