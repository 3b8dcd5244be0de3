"""What is driven in cases with forms, about 10,000 readings each; the plans of `hexdbb_truth.plans` among them."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

from hexdbb.plan import Mount, Plan
from hexdbb_truth import plans
from hexdbb_truth.forms.history import History
from hexdbb_truth.simulate import Pace

RANGE_UM = 3000.0
"""Range of the gauge: the largest faults move the platform further than the one millimetre of a usual one."""


def _wide(plan: Plan) -> Plan:
    gauge = plan.gauge.model_copy(update={"range_um": RANGE_UM})
    return plan.model_copy(update={"gauge": gauge})


def _standard() -> tuple[Plan, Pace]:
    """Seven circles about one cup, two feeds, both ways, two laps."""
    return _wide(plans.discovery_plan()), Pace(5.72, 16, 10.0)


def _off_radius() -> tuple[Plan, Pace]:
    """Two more circles off the bar's length."""
    return _wide(plans.off_radius_plan()), Pace(4.43, 20, 10.0)


def _tilted() -> tuple[Plan, Pace]:
    """Circles in tilted planes before and after."""
    return _wide(plans.tilted_plan()), Pace(3.63, 25, 10.0)


def _two_mounts() -> tuple[Plan, Pace]:
    """The seven circles about two cups, one lap."""
    return _wide(plans.two_mounts_plan()), Pace(5.72, 16, 10.0)


def _varied() -> tuple[Plan, Pace]:
    """Three cups, three radii, tilted platforms and planes, no two circles alike."""
    level = plans.discovery_plan().circles[0]
    mounts = (
        plans.discovery_plan().mounts[0],
        Mount(id=1, cup_mm=(12.0, -9.0, 325.0)),
        Mount(id=2, cup_mm=(-10.0, 14.0, 342.0)),
    )
    rows = [
        (0, 0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        (0, 0.4, (0.0, 0.0, 0.0), (10.0, -4.0, 6.0)),
        (0, -0.4, (6.0, 0.0, 0.0), (-6.0, 4.0, -9.0)),
        (1, 0.2, (0.0, -7.0, 0.0), (0.0, 11.0, 3.0)),
        (1, -0.3, (0.0, 0.0, 0.0), (-11.0, 0.0, 12.0)),
        (1, 0.6, (-5.0, 5.0, 0.0), (5.0, -9.0, -4.0)),
        (2, -0.6, (0.0, 0.0, 0.0), (7.0, 7.0, -13.0)),
        (2, 0.1, (0.0, 3.0, 0.0), (-4.0, -2.0, 8.0)),
        (2, 0.0, (-7.0, 0.0, 0.0), (0.0, 5.0, 14.0)),
    ]
    circles = tuple(
        level.model_copy(
            update={
                "id": number,
                "mount": mount,
                "radius_mm": level.radius_mm + off_mm,
                "plane_rpy_deg": plane,
                "platform_rpy_deg": platform,
            }
        )
        for number, (mount, off_mm, plane, platform) in enumerate(rows)
    )
    changed = {"mounts": mounts, "circles": circles, "feeds_mm_min": (900.0, 2600.0), "laps": 2}
    return _wide(plans.discovery_plan().model_copy(update=changed)), Pace(5.0, 18, 8.0)


def _brisk() -> tuple[Plan, Pace]:
    """Ten readings a degree's time: 20 Hz at two brisk feeds, one lap."""
    plan = plans.tilted_plan()
    circles = tuple(circle for circle in plan.circles if circle.id in (0, 1, 3, 5, 6, 7, 8))
    return _wide(plan.model_copy(update={"circles": circles, "feeds_mm_min": (1500.0, 4000.0), "laps": 1})), Pace(
        20.0, 5, 6.0
    )


PLANS: dict[str, Callable[[], tuple[Plan, Pace]]] = {
    "standard": _standard,
    "off_radius": _off_radius,
    "tilted": _tilted,
    "two_mounts": _two_mounts,
    "varied": _varied,
    "brisk": _brisk,
}


@lru_cache(maxsize=len(PLANS))
def history(name: str) -> History:
    """Return the instants of a plan, by its name."""
    return History(*PLANS[name]())
