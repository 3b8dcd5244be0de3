"""The cyclic target table: one row per SYNC, computed before anything moves.

Model: a programme is a sequence of stretches (approach, feed-in, arc, ...); the poses of all of them become slider
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
from hexdbb.trajectory.limits import TooFastError, check_motion
from hexdbb.trajectory.poses import Array, Poses
from hexdbb.trajectory.targets import TargetRows, Targets


class Phase(enum.IntEnum):
    """What a row of the table belongs to."""

    APPROACH = 0
    TRANSFER = 1
    FEED_IN = 2
    ARC = 3
    RETRACT = 4
    SETTLE = 5


@dataclass(frozen=True)
class Stretch:
    """Poses of one piece of motion, one per cycle.

    Attributes
    ----------
    phase : what the piece is
    run : index of the run it belongs to, -1 for none
    position_mm, rpy_rad : (n, 3) poses
    angle_deg : (n,) commanded polar angle, 0 <= angle < 360; NaN where the ball is on no circle
    lap : (n,) turns completed inside the capture, -1 outside it
    capture : (n,) bool, rows whose samples go into the record
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
    ) -> Stretch:
        """Give a piece of which nothing is recorded."""
        n = len(poses[0])
        angles = np.broadcast_to(np.asarray(angle_deg, dtype=float), (n,))
        return cls(phase, run, *poses, angles, np.full(n, -1), np.zeros(n, dtype=bool))

    @property
    def begin(self) -> tuple[Array, Array]:
        """First pose, (1, 3) and (1, 3)."""
        return self.position_mm[:1], self.rpy_rad[:1]

    @property
    def end(self) -> tuple[Array, Array]:
        """Last pose, (1, 3) and (1, 3)."""
        return self.position_mm[-1:], self.rpy_rad[-1:]


@dataclass(frozen=True)
class Table:
    """The columns of a programme, one row per cycle.

    Attributes
    ----------
    sliders_mm : (n, 6) targets
    phase : (n,) `Phase`
    run : (n,) index into the programme's runs, -1 for none
    angle_deg : (n,) commanded polar angle, NaN where the ball is on no circle
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
        """Give this table followed by another."""
        return Table(*(np.concatenate([getattr(self, f.name), getattr(other, f.name)]) for f in fields(Table)))


@dataclass(frozen=True)
class Programme:
    """Runs in order and the table of targets that makes them.

    Attributes
    ----------
    runs : what the table's run indices mean
    table : begins and ends at rest
    cycle_s : time between two rows
    first_pose : pose of the first row
    first_side : (6,) side from which each slider is taken to come at the first row
    targets : what the table was computed with
    share : share of the sliders' limits that the ways use
    """

    runs: tuple[CircleRun, ...]
    table: Table
    cycle_s: float
    first_pose: Poses
    first_side: Array
    targets: Targets
    share: float

    @property
    def duration_s(self) -> float:
        """Time from the first to the last row."""
        return (len(self.table) - 1) * self.cycle_s

    def after(self, way: Table) -> Programme:
        """Give this programme with a way to its beginning put before it."""
        return replace(self, table=way.then(self.table))


@dataclass(frozen=True)
class Tabulator:
    """Turns stretches into checked rows.

    Attributes
    ----------
    runs : what the stretches' run indices mean
    machine : its motion limits
    cycle_s : time between two rows
    origin : names the plan in errors
    targets : what gives the sliders' targets
    """

    runs: Sequence[CircleRun]
    machine: MachineFile
    cycle_s: float
    origin: str
    targets: Targets

    def tabulate(
        self, stretches: Sequence[Stretch], before: Array | None = None, after: Array | None = None
    ) -> tuple[Table, TargetRows]:
        """Compute the targets of all stretches in one call, and check every row.

        Parameters
        ----------
        stretches : pieces of motion in order, each beginning where the one before ended
        before, after : (6,) sides as in `Targets.sliders`

        Raises
        ------
        InputError
            A pose cannot be reached or a slider would be too fast: names origin, circle, angle and the limit.
        TooFastError
            A slider would be too fast on a way between captures.
        """
        position_mm = np.concatenate([s.position_mm for s in stretches])
        rpy_rad = np.concatenate([s.rpy_rad for s in stretches])
        lengths = [len(s.position_mm) for s in stretches]
        phase = np.repeat([int(s.phase) for s in stretches], lengths)
        run = np.repeat([s.run for s in stretches], lengths)
        angle_deg = np.concatenate([s.angle_deg for s in stretches])

        def where(row: int) -> str:
            return describe(self.origin, self.runs, Phase(int(phase[row])), int(run[row]), float(angle_deg[row]))

        rows = self.targets.sliders(position_mm, rpy_rad, self.cycle_s, before, after)
        if rows.refused is not None:
            row, why = rows.refused
            raise InputError(f"{where(row)}: {why}")
        lap = np.concatenate([s.lap for s in stretches])
        capture = np.concatenate([s.capture for s in stretches])
        try:
            check_motion(rows.sliders_mm, self.cycle_s, self.machine.can_setup.limits, where)
        except TooFastError as error:
            if not capture[error.row]:
                raise
            raise InputError(str(error)) from None  # at its feed: slower ways would not help
        return Table(rows.sliders_mm, phase, run, angle_deg, lap, capture), rows


def describe(origin: str, runs: Sequence[CircleRun], phase: Phase, run: int, angle_deg: float) -> str:
    """Name a place in a programme for an error message."""
    name = phase.name.lower().replace("_", " ")
    if run < 0:
        return f"{origin}: {name}"
    circle = runs[run]
    place = (
        f"{origin}: circle {circle.circle.id}, {circle.feed_mm_min:g} mm/min, direction {circle.direction:+d}, {name}"
    )
    return place if np.isnan(angle_deg) else f"{place} at {angle_deg:.2f} deg"
