"""A plan in time as mechanisms see it: every instant from the first overshoot to the last, and which are samples.

Model: the runs and travels of `hexdbb_truth.timeline`, joined on one even grid of time. What a mechanism may depend on
(direction of travel, turning of joints, leg forces, place on the circle) is derived from the nominal machine, once.
Assumption: while the machine travels from run to run its legs turn evenly from one direction to the next; nothing is
measured there, only the mechanisms' memory goes through it.
Units: mm, s, rad, N. Frames: base frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb.machine import MachineFile
from hexdbb.plan import Plan
from hexdbb.rig.geometry import Array, TrueGeometry, true_geometry
from hexdbb.rig.pose_solver import Hexapod, Poses, leg_forces_n
from hexdbb_truth.simulate import Pace
from hexdbb_truth.timeline import Arc, Drive, Timeline

Rows = NDArray[np.intp]

BLOCK = 16384
"""Instants whose leg forces are solved at once: their matrices of 6 x 6 stay below 5 MB."""


@dataclass(frozen=True)
class Pieces:
    """Where a slider (or a joint) keeps its direction: `begin[i]` to `begin[i + 1]`, moving `sign[i]`."""

    begin: Rows
    sign: Array


class History:
    """The instants of a plan.

    Parameters
    ----------
    plan : Plan
    pace : Pace
        How finely time is cut.
    drive : Drive, optional
        Slider targets of a controller that compensates; the nominal machine's where not given.

    Attributes
    ----------
    time_s : (N,) array
    dt_s : float
    drive_mm : (N, 6) array
        Where the drives are.
    samples : (n,) array of int
        Instants at which the gauge is read.
    run : (N,) array of int
        Sweep; -1 while travelling.
    position_mm, rotation : (N, 3) and (N, 3, 3) arrays
        Nominal pose; zero and identity while travelling.
    angle_rad : (N,) array
        Polar angle of the run; 0 while travelling.
    """

    def __init__(self, plan: Plan, pace: Pace, drive: Drive | None = None) -> None:
        self.plan, self.pace = plan, pace
        self.machine: MachineFile = plan.machine_file()
        self.nominal: TrueGeometry = true_geometry(self.machine)
        line = Timeline(plan, self.machine, pace.rate_hz, pace.instants_per_sample, pace.travel_s, drive)
        time, driven, run, position, rotation, angle, samples = [], [], [], [], [], [], []
        self.runs, begin = plan.runs(), 0
        for stretch in line.stretches():
            motion = stretch.motion if isinstance(stretch, Arc) else stretch
            n = len(motion.time_s)
            time.append(motion.time_s)
            driven.append(motion.drive_mm)
            if isinstance(stretch, Arc):
                run.append(np.full(n, stretch.run.sweep))
                position.append(stretch.nominal.position_mm)
                rotation.append(stretch.nominal.rotation)
                angle.append(stretch.angle_rad)
                samples.append(begin + stretch.samples)
            else:
                run.append(np.full(n, -1))
                position.append(np.zeros((n, 3)))
                rotation.append(np.broadcast_to(np.eye(3), (n, 3, 3)))
                angle.append(np.zeros(n))
            begin += n
        self.time_s, self.drive_mm = np.concatenate(time), np.concatenate(driven)
        self.dt_s = float(self.time_s[1] - self.time_s[0])
        assert np.allclose(np.diff(self.time_s), self.dt_s, rtol=1e-6), "time is one even grid"
        self.run, self.samples = np.concatenate(run), np.concatenate(samples)
        self.position_mm, self.rotation = np.concatenate(position), np.concatenate(rotation)
        self.angle_rad = np.concatenate(angle)

    def __len__(self) -> int:
        return len(self.time_s)

    def of_run(self, rows: Rows, values: list[float] | list[int]) -> NDArray[np.float64]:
        """Return a run's value at instants of runs, shape of `rows`."""
        return np.asarray(np.asarray(values, dtype=float)[self.run[rows]])

    def direction(self, rows: Rows) -> Array:
        """Return +1 counter-clockwise, -1 clockwise."""
        return self.of_run(rows, [float(run.direction) for run in self.runs])

    def feed_mm_s(self, rows: Rows) -> Array:
        """Return the ball's speed along its circle."""
        return self.of_run(rows, [run.feed_mm_min / 60.0 for run in self.runs])

    def circle(self, rows: Rows) -> Array:
        """Return the position of the circle in the plan, from 0."""
        ids = [circle.id for circle in self.plan.circles]
        return self.of_run(rows, [ids.index(run.circle.id) for run in self.runs])

    def mount(self, rows: Rows) -> Array:
        """Return the mount's id."""
        return self.of_run(rows, [run.mount.id for run in self.runs])

    def since_run_began_s(self, rows: Rows) -> Array:
        """Return the time since the overshoot of each instant's run began."""
        begin = [float(self.time_s[np.argmax(self.run == run.sweep)]) for run in self.runs]
        return np.asarray(self.time_s[rows] - self.of_run(rows, begin))

    def poses(self, rows: Rows) -> Poses:
        """Return nominal poses."""
        return Poses(self.position_mm[rows], self.rotation[rows])

    def bar_direction(self, rows: Rows) -> Array:
        """Return the unit vector from cup to ball, base frame, shape (n, 3)."""
        ball = np.array([run.circle.ball_offset_mm for run in self.runs])[self.run[rows]]
        cup = np.array([run.mount.cup_mm for run in self.runs])[self.run[rows]]
        bar = self.position_mm[rows] + np.einsum("nij,nj->ni", self.rotation[rows], ball) - cup
        return np.asarray(bar / np.linalg.norm(bar, axis=1)[:, None])

    @cached_property
    def velocity_mm_s(self) -> Array:
        """Velocity of the drives, shape (N, 6)."""
        return np.asarray(np.gradient(self.drive_mm, self.dt_s, axis=0))

    @cached_property
    def acceleration_mm_s2(self) -> Array:
        """Acceleration of the drives, shape (N, 6)."""
        return np.asarray(np.gradient(self.velocity_mm_s, self.dt_s, axis=0))

    @cached_property
    def leg_direction(self) -> Array:
        """Unit vectors along the legs, from slider to platform, shape (N, 6, 3)."""
        legs = (
            self.nominal.joints_mm @ np.swapaxes(self.rotation, 1, 2)
            + self.position_mm[:, None, :]
            - self.nominal.slider_joints_mm(self.drive_mm)
        )
        unit = np.asarray(legs / np.linalg.norm(legs, axis=2)[:, :, None])
        on_circle = np.flatnonzero(self.run >= 0)
        way = np.flatnonzero(self.run < 0)
        if len(way):
            after = np.searchsorted(on_circle, way)
            first, last = on_circle[after - 1], on_circle[after]
            share = ((way - first) / (last - first))[:, None, None]
            between = unit[first] + share * (unit[last] - unit[first])
            unit[way] = between / np.linalg.norm(between, axis=2)[:, :, None]
        return unit

    @cached_property
    def slider_joint_angle_rad(self) -> Array:
        """Angle between leg and guideway at the slider joint, shape (N, 6)."""
        cosine = np.einsum("nij,ij->ni", self.leg_direction, self.nominal.directions)
        return np.asarray(np.arccos(cosine))

    @cached_property
    def slider_joint_rate_rad_s(self) -> Array:
        """Turning rate of the slider joints, shape (N, 6)."""
        return np.asarray(np.gradient(self.slider_joint_angle_rad, self.dt_s, axis=0))

    def platform_leg_direction(self, rows: Rows) -> Array:
        """Return the legs' directions in the platform frame, shape (n, 6, 3)."""
        return np.asarray(self.leg_direction[rows] @ self.rotation[rows])

    def leg_force_n(self, rows: Rows) -> Array:
        """Return the static thrust of the legs under the machine's weight, pressure positive, shape (n, 6)."""
        n = len(rows)
        hexapod = Hexapod(
            self.nominal.slider_joints_mm(self.drive_mm[rows]),
            np.broadcast_to(self.nominal.joints_mm, (n, 6, 3)),
            np.broadcast_to(self.nominal.lengths_mm, (n, 6)),
        )
        return leg_forces_n(hexapod, self.poses(rows), self.nominal.weight_n)

    def bridged(self, values: Array) -> Array:
        """Return values of all instants, (N, ...), with those of travels taken evenly from one run to the next."""
        runs = np.flatnonzero(self.run >= 0)
        flat = values.reshape(len(self), -1)[runs]
        every = [np.interp(np.arange(len(self)), runs, one) for one in flat.T]
        return np.stack(every, axis=1).reshape(values.shape)

    @cached_property
    def thrust_n(self) -> Array:
        """Static thrust of the legs as `leg_force_n` has it, at all instants, shape (N, 6)."""
        runs = np.flatnonzero(self.run >= 0)
        thrust = np.zeros_like(self.drive_mm)
        for first in range(0, len(runs), BLOCK):
            rows = runs[first : first + BLOCK]
            thrust[rows] = self.leg_force_n(rows)
        return self.bridged(thrust)

    @cached_property
    def push_n(self) -> Array:
        """Push of the legs on their sliders along the guideways, positive away from slider 0, shape (N, 6)."""
        return np.asarray(-self.thrust_n * np.cos(self.slider_joint_angle_rad))

    def pieces(self, slider: int) -> Pieces:
        """Return the monotone pieces of a slider's motion (from 0)."""
        return self._slider_pieces[slider]

    def joint_pieces(self, leg: int) -> Pieces:
        """Return the monotone pieces of a slider joint's turning (leg from 0)."""
        return self._joint_pieces[leg]

    @cached_property
    def _slider_pieces(self) -> list[Pieces]:
        return [monotone(self.drive_mm[:, k]) for k in range(6)]

    @cached_property
    def _joint_pieces(self) -> list[Pieces]:
        return [monotone(self.slider_joint_angle_rad[:, k]) for k in range(6)]


def monotone(values: Array) -> Pieces:
    """Return the pieces in which values keep their direction; a rest belongs to the piece before it."""
    moved = np.sign(np.diff(values, prepend=values[0]))
    last = np.maximum.accumulate(np.where(moved != 0.0, np.arange(len(moved)), 0))
    sign = moved[last]
    sign[sign == 0.0] = sign[np.argmax(sign != 0.0)]
    begin = np.concatenate([[0], np.flatnonzero(np.diff(sign) != 0.0) + 1])
    return Pieces(begin, sign[begin])
