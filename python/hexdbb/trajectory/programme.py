"""The cyclic target table: one row per SYNC, computed before anything moves.

Model: a programme is a sequence of segments (approach, feed-in, arc, ...); the poses of all of them become slider
targets in one call (`Targets`: inverse kinematics, nominal or compensated), and every row is checked for reach,
velocity, acceleration and jerk of each slider.
"""

from __future__ import annotations

import enum
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.plan import CircleRun
from hexdbb.trajectory.extent import Extent
from hexdbb.trajectory.limits import TooFastError, check_motion
from hexdbb.trajectory.poses import Array, Poses
from hexdbb.trajectory.targets import TargetRows, Targets


class Phase(enum.IntEnum):
    """Phase of the motion that a row of the table belongs to."""

    APPROACH = 0
    TRANSFER = 1
    FEED_IN = 2
    ARC = 3
    RETRACT = 4
    SETTLE = 5


@dataclass(frozen=True)
class Segment:
    """Poses of one segment of the motion, one per cycle.

    Attributes
    ----------
    phase : phase of the motion
    run : index of the run it belongs to, -1 for none
    position_mm, rpy_rad : (n, 3) poses
    angle_deg : (n,) commanded polar angle, 0 <= angle < 360; NaN off the circle
    lap : (n,) turns completed inside the capture, -1 outside it
    capture : (n,) bool, True where the sample is recorded
    """

    phase: Phase
    run: int
    position_mm: Array
    rpy_rad: Array
    angle_deg: Array
    lap: NDArray[np.int64]
    capture: NDArray[np.bool_]

    @classmethod
    def uncaptured(
        cls, phase: Phase, run: int, poses: tuple[Array, Array], angle_deg: float | Array = np.nan
    ) -> Segment:
        """Return a segment of which nothing is recorded."""
        n = len(poses[0])
        angles = np.broadcast_to(np.asarray(angle_deg, dtype=float), (n,))
        return cls(phase, run, *poses, angles, np.full(n, -1), np.zeros(n, dtype=bool))

    @property
    def begin(self) -> tuple[Array, Array]:
        """First pose: position (1, 3) mm, roll, pitch, yaw (1, 3) rad."""
        return self.position_mm[:1], self.rpy_rad[:1]

    @property
    def end(self) -> tuple[Array, Array]:
        """Last pose: position (1, 3) mm, roll, pitch, yaw (1, 3) rad."""
        return self.position_mm[-1:], self.rpy_rad[-1:]


@dataclass(frozen=True)
class Table:
    """The columns of a programme, one row per cycle.

    Attributes
    ----------
    sliders_mm : (n, 6) slider targets, mm
    phase : (n,) `Phase`
    run : (n,) index into the programme's runs, -1 for none
    angle_deg : (n,) commanded polar angle, 0 <= angle < 360, NaN off the circle
    lap : (n,) turns completed inside the capture, -1 outside it
    capture : (n,) bool
    """

    sliders_mm: Array
    phase: NDArray[np.int64]
    run: NDArray[np.int64]
    angle_deg: Array
    lap: NDArray[np.int64]
    capture: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.capture)

    def then(self, other: Table) -> Table:
        """Return this table followed by another."""
        return Table(*(np.concatenate([getattr(self, f.name), getattr(other, f.name)]) for f in fields(Table)))


@dataclass(frozen=True)
class Programme:
    """Runs in order and the table of targets that drives them.

    Attributes
    ----------
    runs : the runs that `table.run` indexes
    table : targets; begins and ends at rest
    cycle_s : time between two rows, s
    first_pose : pose of the first row
    first_travel : (6,) assumed direction of travel of each slider at the first row, -1 to 1
    targets : computes the targets of further poses
    limit_fraction : fraction of the sliders' limits used between captures
    """

    runs: tuple[CircleRun, ...]
    table: Table
    cycle_s: float
    first_pose: Poses
    first_travel: Array
    targets: Targets
    limit_fraction: float

    @property
    def duration_s(self) -> float:
        """Time from the first to the last row, s."""
        return (len(self.table) - 1) * self.cycle_s

    @property
    def extent(self) -> Extent:
        """Machine time, rows and memory of the table."""
        return Extent(len(self.table) * self.cycle_s, self.cycle_s)

    def after(self, approach: Table) -> Programme:
        """Return this programme with an approach before it."""
        return replace(self, table=approach.then(self.table))


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
    ) -> tuple[Table, TargetRows]:
        """Compute the targets of all segments in one call and check every row.

        Parameters
        ----------
        segments : segments in order, each beginning where the previous one ends
        before, after : (6,) directions of travel as in `Targets.sliders`

        Raises
        ------
        InputError
            A pose cannot be reached or a slider would be too fast: names plan, circle, angle and the limit.
        TooFastError
            A slider would be too fast between captures.
        """
        position_mm = np.concatenate([s.position_mm for s in segments])
        rpy_rad = np.concatenate([s.rpy_rad for s in segments])
        lengths = [len(s.position_mm) for s in segments]
        phase = np.repeat([int(s.phase) for s in segments], lengths)
        run = np.repeat([s.run for s in segments], lengths)
        angle_deg = np.concatenate([s.angle_deg for s in segments])

        def row_name(row: int) -> str:
            return describe(self.plan_name, self.runs, Phase(int(phase[row])), int(run[row]), float(angle_deg[row]))

        rows = self.targets.sliders(position_mm, rpy_rad, self.cycle_s, before, after)
        if rows.refused is not None:
            row, why = rows.refused
            raise InputError(f"{row_name(row)}: {why}")
        lap = np.concatenate([s.lap for s in segments])
        capture = np.concatenate([s.capture for s in segments])
        try:
            check_motion(rows.sliders_mm, self.cycle_s, self.machine.can_setup.limits, row_name)
        except TooFastError as error:
            if not capture[error.row]:
                raise
            raise InputError(str(error)) from None  # too fast at its feed: a smaller fraction would not help
        return Table(rows.sliders_mm, phase, run, angle_deg, lap, capture), rows


def describe(plan_name: str, runs: Sequence[CircleRun], phase: Phase, run: int, angle_deg: float) -> str:
    """Return the name of a place in a programme for an error message."""
    name = phase.name.lower().replace("_", " ")
    if run < 0:
        return f"{plan_name}: {name}"
    circle = runs[run]
    motion = f"{circle.feed_mm_min:g} mm/min, direction {circle.direction:+d}"
    place = f"{plan_name}: circle {circle.circle.id}, {motion}, {name}"
    return place if np.isnan(angle_deg) else f"{place} at {angle_deg:.2f} deg"
