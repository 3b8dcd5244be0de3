"""When the drives are where: a plan's runs one after another, each at constant feed from overshoot to overshoot.

Model: a run is an arc at constant speed, the captured laps with an overshoot before and after, so that play, friction
and lag are in their steady course when the first sample is taken. Between runs the drives travel to the next beginning
along a half cosine in a fixed time. Time is counted in samples; an instant is a sample's fraction.
Assumption: drives follow their targets, nominal or compensated; what stands between drive and slider is a mechanism.
Formula: nominal inverse kinematics in closed form, from the rig's geometry without errors.
Units: mm, s, rad.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.machine import MachineFile
from hexdbb.plan import CircleRun, Plan
from hexdbb.rig.geometry import Array, TrueGeometry, rotation_rpy, true_geometry
from hexdbb.rig.mechanisms import Motion
from hexdbb.rig.plant import Mounted
from hexdbb.rig.pose_solver import Poses

Drive = Callable[[Array, Array, float], Array]
"""Positions (n, 3) mm, roll, pitch and yaw (n, 3) rad, time between them in s -> drives (n, 6) mm."""


@dataclass(frozen=True)
class Arc:
    """A run in time: the instants of its motion and which of them are samples.

    Attributes
    ----------
    run : CircleRun
    motion : Motion
        n instants.
    nominal : Poses
        Where the platform should be, n instants.
    angle_rad : (n,) array
        Polar angle, 0 at the beginning of the capture, falling in a clockwise run.
    samples : array of int
        The instants that are captured.
    mounted : Mounted
        Cup and bar as the plan has them.
    """

    run: CircleRun
    motion: Motion
    nominal: Poses
    angle_rad: Array
    samples: NDArray[np.intp]
    mounted: Mounted


class Timeline:
    """The runs of a plan in time.

    Parameters
    ----------
    plan : Plan
    machine : MachineFile
        The nominal machine.
    rate_hz : float
        Samples per second.
    instants_per_sample : int
        Instants that mechanisms go through from sample to sample.
    travel_s : float
        From the end of a run to the beginning of the next.
    drive : callable, optional
        Where the drives are told to go, by a controller that compensates; inverse kinematics of the nominal machine
        where none is given.
    """

    def __init__(
        self,
        plan: Plan,
        machine: MachineFile,
        rate_hz: float,
        instants_per_sample: int,
        travel_s: float,
        drive: Drive | None = None,
    ) -> None:
        self._drive = drive
        self._plan, self._nominal = plan, true_geometry(machine)
        self._rate_hz, self._fine = rate_hz, instants_per_sample
        self._travel_samples = max(1, math.ceil(travel_s * rate_hz))

    def stretches(self) -> Iterator[Arc | Motion]:
        """Return the arcs in order, and between them the motions of travel."""
        begin, before = 0, None
        for run in self._plan.runs():
            arc = self._arc(run, begin)
            if before is not None and self._fine > 1:
                yield self._travel(before, arc)
            yield arc
            begin += (len(arc.angle_rad) - 1) // self._fine + self._travel_samples
            before = arc

    def _arc(self, run: CircleRun, begin: int) -> Arc:
        circle, plan = run.circle, self._plan
        rad_per_sample = run.direction * run.feed_mm_min / 60.0 / circle.radius_mm / self._rate_hz
        overshoot = math.ceil(math.radians(plan.overshoot_deg) / abs(rad_per_sample))
        captured = math.ceil(run.laps * 2.0 * math.pi / abs(rad_per_sample))
        instants = np.arange((2 * overshoot + captured) * self._fine + 1)
        angle = rad_per_sample * (instants / self._fine - overshoot)
        nominal = _nominal_poses(run, angle)
        dt_s = 1.0 / (self._rate_hz * self._fine)
        motion = Motion(
            (begin + instants / self._fine) / self._rate_hz,
            dt_s,
            self._driven(run, nominal, dt_s),
            run.mount.id,
            circle.id,
        )
        mounted = Mounted(run.mount.id, run.mount.cup_mm, circle.ball_offset_mm, plan.gauge.bar_length_mm)
        samples = (overshoot + np.arange(captured)) * self._fine
        return Arc(run, motion, nominal, angle, samples, mounted)

    def _driven(self, run: CircleRun, nominal: Poses, dt_s: float) -> Array:
        if self._drive is None:
            return _sliders_mm(self._nominal, nominal)
        rpy_rad = np.broadcast_to(np.radians(run.circle.platform_rpy_deg), nominal.position_mm.shape)
        return self._drive(nominal.position_mm, rpy_rad, dt_s)

    def _travel(self, before: Arc, after: Arc) -> Motion:
        start, end = before.motion.drive_mm[-1], after.motion.drive_mm[0]
        share = np.arange(1, self._travel_samples * self._fine) / (self._travel_samples * self._fine)
        drive = start + 0.5 * (1.0 - np.cos(np.pi * share))[:, None] * (end - start)
        begin_s, dt_s = before.motion.time_s[-1], after.motion.dt_s
        return Motion(begin_s + dt_s * np.arange(1, len(share) + 1), dt_s, drive, before.run.mount.id)


def _nominal_poses(run: CircleRun, angle_rad: Array) -> Poses:
    circle = run.circle
    plane = rotation_rpy(*np.radians(circle.plane_rpy_deg))
    platform = rotation_rpy(*np.radians(circle.platform_rpy_deg))
    ring = np.stack([np.cos(angle_rad), np.sin(angle_rad), np.zeros_like(angle_rad)], axis=1)
    ball = np.array(run.mount.cup_mm) + circle.radius_mm * ring @ plane.T
    position = ball - platform @ np.array(circle.ball_offset_mm)
    return Poses(position, np.broadcast_to(platform, (len(angle_rad), 3, 3)))


def _sliders_mm(nominal: TrueGeometry, poses: Poses) -> Array:
    """Closed form, in blocks that stay in the processor's cache; (n, 6)."""
    block = 1024
    return np.concatenate(
        [
            nominal.sliders_for(poses.position_mm[first : first + block], poses.rotation[first : first + block])
            for first in range(0, len(poses.position_mm), block)
        ]
    )
