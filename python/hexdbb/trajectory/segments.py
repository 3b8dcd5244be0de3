"""Segments of a motion, each computed for any part of its rows, and their sequence.

A plan of hours has millions of rows; their poses are never in memory at once.
"""

from __future__ import annotations

import enum
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from hexdbb.trajectory.poses import Array, Poses


class Phase(enum.IntEnum):
    """Phase of the motion that a row of the table belongs to."""

    APPROACH = 0
    TRANSFER = 1
    FEED_IN = 2
    ARC = 3
    RETRACT = 4
    SETTLE = 5


@dataclass(frozen=True)
class SegmentRows:
    """Some rows of a segment.

    Attributes
    ----------
    position_mm, rpy_rad : (n, 3) poses
    angle_deg : (n,) commanded polar angle, 0 <= angle < 360; NaN off the circle
    lap : (n,) turns completed inside the capture, -1 outside it
    capture : (n,) bool, True where the sample is recorded
    """

    position_mm: Array
    rpy_rad: Array
    angle_deg: Array
    lap: NDArray[np.int64]
    capture: NDArray[np.bool_]


@dataclass(frozen=True)
class Segment:
    """One segment of the motion, one row per cycle.

    Attributes
    ----------
    phase : phase of the motion
    run : index of the run it belongs to, -1 for none
    rows : number of rows
    part : rows `first` to `last`, the last one left out -> their columns
    captured : number of rows that are captured
    """

    phase: Phase
    run: int
    rows: int
    part: Callable[[int, int], SegmentRows]
    captured: int = 0

    @classmethod
    def uncaptured(cls, phase: Phase, run: int, rows: int, poses: Callable[[int, int], Poses]) -> Segment:
        """Return a segment of which nothing is recorded, with the poses of rows `first` to `last`."""

        def part(first: int, last: int) -> SegmentRows:
            n = last - first
            return SegmentRows(*poses(first, last), np.full(n, np.nan), np.full(n, -1), np.zeros(n, dtype=bool))

        return cls(phase, run, rows, part)

    @classmethod
    def at_rest(cls, phase: Phase, run: int, rows: int, pose: Poses) -> Segment:
        """Return a segment that holds one pose: position (1, 3) mm, roll, pitch, yaw (1, 3) rad."""
        position_mm, rpy_rad = pose
        return cls.uncaptured(
            phase, run, rows, lambda first, last: (_held(position_mm, last - first), _held(rpy_rad, last - first))
        )

    @property
    def begin(self) -> Poses:
        """First pose: position (1, 3) mm, roll, pitch, yaw (1, 3) rad."""
        return self._pose(0)

    @property
    def end(self) -> Poses:
        """Last pose: position (1, 3) mm, roll, pitch, yaw (1, 3) rad."""
        return self._pose(self.rows - 1)

    def _pose(self, row: int) -> Poses:
        found = self.part(row, row + 1)
        return found.position_mm, found.rpy_rad


class Motion:
    """Segments in order, each beginning where the previous one ends; a `hexdbb.trajectory.targets.PoseRows`."""

    def __init__(self, segments: Sequence[Segment]) -> None:
        self._segments = segments
        self._ends = list(accumulate(segment.rows for segment in segments))

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self._ends[-1]

    def parts(self, first: int, last: int) -> Iterator[tuple[Segment, SegmentRows]]:
        """Yield the segments of rows `first` to `last` with their rows among these."""
        at = first
        while at < last:
            index = bisect_right(self._ends, at)
            segment = self._segments[index]
            begin, end = self._ends[index] - segment.rows, min(last, self._ends[index])
            yield segment, segment.part(at - begin, end - begin)
            at = end

    def poses(self, first: int, last: int) -> Poses:
        """Compute the poses of rows `first` to `last`."""
        parts = [part for _, part in self.parts(first, last)]
        return np.concatenate([part.position_mm for part in parts]), np.concatenate([part.rpy_rad for part in parts])

    def place(self, row: int) -> tuple[Phase, int, float]:
        """Return phase, run and commanded angle (deg) of a row."""
        segment, part = next(self.parts(row, row + 1))
        return segment.phase, segment.run, float(part.angle_deg[0])


def _held(values: Array, rows: int) -> Array:
    return np.tile(values, (rows, 1))
