"""Held-out circles: other heights and positions of the cup, other tilts and radii, another feed than the fitted ones.

Drawn once, the same for every machine; each keeps the clearances that `hexdbb plan propose` requires (travel, gap, bar
angle, condition of the machine), so that it could be measured. Each bar length is a record of its own.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.plan import Circle, Mount, Plan, load_plan
from hexdbb.planning.clearances import RequiredClearances, circle_clearances

BARS_MM = (60.0, 80.0, 100.0, 120.0)
CIRCLES_PER_BAR = 5
FEED_MM_MIN = 2000.0
RANGE_UM = 2000.0
"""Range of the gauge, µm: the bar is not centred on these machines; the cup is misplaced by 0.1 mm, the platform by
some tenths."""
CUP_XY_MM, CUP_Z_MM = (-25.0, 25.0), (300.0, 355.0)
PLANE_DEG, PLATFORM_DEG, YAW_DEG = 20.0, 15.0, 20.0
SEED = 2006
MAX_DRAWS = 5000
"""Limit of random circles tried per bar, against an endless loop where none keeps the clearances."""


@cache
def held_out_plans() -> tuple[Plan, ...]:
    """Return one plan per bar; every circle has a mount of its own."""
    return tuple(_plan(bar_mm) for bar_mm in BARS_MM)


def _plan(bar_mm: float) -> Plan:
    known = load_plan("standard")
    draw = np.random.default_rng([SEED, int(bar_mm)])
    kept = with_clearances(known.machine_file(), lambda number: _drawn(draw, bar_mm, number), CIRCLES_PER_BAR)
    gauge = known.gauge.model_copy(update={"bar_length_mm": bar_mm, "range_um": RANGE_UM})
    changed = {"mounts": tuple(mount for mount, _ in kept), "circles": tuple(circle for _, circle in kept)}
    return known.model_copy(update={**changed, "gauge": gauge, "feeds_mm_min": (FEED_MM_MIN,), "laps": 1})


def with_clearances(
    machine: MachineFile, drawn: Callable[[int], tuple[Mount, Circle]], count: int
) -> list[tuple[Mount, Circle]]:
    """Return the first so many circles that keep the clearances, each drawn by its number.

    Raises
    ------
    InputError
        Fewer were found in `MAX_DRAWS` draws.
    """
    kept: list[tuple[Mount, Circle]] = []
    for _ in range(MAX_DRAWS):
        mount, circle = drawn(len(kept))
        found = circle_clearances(machine, circle, mount.cup_mm)
        if found is not None and RequiredClearances().met_by(found):
            kept.append((mount, circle))
        if len(kept) == count:
            return kept
    raise InputError(f"{len(kept)} circles of radius {circle.radius_mm:g} mm found (expected {count})")


def _drawn(draw: np.random.Generator, bar_mm: float, number: int) -> tuple[Mount, Circle]:
    x, y, z = (round(float(draw.uniform(*span)), 1) for span in (CUP_XY_MM, CUP_XY_MM, CUP_Z_MM))
    plane = [round(float(each), 1) for each in draw.uniform(-PLANE_DEG, PLANE_DEG, 2)]
    tilt = [round(float(each), 1) for each in draw.uniform(-PLATFORM_DEG, PLATFORM_DEG, 2)]
    yaw = round(float(draw.uniform(-YAW_DEG, YAW_DEG)), 1)
    circle = Circle(
        id=number,
        mount=number,
        radius_mm=bar_mm,
        ball_offset_mm=(0.0, 0.0, 60.0),
        plane_rpy_deg=(plane[0], plane[1], 0.0),
        platform_rpy_deg=(tilt[0], tilt[1], yaw),
    )
    return Mount(id=number, cup_mm=(x, y, z)), circle
