"""Plans: gauge, mounts, circles, and the order in which the circles are driven."""

from hexdbb.plan.ball_places import ball_places_sentences, places_of
from hexdbb.plan.circle import Circle, Direction
from hexdbb.plan.conditions import Conditions
from hexdbb.plan.file import CircleRun, Circles, Mounts, Plan, check_ids, load_plan, shipped_plans
from hexdbb.plan.gauge import LEAST_NOISE_MM, Gauge
from hexdbb.plan.mount import FixingName, Mount
from hexdbb.plan.saved import save_plan

__all__ = [
    "LEAST_NOISE_MM",
    "Circle",
    "CircleRun",
    "Circles",
    "Conditions",
    "Direction",
    "FixingName",
    "Gauge",
    "Mount",
    "Mounts",
    "Plan",
    "ball_places_sentences",
    "check_ids",
    "load_plan",
    "places_of",
    "save_plan",
    "shipped_plans",
]
