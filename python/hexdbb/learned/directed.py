"""Variables that are a vector's part along a direction in its x-y plane: `acceleration_along@45` (degrees)."""

from __future__ import annotations

from hexdbb.learned.following import FOLLOWING_SPLINES, NUMBER_DIGITS, VELOCITY_SPLINES, is_relay
from hexdbb.learned.variable import OF_MEMORY, Variable

ALONG = "along"
POSITION_SPLINES = 12
"""Splines over the platform's position: where a foot of a table lifts off, it leans more. What eight of them left of
such a bend was taken for a leg's swing."""
GRAVITY_SPLINES = 8
"""Splines over gravity's share in the platform: as many as over its roll (`variables.ROLL`)."""
DIRECTED = {
    "acceleration": ("carriages_acceleration_mm_s2", "mm/s²", "acceleration of all carriages", FOLLOWING_SPLINES),
    "position": ("position_mm", "mm", "position of the platform", POSITION_SPLINES),
    "velocity": ("platform_velocity_mm_s", "mm/s", "velocity of the platform", VELOCITY_SPLINES),
    "gravity": ("gravity_in_platform", "", "share of gravity in the platform's frame", GRAVITY_SPLINES),
}
"""Vectors of which the part along a direction counts: column, unit, words, splines."""
SIGNED = ("velocity",)
"""Those whose part along a direction has a step where it changes sign: what is loose along one axis only."""
HALF_TURN_DEG = 180.0
"""A direction and its opposite are the same: the spline takes either sign."""


def is_directed(variable: Variable) -> bool:
    """Whether a variable is a vector's part along a direction that the readings chose."""
    return f"{OF_MEMORY}{ALONG}@" in variable.column and not is_relay(variable)


def along(vector: str, direction_deg: float) -> Variable:
    """Return the variable of a vector's part along a direction in its x-y plane; `DIRECTED` names the vector."""
    column, unit, words, count = DIRECTED[vector]
    number = f"{direction_deg % HALF_TURN_DEG or HALF_TURN_DEG:.{NUMBER_DIGITS}g}"
    return Variable(
        f"{vector}_{ALONG}@{number}",
        f"{column}{OF_MEMORY}{ALONG}@{number}",
        unit,
        f"{words} along {float(number):.3g}° in the x-y plane",
        count,
        signed=vector in SIGNED,
    )
