"""What is driven in the cases: the seven standard circles, and what some mechanisms need beyond them to be seen."""

from __future__ import annotations

import itertools
from functools import cache

from hexdbb.plan import Mount, Plan, load_plan
from hexdbb_truth.simulate import Pace

PACE = Pace(rate_hz=8.0, instants_per_sample=15, travel_s=10.0)
"""14,000 samples on the discovery plan; the mains' 50 Hz is no multiple of the rate."""

OFF_RADIUS_MM = 0.6
TILT_DEG = 8.0
SECOND_MOUNT = Mount(id=1, cup_mm=(8.0, -6.0, 325.0))


@cache
def discovery_plan() -> Plan:
    """Seven circles about one cup, both directions, two feeds, two laps."""
    return load_plan("standard")


@cache
def off_radius_plan() -> Plan:
    """Two circles more, off the bar's length: the gauge's scale shows where its reading is far from zero."""
    plan = discovery_plan()
    level, next_id = plan.circles[0], len(plan.circles)
    more = [
        level.model_copy(update={"id": next_id + k, "radius_mm": level.radius_mm + off_mm})
        for k, off_mm in enumerate((OFF_RADIUS_MM, -OFF_RADIUS_MM))
    ]
    return plan.model_copy(update={"circles": (*plan.circles, *more)})


@cache
def tilted_plan() -> Plan:
    """Circles in tilted planes, before the others and after them once more.

    Horizontal circles hardly see the platform rise, as warm legs make it, and what is the same at all times is as good
    as geometry.
    """
    plan = discovery_plan()
    level, tilts = plan.circles[0], [(TILT_DEG, 0.0, 0.0), (0.0, TILT_DEG, 0.0)]
    ids = itertools.count(len(plan.circles))
    before, after = (
        [level.model_copy(update={"id": next(ids), "plane_rpy_deg": tilt}) for tilt in tilts] for _ in range(2)
    )
    return plan.model_copy(update={"circles": (*before, *plan.circles, *after)})


@cache
def two_mounts_plan() -> Plan:
    """The circles twice, the second time about a cup that is fixed anew: between the two, the ball is set anew as well.

    One lap each, so that it takes no longer than the others.
    """
    plan = discovery_plan()
    again = [
        circle.model_copy(update={"id": len(plan.circles) + circle.id, "mount": SECOND_MOUNT.id})
        for circle in plan.circles
    ]
    return plan.model_copy(
        update={"mounts": (*plan.mounts, SECOND_MOUNT), "circles": (*plan.circles, *again), "laps": 1}
    )
