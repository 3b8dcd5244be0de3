"""The true machine: from drive positions to ball-bar readings, stepped in time.

Model: y = (1 + gain) (|p + R ball - cup| - (L0 + bar length error)) + reading offset, with p, R from the pose solver
for the true geometry displaced by mechanisms; ball and cup are the nominal set-up plus its errors. With compliant legs,
pose and leg forces are brought into equilibrium.
`Machine` computes any number of instants at once and has no state but that of its mechanisms; `Plant` advances it cycle
by cycle with the clock of the rig. Both give the same readings.
Units: mm, s, N.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hexdbb.errors import RunError
from hexdbb.rig.geometry import Array, TrueGeometry
from hexdbb.rig.mechanisms import Mechanism, Motion, Push
from hexdbb.rig.pose_solver import Hexapod, NoPoseError, Poses, leg_forces_n, solve_poses
from hexdbb.rig.single_pose import bar_mm
from hexdbb.rig.undisplaced import Undisplaced

Point = tuple[float, float, float]
_ONES = np.ones(3)

BALANCE_ROUNDS = 3
"""Iterations of the equilibrium. Each divides the error by leg length over sag, more than 1000: three leave less than
1e-9 mm."""


@dataclass(frozen=True)
class Mounted:
    """The nominal set-up that the operator has mounted.

    Attributes
    ----------
    mount : int
        Mount id.
    cup_mm : tuple of float
        Cup in the base frame, mm.
    ball_offset_mm : tuple of float
        Ball in the platform frame, mm.
    bar_length_mm : float
        Nominal length of the bar, mm.
    """

    mount: int
    cup_mm: Point
    ball_offset_mm: Point
    bar_length_mm: float

    @cached_property
    def cup(self) -> Array:
        """`cup_mm` as an array, shape (3,)."""
        return np.array(self.cup_mm, dtype=float)

    @cached_property
    def ball(self) -> Array:
        """`ball_offset_mm` as an array, shape (3,)."""
        return np.array(self.ball_offset_mm, dtype=float)


@dataclass(frozen=True)
class SetupErrors:
    """Errors of the set-up, true minus nominal, mm: cup by mount id (a missing mount has none), ball, bar length."""

    cup_mm: Mapping[int, Point]
    ball_offset_mm: Point
    bar_length_mm: float

    @cached_property
    def cups(self) -> dict[int, Array]:
        """`cup_mm` as arrays, shape (3,)."""
        return {mount: np.array(cup_mm, dtype=float) for mount, cup_mm in self.cup_mm.items()}

    @cached_property
    def ball(self) -> Array:
        """`ball_offset_mm` as an array, shape (3,)."""
        return np.array(self.ball_offset_mm, dtype=float)

    def true(self, mounted: Mounted) -> tuple[Point, Point, float]:
        """Return where ball and cup are, and the length of the bar at which the gauge reads zero, mm."""
        (a, b, c), (d, e, f) = mounted.ball_offset_mm, mounted.cup_mm
        (u, v, w), (x, y, z) = self.ball_offset_mm, self.cup_mm.get(mounted.mount, (0.0, 0.0, 0.0))
        return (a + u, b + v, c + w), (d + x, e + y, f + z), mounted.bar_length_mm + self.bar_length_mm


@dataclass(frozen=True)
class Machine:
    """The true machine: geometry, errors of the set-up, mechanisms."""

    geometry: TrueGeometry
    setup_errors: SetupErrors
    mechanisms: Sequence[Mechanism]
    """In the order in which they act."""

    def displaced(self, motion: Motion) -> Push:
        """Advance the mechanisms through a stretch of n instants; return their displacements."""
        push = Push(len(motion.time_s))
        for mechanism in self.mechanisms:
            mechanism.act(motion, push)
        return push

    def poses(self, drive_mm: Array, push: Push | None, guess: Poses) -> Poses:
        """Compute the poses of the platform.

        Parameters
        ----------
        drive_mm : numpy.ndarray
            Drive positions, mm, shape (n, 6).
        push : Push or None
            Displacements of the mechanisms at the same n instants; None at one instant where nothing is displaced.
        guess : Poses
            Start of the iteration at n instants.

        Raises
        ------
        RunError
            The machine has no pose for these positions.
        """
        geometry, sliders_mm = self.geometry, drive_mm
        if push is None:
            joints, lengths = geometry.joints_mm[None], geometry.lengths_mm[None]
            hexapod = Hexapod(geometry.slider_joints_mm(sliders_mm), joints, lengths)
        else:
            sliders_mm = drive_mm + push.slider_mm
            hexapod = Hexapod(
                geometry.slider_joints_mm(sliders_mm) + push.slider_joint_mm,
                geometry.joints_mm + push.platform_joint_mm,
                geometry.lengths_mm + push.leg_mm,
            )
        try:
            poses = solve_poses(hexapod, guess)
            if push is not None and push.compliance_mm_n.any():
                poses = self._balanced(hexapod, push.compliance_mm_n, poses)
        except NoPoseError as error:
            where = np.round(sliders_mm[error.instant], 3).tolist()
            raise RunError(f"the true machine has no pose for sliders {where} mm") from None
        return poses

    def _balanced(self, stiff: Hexapod, compliance_mm_n: Array, poses: Poses) -> Poses:
        pressed = stiff
        for _ in range(BALANCE_ROUNDS):
            forces = leg_forces_n(pressed, poses, self.geometry.weight_n)
            pressed = stiff._replace(lengths_mm=stiff.lengths_mm - compliance_mm_n * forces)
            poses = solve_poses(pressed, poses)
        return poses

    def reading_mm(self, mounted: Mounted, push: Push | None, poses: Poses) -> Array:
        """Return length minus nominal length of the mounted bar as the gauge shows it, without noise.

        Parameters
        ----------
        mounted : Mounted
            The bar.
        push : Push or None
            Displacements of the mechanisms at n instants; None where nothing is displaced.
        poses : Poses
            At n instants.

        Returns
        -------
        numpy.ndarray
            Readings, mm, shape (n,).
        """
        errors = self.setup_errors
        ball, cup = mounted.ball + errors.ball, mounted.cup + errors.cups.get(mounted.mount, 0.0)
        nominal_mm = mounted.bar_length_mm + errors.bar_length_mm
        if push is not None:
            ball, cup = ball + push.ball_mm, cup + push.cup_mm
        bar = poses.position_mm + (poses.rotation @ ball[..., None])[:, :, 0] - cup
        change: Array = np.sqrt((bar * bar) @ _ONES) - nominal_mm
        return change if push is None else (1.0 + push.gain) * change + push.reading_mm


class Plant:
    """The true machine, advanced cycle by cycle.

    Parameters
    ----------
    machine : Machine
        The true machine.
    position_mm, rotation : (3,) and (3, 3) arrays
        Approximate pose at power-on: base frame, mm.
    """

    def __init__(self, machine: Machine, position_mm: Array, rotation: Array) -> None:
        self.machine = machine
        self.time_s = 0.0
        self.poses = Poses(np.array(position_mm, dtype=float)[None], np.array(rotation, dtype=float)[None])
        self._read: tuple[Mounted, float] | None = None

    @property
    def poses(self) -> Poses:
        """The pose of the platform, at one instant."""
        if self._alone is not None:
            return Poses(np.array([self._alone.position]), np.array([self._alone.rotation]))
        return self._poses

    @poses.setter
    def poses(self, poses: Poses) -> None:
        # Without mechanisms nothing is ever displaced.
        is_alone = not self.machine.mechanisms
        self._alone = Undisplaced(self.machine.geometry, poses.position_mm[0], poses.rotation[0]) if is_alone else None
        self._poses, self._push = poses, Push(1)
        self._before = (self._push, poses, 0.0)
        self._earlier = poses.position_mm

    def step(self, drive_mm: Sequence[float], dt_s: float, mounted: Mounted | None = None) -> None:
        """Advance by one cycle.

        Parameters
        ----------
        drive_mm : sequence of float
            Drive positions at its end, mm, shape (6,).
        dt_s : float
            Cycle, s.
        mounted : Mounted, optional
            The bar, if one is mounted.

        Raises
        ------
        RunError
            The machine has no pose for these positions.
        """
        self.time_s += dt_s
        self._read = None
        if self._alone is not None:
            self._alone.step(drive_mm)
        else:
            self._step_displaced(np.array([drive_mm], dtype=float), dt_s, mounted)
        if mounted is not None:
            # Now, while the controller works on the answers of this cycle, and not when it waits for those of the next.
            self._read = mounted, self._reading_mm(mounted)

    def _step_displaced(self, at_mm: Array, dt_s: float, mounted: Mounted | None) -> None:
        mount = mounted.mount if mounted is not None else None
        # Where the platform would be on the parabola through its last places: saves one of three iterations.
        last, before, earlier = self._poses.position_mm, self._before[1].position_mm, self._earlier
        guess = Poses(3.0 * (last - before) + earlier, self._poses.rotation)
        self._before, self._earlier = (self._push, self._poses, dt_s), before
        self._push = self.machine.displaced(Motion(np.array([self.time_s]), dt_s, at_mm, mount))
        self._poses = self.machine.poses(at_mm, self._push, guess)

    def reading_mm(self, mounted: Mounted) -> float:
        """Return length minus nominal length of the mounted bar as the gauge shows it, without noise, mm."""
        if self._read is None or self._read[0] is not mounted:
            self._read = mounted, self._reading_mm(mounted)
        return self._read[1]

    def _reading_mm(self, mounted: Mounted) -> float:
        """Compute the reading of the present cycle.

        A gauge read earlier or later than the encoders is extrapolated linearly through the readings of this cycle and
        the one before, because the next cycle has not happened yet.
        """
        if self._alone is not None:
            ball, cup, nominal_mm = self.machine.setup_errors.true(mounted)
            return bar_mm(self._alone.position, self._alone.rotation, ball, cup) - nominal_mm
        now = float(self.machine.reading_mm(mounted, self._push, self._poses)[0])
        push, poses, dt_s = self._before
        if self._push.delay_s == 0.0 or dt_s == 0.0:
            return now
        before = float(self.machine.reading_mm(mounted, push, poses)[0])
        return now + self._push.delay_s * (now - before) / dt_s
