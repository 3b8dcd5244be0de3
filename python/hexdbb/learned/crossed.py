"""Every state at every place, and products of any two of them: looked at last, where nothing else explains enough.

`variables.py` and `further.py` list what machines are known to do. A machine may do something else: with the ones here,
a cause which is a function of one state, or of one state times another, is found at its place whatever the two are.
There are several times as many of them as of all others, and most differ little from one of those: hence they come
last, each with the prior of one among them all.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from hexdbb.learned import variables as v
from hexdbb.learned.combined import FACTORS, each_way, neighbour, of_drives, product, slipping
from hexdbb.learned.directed import POSITION_SPLINES, along
from hexdbb.learned.further import BY_TRAVEL, DIRECTIONS_DEG, OF_BALL, OF_WHOLE
from hexdbb.learned.places import ALL, PAIRS, SHARED, variables_of
from hexdbb.learned.variable import Variable

JOINT_TRAVEL = replace(v.JOINT_SINCE_REVERSAL, of_forms=False)
PLACED = tuple(
    Variable(
        f"platform_{axis}", "position_mm", "mm", f"position of the platform along {axis}", POSITION_SPLINES, axis=at
    )
    for at, axis in enumerate("xyz")
)
RADIUS = Variable("platform_radius", "radius_mm", "mm", "distance of the platform from the axis", POSITION_SPLINES)
OF_PATH = (v.ANGLE, v.ANGLE_DIRECTION, v.SPEED, v.FEED, v.CIRCLE_DIRECTION, v.ROLL, v.PITCH, v.YAW, *PLACED, RADIUS)
"""States of the platform and of its path."""
OF_TIME = (v.TIME, v.FINE_TIME, v.TIME_IN_SWEEP, v.IN_CIRCLE, v.SINCE_FIXING, v.WARMING)
OF_JOINT = (v.TURNING, v.JOINT_ANGLE, v.JOINT_ANGLE_DIRECTION, JOINT_TRAVEL)
STICKING = tuple(slipping(v.INCLINATION))
"""A joint that sticks bends its leg until that has inclined by a little, then slides."""
OF_SWING = (v.SWING, v.SWING_ANGLE, v.INCLINATION, v.PLATFORM_TURNING, v.PLATFORM_ANGLE)
TRAVEL_EACH_WAY, SINCE_REVERSAL_EACH_WAY = (
    each_way(replace(each, times=""), *BY_TRAVEL) for each in (v.TRAVEL, v.SINCE_REVERSAL)
)
"""What builds up after a reversal at one end of the travel only, or alike at both."""
OF_CARRIAGE = (
    *(v.POSITION, v.DIRECTION, v.DIRECTION_POSITION, v.SINCE_REVERSAL, v.TRAVEL, v.VELOCITY, v.ACCELERATION),
    *(v.FORCE, v.DRIVE_LOAD, v.CARRIAGE_LOAD, *v.LOADS_SINCE_TURN),
    *(v.JERK, v.SCREW_PHASE, TRAVEL_EACH_WAY, SINCE_REVERSAL_EACH_WAY),
)
_OTHER = (v.POSITION, v.DIRECTION, v.DIRECTION_POSITION, v.SINCE_REVERSAL, v.TRAVEL, v.ACCELERATION, v.FORCE)
OF_OTHER = tuple(neighbour(each) for each in _OTHER)
"""States of the other slider and leg on the guideway. Their distance sets both legs' angles: one state."""
OF_BAR = (v.BAR_ANGLE, v.BAR_AZIMUTH, v.BAR_ELEVATION, v.DEFLECTION, v.SINCE_TURN, v.TURNED)
DRAGGED = tuple(along("velocity", each) for each in DIRECTIONS_DEG)
"""What is loose, or dragged, along one axis only."""
OF_MOUNTED = (*OF_BAR, *OF_PATH, *OF_TIME, v.SWEEP, *DRAGGED)
"""States of what is mounted for the measurement: ball, cup, bar and gauge."""
OF_ELEMENT = (*OF_CARRIAGE, *OF_JOINT, *OF_SWING, *OF_PATH, *OF_BAR, *OF_TIME, *OF_OTHER, v.NEIGHBOUR_VELOCITY)
RINGING = (v.SINCE_REVERSAL, SINCE_REVERSAL_EACH_WAY)
"""A drive that rings where it reverses couples into the gauge's cable."""
DRAGGED_ALONG = (*RINGING, v.TRAVEL, TRAVEL_EACH_WAY)
"""What stands on the base, or hangs on the platform, follows a drive's friction some way after it reverses."""
OF_EACH_DRIVE = (v.POSITION, v.DIRECTION, v.VELOCITY, v.ACCELERATION, v.FORCE)

