"""Time law of one path: the path length travelled at every cycle.

Model: one coordinate u (mm along the path), bounded velocity, acceleration and jerk, at rest at both ends; ruckig
finds the time-optimal profile. Sampled once per cycle, the first sample at u = 0.
Assumption users get wrong: a capture starts on a cycle. The lead-in is stretched by less than one cycle's feed so
that one sample falls exactly on the start of the capture; feed and captured arc stay as planned.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from ruckig import ControlInterface, InputParameter, Ruckig, RuckigError, Trajectory

from hexdbb.errors import InputError
from hexdbb.trajectory.extent import ROWS_MAX, Extent, too_long

ROUNDING = 1e-9
"""Limits what counts as rounding, in cycles and in mm: above the rounding of double precision over 1e6 cycles, far
below one cycle and one encoder step (1e-4 mm)."""


@dataclass(frozen=True)
class PathLimits:
    """Limits of the motion along a path: mm/s, mm/s², mm/s³."""

    velocity_mm_s: float
    acceleration_mm_s2: float
    jerk_mm_s3: float


@dataclass(frozen=True)
class TimeLaw:
    """Path coordinate per cycle, computed for any part of the rows; at rest at both ends.

    Attributes
    ----------
    trajectory : profile in time
    cycle_s : time between two rows
    where : name of the path in errors
    """

    trajectory: Trajectory
    cycle_s: float
    where: str = "path"

    def __post_init__(self) -> None:
        if self.trajectory.duration > ROWS_MAX * self.cycle_s:
            raise InputError(f"{self.where}: {too_long(Extent(self.trajectory.duration, self.cycle_s))}")

    @property
    def rows(self) -> int:
        """Cycles up to the first one at or after the end."""
        duration_s: float = self.trajectory.duration
        return math.ceil(duration_s / self.cycle_s) + 1

    def u_mm(self, first: int = 0, last: int | None = None) -> NDArray[np.float64]:
        """Return the path coordinate of rows `first` to `last`, the last one left out; by default of all, (n,) mm."""
        end_s, cycle_s, at_time = self.trajectory.duration, self.cycle_s, self.trajectory.at_time
        rows = range(first, self.rows if last is None else last)
        return np.fromiter((at_time(min(k * cycle_s, end_s))[0][0] for k in rows), np.float64, len(rows))


@dataclass(frozen=True)
class FeedLaw:
    """Constant feed over a captured length, with a lead before and after it to accelerate and to stop.

    Attributes
    ----------
    law : path coordinate from the beginning of the lead
    lead_cycles : row at which the capture begins
    lead_mm : length before and length after the capture, extended to whole cycles
    capture_mm : captured length
    feed_mm_s : feed over it
    """

    law: TimeLaw
    lead_cycles: int
    lead_mm: float
    capture_mm: float
    feed_mm_s: float

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.law.rows

    @property
    def captured(self) -> int:
        """Number of rows captured."""
        # The feed is constant: the row at which the capture ends is known but for one, which is looked at.
        end = self.lead_cycles + round(self.capture_mm / (self.feed_mm_s * self.law.cycle_s))
        near = range(max(end - 2, self.lead_cycles), min(end + 3, self.rows))
        ends = self.capture(near.start, self.u_mm(near.start, near.stop))
        return near.start - self.lead_cycles + int(ends.sum())

    def u_mm(self, first: int = 0, last: int | None = None) -> NDArray[np.float64]:
        """Return the path coordinate of some rows, (n,) mm: 0 at the start of the capture, negative before it."""
        u_mm = self.law.u_mm(first, last) - self.lead_mm
        if first <= self.lead_cycles < first + len(u_mm):
            u_mm[self.lead_cycles - first] = 0.0  # exact but for rounding
        return u_mm

    def capture(self, first: int, u_mm: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return which rows from `first` on are captured: from 0 up to, and not including, the captured length."""
        rows = np.arange(first, first + len(u_mm))
        captured: NDArray[np.bool_] = (rows >= self.lead_cycles) & (u_mm < self.capture_mm - ROUNDING)
        return captured


def rest_to_rest(length_mm: float, limits: PathLimits, cycle_s: float, where: str = "path") -> TimeLaw:
    """Compute the time law from rest at 0 to rest at `length_mm`, both ends included.

    Raises
    ------
    InputError
        There is no time law within the limits, or it has more than `ROWS_MAX` rows; begins with `where`.
    """
    return TimeLaw(_fastest(length_mm, limits, where), cycle_s, where)


def feed_law(
    overshoot_mm: float, capture_mm: float, limits: PathLimits, cycle_s: float, where: str = "path"
) -> FeedLaw:
    """Compute the time law of a capture: rest to feed, constant over overshoot, capture and overshoot, then to rest.

    Parameters
    ----------
    overshoot_mm : length at full feed before and after the capture
    capture_mm : captured length, driven at exactly `limits.velocity_mm_s`
    limits : the feed, and the acceleration and jerk of the ramps
    cycle_s : time between two samples
    where : name of the path in errors

    Raises
    ------
    InputError
        There is no time law within the limits, or it has more than `ROWS_MAX` rows.
    """
    feed_mm_s = limits.velocity_mm_s
    ramp_mm, ramp_s = _ramp(limits, where)
    to_capture_s = ramp_s + overshoot_mm / feed_mm_s
    lead_cycles = math.ceil(to_capture_s / cycle_s - ROUNDING)
    lead_mm = ramp_mm + overshoot_mm + (lead_cycles * cycle_s - to_capture_s) * feed_mm_s
    trajectory = _fastest(capture_mm + 2 * lead_mm, limits, where)
    return FeedLaw(TimeLaw(trajectory, cycle_s, where), lead_cycles, lead_mm, capture_mm, feed_mm_s)


def _input(limits: PathLimits) -> InputParameter:
    parameter = InputParameter(1)
    parameter.max_velocity = [limits.velocity_mm_s]
    parameter.max_acceleration = [limits.acceleration_mm_s2]
    parameter.max_jerk = [limits.jerk_mm_s3]
    return parameter


def _fastest(length_mm: float, limits: PathLimits, where: str) -> Trajectory:
    parameter = _input(limits)
    parameter.target_position = [length_mm]
    return _calculated(parameter, limits, where)


def _ramp(limits: PathLimits, where: str) -> tuple[float, float]:
    """Return length (mm) and time (s) from rest to the limit velocity."""
    parameter = _input(limits)
    parameter.control_interface = ControlInterface.Velocity
    parameter.target_velocity = [limits.velocity_mm_s]
    trajectory = _calculated(parameter, limits, where)
    (length_mm,), _, _ = trajectory.at_time(trajectory.duration)
    return length_mm, trajectory.duration


def _calculated(parameter: InputParameter, limits: PathLimits, where: str) -> Trajectory:
    trajectory = Trajectory(1)
    try:
        Ruckig(1).calculate(parameter, trajectory)
    except RuckigError:
        found = f"{limits.velocity_mm_s:.3g} mm/s, {limits.acceleration_mm_s2:.3g} mm/s², {limits.jerk_mm_s3:.3g} mm/s³"
        expected = "a feed and limits of the sliders that a path can be driven with"
        raise InputError(f"{where}: no time law with {found} along the path (expected {expected})") from None
    return trajectory
