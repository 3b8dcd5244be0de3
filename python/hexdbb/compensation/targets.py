"""Slider targets of the machine as diagnosed for whole tables of poses: compensation that looks ahead.

Model: targets are the engine's (`compensation.hpp`). A direction-dependent correction changes by D mm at every reversal
of a slider. A controller that cannot look ahead spreads that change over some travel after the reversal; a table knows
every reversal beforehand and spreads it over the shortest time t that the drives allow, half of it before the reversal,
which leaves a quarter of the error.
Formula: the direction of travel, a square wave, through three moving averages of n cycles of T each: acceleration up to
D / (n T)^2 and jerk up to 2 D / (n T)^3, held within `CHANGE_SHARE` of the machine file's limits; t = 3 n T.
Assumption: the motion of the table is checked afterwards as a whole; reversals may follow each other so closely that a
slider would exceed its limits, and are then refused there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.compensation.reversals import Travel, smooth_changes
from hexdbb.kinematics import rpy_from_rotation, status_name
from hexdbb.machine import Limits
from hexdbb.trajectory import PoseRows, TargetParts, Targets
from hexdbb.trajectory.poses import Poses
from hexdbb.trajectory.targets import Refused

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

CHANGE_SHARE = 0.25
"""Share of a slider's acceleration and jerk limits that a change of direction may use: three quarters stay for the
path itself, which `hexdbb.trajectory` checks together with the correction."""
PROBE_EVERY = 16
"""Rows from one probe of the direction-dependent part to the next: it varies with the pose, hence slowly from cycle to
cycle (64 ms at 250 Hz)."""
LOOK_ROWS = 256 * PROBE_EVERY
"""Rows looked ahead at a time: as many as are computed at a time (`hexdbb.trajectory.table.BLOCK_ROWS`)."""


@dataclass(frozen=True)
class CompensatedTargets(Targets):
    """Slider targets under a compensation file.

    Attributes
    ----------
    data : CompensationData
    limits : Limits
        Velocity, acceleration and jerk limits of the sliders.
    name : str
        Name of the compensation file in error messages.
    temperature_c : float
        Measured temperature, °C; nan where there is none.
    """

    data: _core.CompensationData
    limits: Limits
    name: str
    temperature_c: float = math.nan

    def along(
        self, poses: PoseRows, cycle_s: float, before: Floats | None = None, after: Floats | None = None
    ) -> TargetParts:
        """See `hexdbb.trajectory.Targets.along`; reads all poses once."""
        travel, change_mm = self._looked_ahead(poses, cycle_s, before, after)
        cycles = [self._cycles(each, cycle_s) for each in change_mm]
        # Three moving averages, and the neighbours of a row, from which its velocity is known.
        reach = 3 * (max(cycles) // 2) + 1

        def part(first: int, last: int) -> tuple[Floats, Refused]:
            low, high = max(first - 1, 0), min(last + 1, poses.rows)
            begin, end = max(low - reach, 0), min(high + reach, poses.rows)
            directions = travel.directions(begin, end)
            smooth = np.column_stack([smooth_changes(*each) for each in zip(directions.T, cycles, strict=True)])
            position, rpy = poses.poses(low, high)
            since = None
            if self._has_since_reversal:
                since = travel.since_reversal_mm(low, self._nominal_mm(position, rpy))
            found = self._along(position, rpy, _times_s(cycle_s, low, high), smooth[low - begin : high - begin], since)
            own = slice(first - low, last - low)
            sliders_mm, correction_mm, status, slider = found
            refused = self._refused(status[own], slider[own], correction_mm[own])
            return sliders_mm[own], None if refused is None else (first + refused[0], refused[1])

        return TargetParts(travel.directions(0, 1)[0], part)

    def _looked_ahead(
        self, poses: PoseRows, cycle_s: float, before: Floats | None, after: Floats | None
    ) -> tuple[Travel, Floats]:
        """Return where each slider moves which way, and the largest change of each target at a reversal, (6,) mm."""
        travel, change_mm = Travel(before, after), np.zeros(6)
        for first in range(0, poses.rows, LOOK_ROWS):
            last = min(first + LOOK_ROWS, poses.rows)
            position, rpy = poses.poses(first, last)
            travel.take(self._nominal_mm(position, rpy))
            # With the probes before and after, which tell the velocity of the first and last one.
            low, high = max(first - PROBE_EVERY, 0), min(last + PROBE_EVERY, poses.rows)
            probed = slice(
                (first - low) // PROBE_EVERY, (first - low) // PROBE_EVERY + -(-(last - first) // PROBE_EVERY)
            )
            position, rpy = (each[::PROBE_EVERY] for each in poses.poses(low, high))
            times_s = _times_s(cycle_s, low, high)[::PROBE_EVERY]
            ones = np.ones((len(times_s), 6))
            # A function of the travel since a reversal changes from where it was long after one to where it begins.
            ago = (0.0, _core.LONG_AGO) if self._has_since_reversal else (0.0,)
            found = [
                self._along(position, rpy, times_s, side * ones, (since * ones, since * ones))[1][probed]
                for side in (1.0, -1.0)
                for since in ago
            ]
            change_mm = np.maximum(change_mm, np.ptp(found, axis=0).max(axis=0))
        return travel, change_mm

    @cached_property
    def _has_since_reversal(self) -> bool:
        """Whether a table depends on the travel since a reversal."""
        return any(table.variable == "since_reversal_mm" for table in self.data.tables)

    def _nominal_mm(self, position: Floats, rpy: Floats) -> Floats:
        """Return the coordinates of the nominal sliders, shape (n, 6)."""
        found: Floats = _core.inverse_table(self.data.machine, np.array(position), np.array(rpy))[0]
        return found

    def pose(self, sliders_mm: Floats) -> tuple[Poses, str | None]:
        """See `hexdbb.trajectory.Targets.pose`; the sliders have no direction of travel."""
        poses, status = self._compensator().poses_of(np.ascontiguousarray(sliders_mm[None, :]))
        why = f"{status_name(int(status[0]))} (expected a pose that the machine of {self.name} can take)"
        return (poses[:, :3], rpy_from_rotation(poses[0, 3:].reshape(3, 3))[None, :]), why if status[0] else None

    def _compensator(self) -> _core.Compensator:
        return _core.Compensator(self.data, self.name)

    def _along(
        self,
        position: Floats,
        rpy: Floats,
        times_s: Floats,
        direction: Floats,
        since_reversal_mm: tuple[Floats, Floats] | None = None,
    ) -> tuple[Floats, Floats, Ints, Ints]:
        temperature_c = np.full(len(position), self.temperature_c)
        contiguous = [np.ascontiguousarray(each) for each in (position, rpy, direction)]
        found: tuple[Floats, Floats, Ints, Ints] = self._compensator().sliders_along(
            contiguous[0], contiguous[1], times_s, temperature_c, contiguous[2], since_reversal_mm
        )
        return found

    def _cycles(self, change_mm: float, cycle_s: float) -> int:
        """Return the cycles of one moving average: an odd number, so that the middle of the change stays in place."""
        acceleration = CHANGE_SHARE * self.limits.acceleration_mm_s2
        jerk = CHANGE_SHARE * self.limits.jerk_mm_s3
        needed_s = max(math.sqrt(change_mm / acceleration), math.cbrt(2.0 * change_mm / jerk))
        return math.ceil(needed_s / cycle_s) | 1

    def _refused(self, status: Ints, slider: Ints, correction_mm: Floats) -> tuple[int, str] | None:
        failed = np.flatnonzero(status)
        if not failed.size:
            return None
        row = int(failed[0])
        at, name = int(slider[row]), status_name(int(status[row]))
        of = f"slider {at + 1}: " if at >= 0 else ""
        if status[row] == _core.CORRECTION_LIMIT:
            limit_um = 1e3 * self.data.max_correction_mm
            return row, (
                f"{of}correction of {1e3 * abs(correction_mm[row, at]):.1f} µm"
                f" (expected at most {limit_um:g} µm, the limit in {self.name})"
            )
        return row, f"{of}{name}, compensated (expected every pose within reach and travel)"


def _times_s(cycle_s: float, first: int, last: int) -> Floats:
    """Return the times of rows `first` to `last`, s."""
    return np.asarray(cycle_s * np.arange(first, last), dtype=np.float64)