_MOVING = (v.POSITION, v.VELOCITY, v.ACCELERATION, v.FORCE, v.DRIVE_LOAD, v.CARRIAGE_LOAD, v.JOINT_ANGLE, v.TURNING)
MULTIPLIED = (*_MOVING, v.SWING_ANGLE, v.TIME_IN_SWEEP, v.SPEED, v.ANGLE, v.SCREW_PHASE)
"""Variables of which functions are multiplied, at an element; what grows with time or warmth is in the lists."""
FACTORS_OF_ELEMENT = (
    *("velocity", "acceleration", "leg_force", "drive_load", "direction", "joint_direction", "joint_rate"),
    *("joint_angle", "speed", "circle_direction"),
    *("neighbour_velocity", "neighbour_direction", "neighbour_acceleration"),
)
MULTIPLIED_OF_BAR = (*OF_BAR[:4], v.ANGLE, v.SPEED, v.TIME, v.TIME_IN_SWEEP, v.WARMING, v.ROLL, v.PITCH, v.YAW)
FACTORS_OF_BAR = ("deflection", "time", "warming", "speed", "circle_direction", "deflection_direction")


def _products(factors: Iterable[str], variables: Iterable[Variable]) -> Iterator[Variable]:
    """Yield functions of each variable times each factor, not times the variable itself."""
    for variable in variables:
        for factor in factors:
            column, _ = FACTORS[factor]
            if column != variable.column and factor != variable.name:
                yield product(factor, variable)


def _besides(place: str, every: Iterable[Variable], element: int = 1) -> tuple[Variable, ...]:
    """Return variables that an element of a place, or two that share a function, do not have yet, one of each name."""
    known = {each.name for each in variables_of(place, element)}
    return tuple({each.name: each for each in every if each.name not in known}.values())


OF_LEG = (*OF_ELEMENT, *_products(FACTORS_OF_ELEMENT, MULTIPLIED))
OF_SLIDER = tuple(each for each in OF_LEG if each.column != v.JOINT_ANGLE.column)
"""Without functions of the joint's angle: its cosine is what a slider moves its leg by, and the leg has them."""
CROSSED: dict[str, tuple[Variable, ...]] = {
    "slider": _besides("slider", (*OF_SLIDER, v.SWEEP)),
    "leg": _besides("leg", (*OF_LEG, *STICKING)),
    **{place: _besides(place, OF_LEG) for place in ("lateral", "vertical")},
}
"""Variables by place that neither the simple nor the further ones of that place are."""
CROSSED |= {
    "slider_joint": _besides("slider_joint", OF_ELEMENT),
    "platform_joint": _besides("platform_joint", OF_ELEMENT),
    "reading": _besides(
        "reading",
        (*OF_MOUNTED, *of_drives((*OF_EACH_DRIVE, *RINGING)), *_products(FACTORS_OF_BAR, MULTIPLIED_OF_BAR)),
    ),
    **{
        place: _besides(
            place,
            (
                *(*OF_MOUNTED, *OF_BALL, *of_drives((*OF_EACH_DRIVE, *DRAGGED_ALONG))),
                *_products(("time", "speed", "circle_direction"), (v.BAR_ANGLE, v.ANGLE, v.TIME, v.SPEED)),
            ),
        )
        for place in ("ball", "cup")
    },
}


_PATH_AND_TIME = (*OF_PATH, *OF_TIME, *of_drives(OF_EACH_DRIVE))
CROSSED_PAIRS: dict[str, tuple[Variable, ...]] = {
    "slider": _besides("slider", (*OF_CARRIAGE, *OF_JOINT, *_PATH_AND_TIME), PAIRS["1-2"]),
    "leg": _besides("leg", (*OF_CARRIAGE, *OF_JOINT, *OF_SWING, *_PATH_AND_TIME), PAIRS["1-2"]),
}
"""The same of the two sliders or legs of a guideway that share a function: a guideway that moves along itself."""


def every_variable_of(place: str, element: int) -> tuple[Variable, ...]:
    """Return the variables of an element of a place: those listed for it, then those that are looked at last."""
    listed = variables_of(place, element)
    if element in PAIRS.values():
        return (*listed, *CROSSED_PAIRS.get(place, ()))
    is_single = not (element == ALL and place in (*SHARED, *OF_WHOLE))
    return (*listed, *(CROSSED.get(place, ()) if is_single else ()))
