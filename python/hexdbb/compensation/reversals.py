"""Directions of travel of sliders along a known motion, and how a change of direction is spread over time.

A motion of millions of rows is taken in block by block; what is kept of it is where each slider moved which way, from
which coordinate to which.

A slider that rests has the direction of the nearer motion, so that it changes over in the middle of its rest. The
change, a step from -1 to +1 or back, is smoothed by three moving averages of n cycles each: the second difference of a
step of height D is then at most D / n^2, the third at most 2 D / n^3.

What depends on the travel since a reversal changes over likewise, hence the travel is known in either direction: in the
direction of the nearer motion from where that began; in the other, near the beginning, all the travel of the motion
before, and near the end none.
"""

from __future__ import annotations

from array import array

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from hexdbb import _core

Floats = NDArray[np.float64]

REST_MM = 1e-9
"""Largest slider motion from row to row that counts as rest, mm: the rounding of inverse kinematics stays below it."""


class Travel:
    """Where each slider moved which way; made of a motion that is taken in from its first row to its last.

    Parameters
    ----------
    before, after : ndarray, shape (6,), optional
        Directions of travel before the first and after the last row; by default those of the first and last motion.
    """

    def __init__(self, before: Floats | None = None, after: Floats | None = None) -> None:
        self._after = after
        self._rows = 0
        self._last_mm: Floats | None = None
        self._moves = [_Moves() for _ in range(6)]
        if before is not None:
            for moves, value in zip(self._moves, before, strict=True):
                moves.add(-1, -1, value, np.nan, np.nan)

    def take(self, sliders_mm: Floats) -> None:
        """Take in the next rows: slider coordinates (n, 6) in order of motion, mm."""
        leading = self._last_mm is None
        known = sliders_mm if self._last_mm is None else np.vstack([self._last_mm, sliders_mm])
        steps = np.diff(known, axis=0)
        moved = np.where(np.abs(steps) > REST_MM, np.sign(steps), 0.0)
        if leading:
            # A row belongs to the motion that leads to it; the first row to the motion that leaves it.
            moved = np.vstack([moved[:1] if len(moved) else np.zeros((1, 6)), moved])
            known = np.vstack([known[:1], known])
        for moves, column, place_mm in zip(self._moves, moved.T, known.T, strict=True):
            moves.take(self._rows, column, place_mm)
        self._rows += len(sliders_mm)
        self._last_mm = sliders_mm[-1:].copy()

    def directions(self, first: int, last: int) -> Floats:
        """Return directions of travel of rows `first` to `last`, shape (n, 6), as `travel_directions` does."""
        rows = np.arange(first, last)
        after = [None] * 6 if self._after is None else list(self._after)
        return np.column_stack(
            [moves.nearest(rows, self._rows, value) for moves, value in zip(self._moves, after, strict=True)]
        )

    def since_reversal_mm(self, first: int, sliders_mm: Floats) -> tuple[Floats, Floats]:
        """Return the travel since a reversal in rows from `first` on with these slider coordinates (n, 6).

        Returns
        -------
        down, up : ndarray, shape (n, 6)
            Of motion down and of motion up, mm; `LONG_AGO` where a slider has not reversed yet, and throughout a motion
            that leads to another: that one counts from its own first reversals, and nothing is to jump between them.
        """
        if self._after is not None:
            never = np.full(sliders_mm.shape, _core.LONG_AGO)
            return never, never
        rows = np.arange(first, first + len(sliders_mm))
        both = [moves.since_mm(rows, column) for moves, column in zip(self._moves, sliders_mm.T, strict=True)]
        return np.column_stack([down for down, _ in both]), np.column_stack([up for _, up in both])


def travel_directions(sliders_mm: Floats, before: Floats | None = None, after: Floats | None = None) -> Floats:
    """Return each slider's direction of travel: +1 where its coordinate grows, -1 where it falls.

    Parameters
    ----------
    sliders_mm : ndarray, shape (n, 6)
        Slider coordinates in order of motion, mm.
    before, after : ndarray, shape (6,), optional
        Directions of travel before the first and after the last row; by default those of the first and last motion.

    Returns
    -------
    ndarray, shape (n, 6)
        A resting slider has the direction of the nearer motion, `before` and `after` included; 0 where a slider never
        moves.
    """
    travel = Travel(before, after)
    travel.take(sliders_mm)
    return travel.directions(0, len(sliders_mm))


