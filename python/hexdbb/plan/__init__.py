"""Plans: gauge, mounts, circles, and the order in which circles are driven."""

from hexdbb.plan.circle import LEAST_NOISE_MM, Circle, Direction, Gauge, Mount
from hexdbb.plan.file import CircleRun, Circles, Mounts, Plan, check_ids, load_plan, shipped_plans

__all__ = [
    "LEAST_NOISE_MM",
    "Circle",
    "CircleRun",
    "Circles",
    "Direction",
    "Gauge",
    "Mount",
    "Mounts",
    "Plan",
    "check_ids",
    "load_plan",
    "shipped_plans",
]
