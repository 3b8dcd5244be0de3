"""Slider targets of a machine as diagnosed, for whole tables of poses: compensation that looks ahead.

Model: targets are the engine's (`compensation.hpp`). What depends on the side a slider comes from (lost motion) changes
at every turn of the slider by D mm. A controller that cannot look ahead spreads that over some travel after the turn; a
table knows every turn beforehand and spreads it over the shortest time t that the drives allow, half of it before the
turn, which leaves a fourth of the error. Where the slider rests between two ways, it changes sides in mid-rest.
Formula: the side, a square wave, through three moving averages over n cycles of T each: acceleration up to D / (n T)^2
and jerk up to 2 D / (n T)^3, held within `SHARE` of the machine file's limits; t = 3 n T.
Assumption: the motion of the table is checked afterwards as a whole; turns may come so close together that a slider
would exceed its limits, and are then refused there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from hexdbb import _core
from hexdbb.kinematics import rpy_from_rotation, status_name
from hexdbb.machine import Limits
from hexdbb.trajectory import TargetRows
from hexdbb.trajectory.poses import Poses

Floats = NDArray[np.float64]

SHARE = 0.25
"""Part of a slider's acceleration and jerk that a change of sides may take."""
STANDING_MM = 1e-9
"""A slider that moves less than this from row to row rests: it is the rounding of inverse kinematics."""
THINNED = 16
"""Every so many rows are asked how much their targets depend on the side."""


@dataclass(frozen=True)
class CompensatedTargets:
    """Targets under a compensation file; a `hexdbb.trajectory.Targets`.

    Attributes
    ----------
    data : CompensationData
    limits : what a slider may do
    name : how errors name the file
    temperature_c : measured, for growth; nan where it is not
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
        turns = sides(nominal_mm, before, after)
        smooth = np.column_stack(
            [
                uniform_smooth(column, self._cycles(change_mm, cycle_s))
                for column, change_mm in zip(turns.T, self._change_mm(position, rpy, cycle_s), strict=True)
            ]
        )
        sliders_mm, correction_mm, status, slider = self._along(position, rpy, cycle_s, smooth)
        return TargetRows(sliders_mm, self._refused(status, slider, correction_mm), turns[0])

    def pose(self, sliders_mm: Floats) -> tuple[Poses, str | None]:
        """See `hexdbb.trajectory.Targets.pose`; no slider comes from either side."""
        poses, status = self._compensator().poses_of(np.ascontiguousarray(sliders_mm[None, :]))
        why = f"{status_name(int(status[0]))} (expected a pose of the machine as {self.name} has it)"
        return (poses[:, :3], rpy_from_rotation(poses[0, 3:].reshape(3, 3))[None, :]), why if status[0] else None

    def _compensator(self) -> _core.Compensator:
        return _core.Compensator(self.data, self.name)

    def _along(
        self, position: Floats, rpy: Floats, cycle_s: float, side: Floats
    ) -> tuple[Floats, Floats, NDArray[np.int32], NDArray[np.int32]]:
        times_s, temperature_c = cycle_s * np.arange(len(position)), np.full(len(position), self.temperature_c)
        found: tuple[Floats, Floats, NDArray[np.int32], NDArray[np.int32]] = self._compensator().sliders_along(
            position, rpy, times_s, temperature_c, np.ascontiguousarray(side)
        )
        return found

    def _change_mm(self, position: Floats, rpy: Floats, cycle_s: float) -> Floats:
        """Most that each target depends on the sides, (6,): that of one side less that of the other."""
        some, held = np.ascontiguousarray(position[::THINNED]), np.ascontiguousarray(rpy[::THINNED])
        ones = np.ones((len(some), 6))
        up, down = (self._along(some, held, THINNED * cycle_s, side)[1] for side in (ones, -ones))
        change_mm: Floats = np.abs(up - down).max(axis=0)
        return change_mm

    def _cycles(self, change_mm: float, cycle_s: float) -> int:
        """Cycles of one moving average; an odd number, so that the middle stays where it is."""
        share = (SHARE * self.limits.acceleration_mm_s2, SHARE * self.limits.jerk_mm_s3)
        needed_s = max(math.sqrt(change_mm / share[0]), math.cbrt(2.0 * change_mm / share[1]))
        return math.ceil(needed_s / cycle_s) | 1

    def _refused(
        self, status: NDArray[np.int32], slider: NDArray[np.int32], correction_mm: Floats
    ) -> tuple[int, str] | None:
        failed = np.flatnonzero(status)
        if not failed.size:
            return None
        row = int(failed[0])
        at, name = int(slider[row]), status_name(int(status[row]))
        of = f"slider {at + 1}: " if at >= 0 else ""
        if status[row] == _core.CORRECTION_LIMIT:
            limit_um = 1e3 * self.data.max_correction_mm
            return row, (
                f"{of}correction of {1e3 * abs(correction_mm[row, at]):.1f} um"
                f" (expected at most {limit_um:g} um, as {self.name} allows)"
            )
        return row, f"{of}{name}, compensated (expected every pose within reach and travel)"


def sides(sliders_mm: Floats, before: Floats | None = None, after: Floats | None = None) -> Floats:
    """Side each slider comes from, +1 where its coordinate grows and -1 where it falls; (n, 6).

    Parameters
    ----------
    sliders_mm : (n, 6) in order of motion
    before, after : (6,) sides at the first row and after the last; None: those of the first and the last motion

    Returns
    -------
    ndarray
        A resting slider comes from the side of the nearer motion, `before` and `after` counting as such; 0 where a
        slider never moves.
    """
    steps = np.diff(sliders_mm, axis=0)
    moved = np.where(np.abs(steps) > STANDING_MM, np.sign(steps), 0.0)
    # A row belongs to the motion towards it; the first one to that which leaves it.
    way = np.vstack([moved[:1] if len(moved) else np.zeros((1, 6)), moved])
    rows = np.arange(len(way))
    columns = [
        _nearest(way[:, k], rows, None if before is None else before[k], None if after is None else after[k])
        for k in range(way.shape[1])
    ]
    return np.column_stack(columns)


def _nearest(way: Floats, rows: NDArray[np.intp], before: float | None, after: float | None) -> Floats:
    known, value = np.flatnonzero(way), way[way != 0.0]
    if before is not None:
        known, value = np.append(-1, known), np.append(before, value)
    if after is not None:
        known, value = np.append(known, len(way)), np.append(value, after)
    if not len(known):
        return np.zeros(len(way))
    right = np.clip(np.searchsorted(known, rows), 0, len(known) - 1)
    left = np.clip(right - 1, 0, None)
    nearer_left = np.abs(rows - known[left]) < np.abs(known[right] - rows)
    found: Floats = np.where(nearer_left, value[left], value[right])
    return found


def uniform_smooth(side: Floats, cycles: int) -> Floats:
    """Three moving averages over an odd number of cycles, the ends held; shape (n,)."""
    for _ in range(3 if cycles > 1 else 0):
        side = uniform_filter1d(side, cycles, mode="nearest")
    return np.clip(side, -1.0, 1.0)