def smooth_changes(direction: Floats, cycles: int) -> Floats:
    """Return directions of travel (n,) smoothed by three moving averages of an odd number of cycles, ends held."""
    for _ in range(3 if cycles > 1 else 0):
        direction = uniform_filter1d(direction, cycles, mode="nearest")
    return np.clip(direction, -1.0, 1.0)


class _Moves:
    """Rows between which one slider moved one way: first and last row, direction, and coordinates there."""

    def __init__(self) -> None:
        self._begins, self._ends, self._values = array("q"), array("q"), array("d")
        self._from_mm, self._to_mm = array("d"), array("d")

    def add(self, begin: int, end: int, value: float, from_mm: float, to_mm: float) -> None:
        """Add one move after those known, or prolong the last one, whether it rested in between or not."""
        if self._ends and self._values[-1] == value:
            self._ends[-1], self._to_mm[-1] = end, to_mm
            return
        self._begins.append(begin)
        self._ends.append(end)
        self._values.append(value)
        self._from_mm.append(from_mm)
        self._to_mm.append(to_mm)

    def take(self, first: int, direction: Floats, place_mm: Floats) -> None:
        """Take in the directions (n,) of rows from `first` on, 0 where the slider rests, and its coordinates (n + 1,).

        The coordinates begin with that of the row before.
        """
        starts = np.flatnonzero(np.r_[True, direction[1:] != direction[:-1]])
        for start, end in zip(starts, [*starts[1:], len(direction)], strict=True):
            if direction[start]:
                move = (first + int(start), first + int(end) - 1, float(direction[start]))
                self.add(*move, float(place_mm[start]), float(place_mm[end]))

    def nearest(self, rows: NDArray[np.intp], count: int, after: float | None) -> Floats:
        """Return the direction of the move nearest to each row, of `count` in all; of two as near, of the later."""
        begins, ends, values = (np.array(each) for each in (self._begins, self._ends, self._values))
        if after is not None:
            begins, ends, values = np.append(begins, count), np.append(ends, count), np.append(values, after)
        if not len(values):
            return np.zeros(len(rows))
        found: Floats = values[_nearest(rows, begins, ends)]
        return found

    def since_mm(self, rows: NDArray[np.intp], place_mm: Floats) -> tuple[Floats, Floats]:
        """Return the travel since a reversal of motion down and of motion up, shape (n,) each."""
        if not len(self._values):
            never = np.full(len(rows), _core.LONG_AGO)
            return never, never
        begins, ends, values, from_mm, to_mm = (
            np.array(each) for each in (self._begins, self._ends, self._values, self._from_mm, self._to_mm)
        )
        # The first move, and that after a stretch of which nothing is known, follow no reversal.
        is_reversal = np.r_[False, values[1:] == -values[:-1]]
        whole_mm = np.where(is_reversal, np.abs(to_mm - from_mm), _core.LONG_AGO)
        at = _nearest(rows, begins, ends)
        own = np.where(is_reversal[at], np.maximum(values[at] * (place_mm - from_mm[at]), 0.0), _core.LONG_AGO)
        is_near_begin = rows - begins[at] < ends[at] - rows
        is_known = values[at] != 0.0
        other = np.where(is_near_begin | ~is_known, np.where(at > 0, whole_mm[at - 1], _core.LONG_AGO), 0.0)
        is_up = values[at] > 0.0
        return np.where(is_up, other, own), np.where(is_up, own, other)


def _nearest(rows: NDArray[np.intp], begins: NDArray[np.int64], ends: NDArray[np.int64]) -> NDArray[np.intp]:
    """Return the place of the move nearest to each row; of two as near, of the later."""
    right = np.clip(np.searchsorted(ends, rows), 0, len(ends) - 1)
    left = np.clip(right - 1, 0, None)
    to_right = np.where(rows > ends[right], rows - ends[right], np.maximum(begins[right] - rows, 0))
    return np.where(np.abs(rows - ends[left]) < to_right, left, right)
