"""The cyclic targets of a plan: one row per SYNC, computed and checked before anything moves.

Model: a programme is a sequence of segments (approach, feed-in, arc, ...); their poses become slider targets block by
block (`Targets`: inverse kinematics, nominal or compensated), and every row is checked for reach, velocity,
acceleration and jerk of each slider before it is kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.plan import CircleRun
from hexdbb.trajectory.extent import Extent
from hexdbb.trajectory.limits import TooFastError, check_motion
from hexdbb.trajectory.poses import Array, Poses
from hexdbb.trajectory.segments import Motion, Phase, Segment
from hexdbb.trajectory.table import BLOCK_ROWS, Table, TableFile
from hexdbb.trajectory.targets import Targets

OVERLAP = 3
"""Rows before a block that the differences of its first row need: those of jerk."""


@dataclass(frozen=True)
class Programme:
    """Runs in order and the targets that drive them.

    Attributes
    ----------
    runs : the runs that `Table.run` indexes
    rows : targets of the runs; begin and end at rest
    captured : (runs,) rows captured of each run
    begins, feeds_in : (runs,) first row of each run, and of its feed-in, in `rows`
    cycle_s : time between two rows, s
    first_pose : pose of the first row
    first_travel : (6,) assumed direction of travel of each slider at the first row, -1 to 1
    targets : computes the targets of further poses
    limit_fraction : fraction of the sliders' limits used between captures
    way : targets before the runs, from the present position; None where it is not known
    """

    runs: tuple[CircleRun, ...]
    rows: TableFile
    captured: NDArray[np.int64]
    begins: NDArray[np.int64]
    feeds_in: NDArray[np.int64]
    cycle_s: float
    first_pose: Poses
    first_travel: Array
    targets: Targets
    limit_fraction: float
    way: Table | None = None

    def __len__(self) -> int:
        return self.before + len(self.rows)

    @property
    def before(self) -> int:
        """Number of rows before the runs."""
        return 0 if self.way is None else len(self.way)

    @property
    def table(self) -> Table:
        """All rows in memory; for plans of minutes, not of hours."""
        return self.part(0, len(self))

    def part(self, first: int, last: int) -> Table:
        """Return rows `first` to `last`, the last one left out."""
        before = self.before
        rows = self.rows.part(max(first - before, 0), max(last - before, 0))
        return rows if self.way is None or first >= before else self.way.part(first, last).then(rows)

    @property
    def duration_s(self) -> float:
        """Time from the first to the last row, s."""
        return (len(self) - 1) * self.cycle_s

    @property
    def extent(self) -> Extent:
        """Machine time, rows and disk space of the targets."""
        return Extent(len(self) * self.cycle_s, self.cycle_s)

    def after(self, approach: Table) -> Programme:
        """Return this programme with an approach before it."""
        return replace(self, way=approach if self.way is None else approach.then(self.way))


@dataclass(frozen=True)
class Tabulator:
    """Converts segments to checked rows of targets.

    Attributes
    ----------
    runs : the runs that `Segment.run` indexes
    machine : its motion limits hold
    cycle_s : time between two rows, s
    plan_name : name of the plan in errors
    targets : computes slider targets of poses
    """

    runs: Sequence[CircleRun]
    machine: MachineFile
    cycle_s: float
    plan_name: str
    targets: Targets

    def tabulate(
        self, segments: Sequence[Segment], before: Array | None = None, after: Array | None = None
    ) -> tuple[TableFile, Array]:
        """Compute the targets of all segments block by block and check every row.

        Parameters
        ----------
        segments : segments in order, each beginning where the previous one ends
        before, after : (6,) directions of travel as in `Targets.along`

        Returns
        -------
        TableFile
            The targets.
        ndarray, shape (6,)
            Assumed direction of travel of each slider at the first row, -1 to 1.

        Raises
        ------
        InputError
            A pose cannot be reached or a slider would be too fast: names plan, circle, angle and the limit.
        TooFastError
            A slider would be too fast between captures.
        """
        motion, kept = Motion(segments), TableFile()
        targets = self.targets.along(motion, self.cycle_s, before, after)
        last_mm = np.empty((0, 6))
        for first in range(0, motion.rows, BLOCK_ROWS):
            last = min(first + BLOCK_ROWS, motion.rows)
            sliders_mm, refused = targets.part(first, last)
            if refused is not None:
                row, why = refused
                raise InputError(f"{self._row_name(motion, row)}: {why}")
            self._check(motion, first - len(last_mm), np.concatenate([last_mm, sliders_mm]))
            last_mm = sliders_mm[-OVERLAP:] if len(sliders_mm) >= OVERLAP else sliders_mm
            kept.append(_columns(motion, first, last, sliders_mm))
        return kept, targets.first_travel

    def _check(self, motion: Motion, first: int, sliders_mm: Array) -> None:
        """Check the motion of rows from `first` on."""
        try:
            check_motion(
                sliders_mm,
                self.cycle_s,
                self.machine.can_setup.limits,
                lambda row: self._row_name(motion, first + row),
            )
        except TooFastError as error:
            row = first + error.row
            _, part = next(motion.parts(row, row + 1))
            if not part.capture[0]:
                raise
            raise InputError(str(error)) from None  # too fast at its feed: a smaller fraction would not help

    def _row_name(self, motion: Motion, row: int) -> str:
        return describe(self.plan_name, self.runs, *motion.place(row))


def _columns(motion: Motion, first: int, last: int, sliders_mm: Array) -> Table:
    """Return the columns of rows `first` to `last` with their targets."""
    parts = list(motion.parts(first, last))
    lengths = [len(rows.capture) for _, rows in parts]
    return Table(
        sliders_mm,
        np.repeat([int(segment.phase) for segment, _ in parts], lengths),
        np.repeat([segment.run for segment, _ in parts], lengths),
        np.concatenate([rows.angle_deg for _, rows in parts]),
        np.concatenate([rows.lap for _, rows in parts]),
        np.concatenate([rows.capture for _, rows in parts]),
    )


def describe(plan_name: str, runs: Sequence[CircleRun], phase: Phase, run: int, angle_deg: float) -> str:
    """Return the name of a place in a programme for an error message."""
    name = phase.name.lower().replace("_", " ")
    if run < 0:
        return f"{plan_name}: {name}"
    circle = runs[run]
    motion = f"{circle.feed_mm_min:g} mm/min, direction {circle.direction:+d}"
    place = f"{plan_name}: circle {circle.circle.id}, {motion}, {name}"
    return place if np.isnan(angle_deg) else f"{place} at {angle_deg:.2f} deg"
