"""Extent of a plan: machine time, rows and disk space, estimated from its numbers before anything is computed.

Model: all targets are in a temporary file before motion starts, because every row must be checked first. A run
takes its captured and overshot arc at the feed, two ramps to the feed, feed-in and retract, and three rests; ramps and
moves at the sliders' own acceleration and jerk. Transfers are not counted: the estimate is a little low, and the rows
are counted once more while the table is made.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from hexdbb.errors import InputError
from hexdbb.machine import Limits
from hexdbb.plan import CircleRun
from hexdbb.trajectory.table import ROW

ROWS_MAX = 4_000_000
"""Limits the rows of a table of targets: 4.4 h at 250 Hz, eight times the plan `standard` (34 min), longer than a
machine keeps its temperature; its computation takes half a minute and 264 MB of disk. Memory does not grow with it."""
FEED_IN_MM = 0.5
"""Radial distance between the point where the bar is mounted and the circle: half the range of a usual gauge (±1 mm),
so that the bar can be mounted with a margin of 0.5 mm to either side."""
SETTLE_S = 0.4
"""Rest after every stop, in which the position loops settle: eight time constants of a slow loop (gain 20 /s),
after which 0.03 % of the following error are left."""
RESTS_PER_RUN = 3
"""Feed-in, arc and retract are each followed by a rest."""
TINY = 1e-300
"""Limits divisors from below, so that the smallest number a file can hold gives infinite time, not an error."""


@dataclass(frozen=True)
class Extent:
    """Machine time and rows of targets; infinite where numbers overflow."""

    duration_s: float
    cycle_s: float

    @property
    def rows(self) -> float:
        """Rows of the table."""
        return self.duration_s / self.cycle_s

    @property
    def disk_bytes(self) -> float:
        """Size of the temporary file that holds the targets."""
        return self.rows * ROW.itemsize

    def words(self) -> str:
        """Return machine time, rows and disk space for people."""
        hours = self.duration_s >= 3600.0
        time = f"{self.duration_s / 3600.0:.3g} h" if hours else f"{self.duration_s:.0f} s"
        rows = f"{self.rows:,.0f}" if self.rows < 1e12 else f"{self.rows:.3g}"
        megabytes = self.disk_bytes / 1e6
        disk = f"{megabytes:.1f} MB" if megabytes < 1000.0 else f"{megabytes / 1000.0:.3g} GB"
        return f"{time} of machine time, {rows} rows, {disk} of targets"


def estimated_extent(runs: Sequence[CircleRun], overshoot_deg: float, limits: Limits, cycle_s: float) -> Extent:
    """Estimate the extent of runs in order.

    Parameters
    ----------
    runs : sequence of CircleRun
    overshoot_deg : float
        Angle at full feed before and after the captured laps.
    limits : Limits
        Of the sliders.
    cycle_s : float
        Time between two rows, s.
    """
    return Extent(sum(_run_s(run, overshoot_deg, limits) for run in runs), cycle_s)


def require_extent(
    runs: Sequence[CircleRun], overshoot_deg: float, limits: Limits, cycle_s: float, plan_name: str
) -> None:
    """Check that a plan's table of targets stays within `ROWS_MAX`, by the estimate.

    Raises
    ------
    InputError
        It does not; names the longest run, the estimate and the limit.
    """
    found = estimated_extent(runs, overshoot_deg, limits, cycle_s)
    if found.rows > ROWS_MAX:
        longest = max(runs, key=lambda run: _run_s(run, overshoot_deg, limits))
        laps = f"{longest.laps} lap{'s' * (longest.laps != 1)}"
        place = f"circle {longest.circle.id}, {longest.feed_mm_min:g} mm/min, {laps}"
        raise InputError(f"{plan_name}: {place}: {too_long(found)}")


def too_long(found: Extent) -> str:
    """Return what is wrong with an extent beyond the limit, and the limit."""
    largest = Extent(ROWS_MAX * found.cycle_s, found.cycle_s)
    advice = "fewer laps, faster feeds, or several plans"
    return f"the plan takes {found.words()} (expected at most {largest.words()}: {advice})"


def _run_s(run: CircleRun, overshoot_deg: float, limits: Limits) -> float:
    """Return the least time of one run, s."""
    acceleration, jerk = limits.acceleration_mm_s2, limits.jerk_mm_s3
    feed_mm_s = run.feed_mm_min / 60.0
    turns = float(run.laps) + 2.0 * overshoot_deg / 360.0
    arc_s = turns * 2.0 * math.pi * run.circle.radius_mm / max(feed_mm_s, TINY)
    ramps_s = 2.0 * _ramp_s(feed_mm_s, acceleration, jerk)
    return arc_s + ramps_s + 2.0 * _move_s(FEED_IN_MM, acceleration, jerk) + RESTS_PER_RUN * SETTLE_S


def _ramp_s(velocity: float, acceleration: float, jerk: float) -> float:
    """Return the time from rest to a velocity, its acceleration reached or not, s."""
    if velocity * jerk < acceleration * acceleration:
        return 2.0 * math.sqrt(velocity / max(jerk, TINY))
    return velocity / max(acceleration, TINY) + acceleration / max(jerk, TINY)


def _move_s(length_mm: float, acceleration: float, jerk: float) -> float:
    """Return the least time from rest to rest, s: where only the jerk, or only the acceleration, is limited."""
    by_jerk = math.cbrt(32.0 * length_mm / max(jerk, TINY))
    return max(by_jerk, 2.0 * math.sqrt(length_mm / max(acceleration, TINY)))
