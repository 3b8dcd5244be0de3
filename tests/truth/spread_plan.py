"""Circles spread over the space that is to be compensated: what is driven to learn effects that nobody knows.

A catalogue's formula holds where nobody measured, a learned function only where readings were, and geometry that few
circles determine takes for its own what a function should explain. Hence many circles once, not few circles twice:
about several cups, in tilted planes, with the platform tilted, a little beyond the space of the held-out circles
(`tests.truth.held_out`), of which none is among them.

python -m tests.truth.spread_plan -o docs/plans/spread-24.toml
"""

from __future__ import annotations

import argparse
from functools import cache
from pathlib import Path

import numpy as np
from tests.truth.held_out import with_clearances

from hexdbb.plan import Circle, Mount, Plan, load_plan, save_plan
from hexdbb_truth.forms.plans import RANGE_UM
from hexdbb_truth.simulate import Pace

CUPS_MM = ((-18.0, -12.0, 305.0), (18.0, -8.0, 350.0), (0.0, 20.0, 325.0), (-6.0, 8.0, 340.0))
CIRCLES_PER_CUP = 6
OFF_MM = (0.0, 0.4, -0.4)
"""Radii less the bar's length, in turn: a scale error of the gauge shows only off it."""
FEEDS_MM_MIN = (900.0, 2600.0)
"""Below and above the feed of the held-out circles."""
PLANE_DEG, PLATFORM_DEG, YAW_DEG = 22.0, 17.0, 20.0
SEED = (2026, 16)
PACE = Pace(rate_hz=4.0, instants_per_sample=22, travel_s=8.0)
"""About 10,000 readings in all, as many as the cases of the calibration have."""


@cache
def spread_plan() -> Plan:
    """Return the plan: four cups, six circles about each, one lap each way at two feeds."""
    known, draw = load_plan("standard"), np.random.default_rng(SEED)
    mounts = tuple(Mount(id=number, cup_mm=cup) for number, cup in enumerate(CUPS_MM))

    def drawn(number: int) -> tuple[Mount, Circle]:
        return mounts[number // CIRCLES_PER_CUP], _circle(draw, number, known.gauge.bar_length_mm)

    kept = with_clearances(known.machine_file(), drawn, CIRCLES_PER_CUP * len(mounts))
    changed = {
        "mounts": mounts,
        "circles": tuple(circle for _, circle in kept),
        "feeds_mm_min": FEEDS_MM_MIN,
        "laps": 1,
        "gauge": known.gauge.model_copy(update={"range_um": RANGE_UM}),
    }
    return known.model_copy(update=changed)


def _circle(draw: np.random.Generator, number: int, bar_mm: float) -> Circle:
    plane, tilt = (
        [round(float(each), 1) for each in draw.uniform(-most, most, 2)] for most in (PLANE_DEG, PLATFORM_DEG)
    )
    return Circle(
        id=number,
        mount=number // CIRCLES_PER_CUP,
        radius_mm=bar_mm + OFF_MM[number % len(OFF_MM)],
        ball_offset_mm=(0.0, 0.0, 60.0),
        plane_rpy_deg=(plane[0], plane[1], 0.0),
        platform_rpy_deg=(tilt[0], tilt[1], round(float(draw.uniform(-YAW_DEG, YAW_DEG)), 1)),
    )


def main() -> None:
    """Write the plan."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("-o", "--output", type=Path, required=True)
    comment = "24 circles spread over the space to be compensated, to learn effects; drawn by tests.truth.spread_plan."
    save_plan(spread_plan(), parser.parse_args().output, comment)


if __name__ == "__main__":
    main()
