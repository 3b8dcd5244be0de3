"""A plan's runs as a programme: feed in, overshoot, capture laps, overshoot, retract; then the next circle.

Model: every run begins and ends `FEED_IN_MM` outside its circle, where the bar is mounted. Between two runs of one
mount, radius and ball offset the ball stays at that distance from the cup, so that the bar may stay; otherwise the
platform takes the straight way and the bar must be off.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from hexdbb.machine import MachineFile
from hexdbb.plan import CircleRun, Plan
from hexdbb.trajectory.limits import PROBE_DEG, TRAVEL_SHARES, path_limits, slow_enough
from hexdbb.trajectory.poses import PosePath, along_the_bar, circle_poses, radial, straight
from hexdbb.trajectory.programme import Phase, Programme, Stretch, Tabulator, describe
from hexdbb.trajectory.targets import NominalTargets, Targets
from hexdbb.trajectory.time_law import feed_law, rest_to_rest

FEED_IN_MM = 0.5
"""Radial way from where the bar is mounted to the circle: half the range of a usual gauge of ±1 mm."""
SETTLE_S = 0.4
"""Rest after every stop, for the position loops to catch up."""
SAME_POSE_MM = 1e-9
"""Ways shorter than this are no motion."""


def plan_programme(
    plan: Plan, machine: MachineFile, cycle_s: float, origin: str, targets: Targets | None = None
) -> Programme:
    """Compute the whole target table of a plan.

    Parameters
    ----------
    plan : the plan
    machine : the machine the plan names
    cycle_s : time between two SYNC frames
    origin : names the plan in errors
    targets : what gives the sliders' targets; the nominal machine's where None

    Returns
    -------
    Programme
        Begins and ends at rest with the ball `FEED_IN_MM` outside a circle.

    Raises
    ------
    InputError
        The plan is out of reach or too fast: names origin, circle, angle and the limit.
    """
    runs = tuple(plan.runs())
    targets = NominalTargets(machine) if targets is None else targets
    tabulator = Tabulator(runs, machine, cycle_s, origin, targets)

    def made(share: float) -> Programme:
        stretches = _Maker(runs, plan.overshoot_deg, machine, cycle_s, origin, share).all()
        table, rows = tabulator.tabulate(stretches)
        return Programme(runs, table, cycle_s, stretches[0].begin, rows.first_side, targets, share)

    return slow_enough(TRAVEL_SHARES, made)


class _Maker:
    """Makes the stretches of runs; holds what all of them need."""

    def __init__(
        self,
        runs: Sequence[CircleRun],
        overshoot_deg: float,
        machine: MachineFile,
        cycle_s: float,
        origin: str,
        share: float,
    ) -> None:
        self.runs, self.overshoot_deg, self.machine = runs, overshoot_deg, machine
        self.cycle_s, self.origin, self.share = cycle_s, origin, share

    def all(self) -> list[Stretch]:
        """Every run and the ways between them."""
        stretches: list[Stretch] = []
        for index in range(len(self.runs)):
            own = list(self.run(index))
            if stretches:
                stretches += self.transfer(index, stretches[-1], own[0])
            stretches += own
        return stretches

    def run(self, index: int) -> Iterator[Stretch]:
        """Feed in, arc with its capture, retract."""
        arc = self.arc(index)
        radius_mm = self.runs[index].circle.radius_mm
        outside_mm = radius_mm + FEED_IN_MM
        first_rad, last_rad = np.radians(arc.angle_deg[[0, -1]])
        feed_in = self.move(index, Phase.FEED_IN, radial(self.runs[index], float(first_rad), outside_mm, radius_mm))
        retract = self.move(index, Phase.RETRACT, radial(self.runs[index], float(last_rad), radius_mm, outside_mm))
        for stretch in (feed_in, arc, retract):
            yield from (stretch, self.settle(stretch))

    def arc(self, index: int) -> Stretch:
        """The circle at its feed, from rest to rest."""
        run = self.runs[index]
        radius_mm = run.circle.radius_mm
        turn_mm = 2.0 * math.pi * radius_mm
        one_turn = PosePath(turn_mm, lambda u_mm: circle_poses(run, u_mm / radius_mm, np.full_like(u_mm, radius_mm)))
        limits = path_limits(
            one_turn,
            self.machine,
            self.share,
            lambda row: describe(self.origin, self.runs, Phase.ARC, index, row * PROBE_DEG),
        )
        limits = replace(limits, velocity_mm_s=run.feed_mm_min / 60.0)
        overshoot_mm = radius_mm * math.radians(self.overshoot_deg)
        law = feed_law(overshoot_mm, run.laps * turn_mm, limits, self.cycle_s)
        angle_rad = run.direction * law.u_mm / radius_mm
        poses = circle_poses(run, angle_rad, np.full_like(angle_rad, radius_mm))
        lap = np.where(law.capture, np.floor((law.u_mm + SAME_POSE_MM) / turn_mm).astype(np.int64), -1)
        # Twice, because the remainder of a tiny negative angle rounds to 360 itself.
        angle_deg = np.degrees(angle_rad) % 360.0 % 360.0
        return Stretch(Phase.ARC, index, *poses, angle_deg, lap, law.capture)

    def transfer(self, index: int, before: Stretch, after: Stretch) -> list[Stretch]:
        """From the end of one run to the beginning of the next; nothing where they are one place."""
        previous, run = self.runs[index - 1], self.runs[index]
        bar_stays = previous.mount == run.mount and (
            (previous.circle.radius_mm, previous.circle.ball_offset_mm)
            == (run.circle.radius_mm, run.circle.ball_offset_mm)
        )
        path = along_the_bar(run, before.end, after.begin) if bar_stays else straight(before.end, after.begin)
        if path.length_mm < SAME_POSE_MM:
            return []
        stretch = self.move(index, Phase.TRANSFER, path)
        return [stretch, self.settle(stretch)]

    def move(self, index: int, phase: Phase, path: PosePath) -> Stretch:
        """A path from rest to rest, as fast as the sliders' limits allow."""
        limits = path_limits(
            path, self.machine, self.share, lambda _: describe(self.origin, self.runs, phase, index, math.nan)
        )
        u_mm = rest_to_rest(path.length_mm, limits, self.cycle_s)
        return Stretch.uncaptured(phase, index, path.poses(u_mm))

    def settle(self, after: Stretch) -> Stretch:
        """Stand still where a stretch ended."""
        n = max(1, round(SETTLE_S / self.cycle_s))
        position_mm, rpy_rad = after.end
        return Stretch.uncaptured(Phase.SETTLE, after.run, (np.tile(position_mm, (n, 1)), np.tile(rpy_rad, (n, 1))))
