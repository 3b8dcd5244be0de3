"""Programme of a plan: for every run feed-in, overshoot, captured laps, overshoot, retract, then a transfer.

Model: every run begins and ends `FEED_IN_MM` outside its circle, where the bar is mounted. Between two runs of one
mount, radius and ball offset the ball keeps that distance from the cup, so that the bar may stay mounted; otherwise the
platform takes the straight path and the bar must be removed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.plan import CircleRun, Plan
from hexdbb.trajectory.extent import FEED_IN_MM, ROWS_MAX, SETTLE_S, Extent, require_extent, too_long
from hexdbb.trajectory.limits import LIMIT_FRACTIONS, PROBE_DEG, fastest_within_limits, path_limits
from hexdbb.trajectory.poses import PosePath, circle_poses, constant_bar_path, radial_path, straight_path
from hexdbb.trajectory.programme import Programme, Tabulator, describe
from hexdbb.trajectory.segments import Phase, Segment, SegmentRows
from hexdbb.trajectory.targets import NominalTargets, Targets
from hexdbb.trajectory.time_law import feed_law, rest_to_rest

Rows = NDArray[np.int64]
SAME_POSE_MM = 1e-9
"""Limits the path length below which two poses count as one: a picometre, above the rounding of 100 mm (1e-14 mm)."""


def plan_programme(
    plan: Plan, machine: MachineFile, cycle_s: float, plan_name: str, targets: Targets | None = None
) -> Programme:
    """Compute and check the targets of a plan.

    Parameters
    ----------
    plan : Plan
    machine : MachineFile
        The machine that the plan names.
    cycle_s : float
        Time between two SYNC frames, s.
    plan_name : str
        Name of the plan in errors.
    targets : Targets, optional
        Computes slider targets of poses; default: those of the nominal machine.

    Returns
    -------
    Programme
        Begins and ends at rest with the ball `FEED_IN_MM` outside a circle.

    Raises
    ------
    InputError
        The plan takes more than `ROWS_MAX` rows, is out of reach or too fast: names plan, circle, angle and the limit.
    """
    runs = tuple(plan.runs())
    require_extent(runs, plan.overshoot_deg, machine.can_setup.limits, cycle_s, plan_name)
    targets = NominalTargets(machine) if targets is None else targets
    tabulator = Tabulator(runs, machine, cycle_s, plan_name, targets)

    def programme_at(limit_fraction: float) -> Programme:
        segments = _SegmentBuilder(runs, plan.overshoot_deg, machine, cycle_s, plan_name, limit_fraction).all()
        rows, first_travel = tabulator.tabulate(segments)
        counted = _counted(segments, len(runs))
        return Programme(runs, rows, *counted, cycle_s, segments[0].begin, first_travel, targets, limit_fraction)

    return fastest_within_limits(LIMIT_FRACTIONS, programme_at)


def _counted(segments: Sequence[Segment], runs: int) -> tuple[Rows, Rows, Rows]:
    """Return of each run the rows captured, its first row and that of its feed-in."""
    captured, begins, feeds_in = (np.zeros(runs, np.int64) for _ in range(3))
    at, known = 0, -1
    for segment in segments:
        if segment.run != known:
            known, begins[segment.run] = segment.run, at
        if segment.phase is Phase.FEED_IN:
            feeds_in[segment.run] = at
        captured[segment.run] += segment.captured
        at += segment.rows
    return captured, begins, feeds_in


class _SegmentBuilder:
    """Builds the segments of runs from the settings that all of them share."""

    def __init__(
        self,
        runs: Sequence[CircleRun],
        overshoot_deg: float,
        machine: MachineFile,
        cycle_s: float,
        plan_name: str,
        limit_fraction: float,
    ) -> None:
        self.runs, self.overshoot_deg, self.machine = runs, overshoot_deg, machine
        self.cycle_s, self.plan_name, self.limit_fraction = cycle_s, plan_name, limit_fraction

    def all(self) -> list[Segment]:
        """Return the segments of every run and of the transfers between runs."""
        segments: list[Segment] = []
        for index in range(len(self.runs)):
            own = list(self.run(index))
            if segments:
                segments += self.transfer(index, segments[-1], own[0])
            segments += own
            rows = sum(each.rows for each in segments)
            if rows > ROWS_MAX:
                raise InputError(f"{self.plan_name}: {too_long(Extent(rows * self.cycle_s, self.cycle_s))}")
        return segments

    def run(self, index: int) -> Iterator[Segment]:
        """Yield feed-in, arc and retract of one run, each followed by a rest."""
        arc = self.arc(index)
        radius_mm = self.runs[index].circle.radius_mm
        outside_mm = radius_mm + FEED_IN_MM
        first_rad, last_rad = (math.radians(float(arc.part(row, row + 1).angle_deg[0])) for row in (0, arc.rows - 1))
        feed_in = self.move(index, Phase.FEED_IN, radial_path(self.runs[index], first_rad, outside_mm, radius_mm))
        retract = self.move(index, Phase.RETRACT, radial_path(self.runs[index], last_rad, radius_mm, outside_mm))
        for segment in (feed_in, arc, retract):
            yield from (segment, self.settle(segment))

    def arc(self, index: int) -> Segment:
        """Return the circle at its feed, from rest to rest."""
        run = self.runs[index]
        radius_mm = run.circle.radius_mm
        turn_mm = 2.0 * math.pi * radius_mm
        one_turn = PosePath(turn_mm, lambda u_mm: circle_poses(run, u_mm / radius_mm, np.full_like(u_mm, radius_mm)))
        limits = path_limits(
            one_turn,
            self.machine,
            self.limit_fraction,
            lambda row: describe(self.plan_name, self.runs, Phase.ARC, index, row * PROBE_DEG),
        )
        limits = replace(limits, velocity_mm_s=run.feed_mm_min / 60.0)
        overshoot_mm = radius_mm * math.radians(self.overshoot_deg)
        where = describe(self.plan_name, self.runs, Phase.ARC, index, math.nan)
        law = feed_law(overshoot_mm, run.laps * turn_mm, limits, self.cycle_s, where)

        def part(first: int, last: int) -> SegmentRows:
            u_mm = law.u_mm(first, last)
            capture = law.capture(first, u_mm)
            angle_rad = run.direction * u_mm / radius_mm
            poses = circle_poses(run, angle_rad, np.full_like(angle_rad, radius_mm))
            lap = np.where(capture, np.floor((u_mm + SAME_POSE_MM) / turn_mm).astype(np.int64), -1)
            # Twice, because the remainder of a tiny negative angle rounds to 360.
            return SegmentRows(*poses, np.degrees(angle_rad) % 360.0 % 360.0, lap, capture)

        return Segment(Phase.ARC, index, law.rows, part, law.captured)

    def transfer(self, index: int, before: Segment, after: Segment) -> list[Segment]:
        """Return the transfer to the beginning of a run, with its rest; none where the previous run ends there."""
        previous, run = self.runs[index - 1], self.runs[index]
        bar_stays = previous.mount == run.mount and (
            (previous.circle.radius_mm, previous.circle.ball_offset_mm)
            == (run.circle.radius_mm, run.circle.ball_offset_mm)
        )
        path = constant_bar_path(run, before.end, after.begin) if bar_stays else straight_path(before.end, after.begin)
        if path.length_mm < SAME_POSE_MM:
            return []
        segment = self.move(index, Phase.TRANSFER, path)
        return [segment, self.settle(segment)]

    def move(self, index: int, phase: Phase, path: PosePath) -> Segment:
        """Return a segment along a path from rest to rest, as fast as the fraction of the sliders' limits allows."""
        where = describe(self.plan_name, self.runs, phase, index, math.nan)
        limits = path_limits(path, self.machine, self.limit_fraction, lambda _: where)
        law = rest_to_rest(path.length_mm, limits, self.cycle_s, where)
        return Segment.uncaptured(phase, index, law.rows, lambda first, last: path.poses(law.u_mm(first, last)))

    def settle(self, after: Segment) -> Segment:
        """Return a rest at the end of a segment."""
        return Segment.at_rest(Phase.SETTLE, after.run, max(1, round(SETTLE_S / self.cycle_s)), after.end)
