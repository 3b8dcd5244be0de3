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

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.compensation.reversals import smooth_changes, travel_directions
from hexdbb.kinematics import rpy_from_rotation, status_name
from hexdbb.machine import Limits
from hexdbb.trajectory import TargetRows
from hexdbb.trajectory.poses import Poses

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

CHANGE_SHARE = 0.25
"""Share of a slider's acceleration and jerk limits that a change of direction may use: three quarters stay for the
path itself, which `hexdbb.trajectory` checks together with the correction."""
PROBE_EVERY = 16
"""Rows from one probe of the direction-dependent part to the next: it varies with the pose, hence slowly from cycle to
cycle (64 ms at 250 Hz)."""


@dataclass(frozen=True)
class CompensatedTargets:
    """Slider targets under a compensation file; a `hexdbb.trajectory.Targets`.

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

    def sliders(
        self,
        position_mm: Floats,
        rpy_rad: Floats,
        cycle_s: float,
        before: Floats | None = None,
        after: Floats | None = None,
    ) -> TargetRows:
        """See `hexdbb.trajectory.Targets.sliders`."""
        position, rpy = np.ascontiguousarray(position_mm), np.ascontiguousarray(rpy_rad)
        nominal_mm = _core.inverse_table(self.data.machine, position, rpy)[0]
        directions = travel_directions(nominal_mm, before, after)
        smooth = np.column_stack(
            [
                smooth_changes(column, self._cycles(change_mm, cycle_s))
                for column, change_mm in zip(directions.T, self._change_mm(position, rpy, cycle_s), strict=True)
            ]
        )
        sliders_mm, correction_mm, status, slider = self._along(position, rpy, cycle_s, smooth)
        return TargetRows(sliders_mm, self._refused(status, slider, correction_mm), directions[0])

    def pose(self, sliders_mm: Floats) -> tuple[Poses, str | None]:
        """See `hexdbb.trajectory.Targets.pose`; the sliders have no direction of travel."""
        poses, status = self._compensator().poses_of(np.ascontiguousarray(sliders_mm[None, :]))
        why = f"{status_name(int(status[0]))} (expected a pose that the machine of {self.name} can take)"
        return (poses[:, :3], rpy_from_rotation(poses[0, 3:].reshape(3, 3))[None, :]), why if status[0] else None

    def _compensator(self) -> _core.Compensator:
        return _core.Compensator(self.data, self.name)

    def _along(
        self, position: Floats, rpy: Floats, cycle_s: float, direction: Floats
    ) -> tuple[Floats, Floats, Ints, Ints]:
        times_s, temperature_c = cycle_s * np.arange(len(position)), np.full(len(position), self.temperature_c)
        found: tuple[Floats, Floats, Ints, Ints] = self._compensator().sliders_along(
            position, rpy, times_s, temperature_c, np.ascontiguousarray(direction)
        )
        return found

    def _change_mm(self, position: Floats, rpy: Floats, cycle_s: float) -> Floats:
        """Return the largest change of each target at a reversal, shape (6,)."""
        some, held = np.ascontiguousarray(position[::PROBE_EVERY]), np.ascontiguousarray(rpy[::PROBE_EVERY])
        ones = np.ones((len(some), 6))
        up, down = (self._along(some, held, PROBE_EVERY * cycle_s, direction)[1] for direction in (ones, -ones))
        change_mm: Floats = np.abs(up - down).max(axis=0)
        return change_mm

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
