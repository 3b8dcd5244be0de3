"""Further variables: what multiplies, what remembers, what neighbours do; looked at where nothing simpler settles.

There are as many of them as of the simple ones, and each contains one or the other of those: a lag that grows with the
load contains a lag. So they are no candidates while a simpler function explains and predicts what is missing.
"""

from __future__ import annotations

from dataclasses import replace

from hexdbb.learned import variables as v
from hexdbb.learned.combined import CONSTANTS_S, SPLINES, each_way, neighbour, of_drives, product, remembered, slipping
from hexdbb.learned.directed import along
from hexdbb.learned.following import AFTER, HEATED, LAGGED, SETTLING, SLIPPING, creep, following
from hexdbb.learned.repeating import swinging
from hexdbb.learned.variable import LINGERING, Variable

GROWTHS_S = (200.0, 800.0)
"""Time constants of what grows towards an end, at first: thin rails and screws take some minutes to warm, beams half an
hour; the readings then move them. What takes much longer than a test grows evenly in it."""
HEATS_S = (60.0, 240.0)
"""Time constants of what warms, at first: nuts, posts and bars take one minute to some; the readings then move them."""
RUN_UPS_DEG = (15.0, 45.0, 135.0)
"""Run-ups to circles that are tried first; the readings then move them. What settles since the start of the motion is
smaller at the first reading of a slow circle than at that of a fast one. They are a factor of three apart, of which a
step changes nearly two (`evidence/search/number.py`): any run-up between 8 and 260 degrees is reached."""
DIRECTIONS_DEG = tuple(15.0 * each for each in range(1, 13))
"""Directions in the base's x-y plane that are tried first; the fit then refines them. Of a motion in another direction
the nearest of the twelve explains at least 98 % (the square of the cosine of 7.5 degrees). With four directions it was
85 %, less than a function of the circle's angle explains of a tipping table, so that the wrong one was chosen."""


LINGERING_ANGLE = tuple(following(v.ANGLE, LINGERING, each) for each in CONSTANTS_S[1:])
"""What warms or cools the bar on one side of the circle; what dies away within less follows at once."""
HEATED_BY_TRAVEL = tuple(following(v.VELOCITY, LINGERING, each) for each in HEATS_S)
"""A nut or a motor that its own travel heats: the slider's place is off, or the leg grows that stands on it."""
HEATED_THERE = tuple(following(v.POSITION, LINGERING, each) for each in CONSTANTS_S[2:])
"""What is warmed, or cooled, at one end of the travel, and takes that along, for 20 or 60 s at first: what forgets
within seconds is a function of the position."""
LATE_WARMING = tuple(following(v.WARMING, LAGGED, each) for each in HEATS_S)
"""What is thick warms later than the thermometer."""
CREEPING = tuple(map(creep, GROWTHS_S))
"""A cup or a ball that was just fixed creeps into its seat, a bracket under load, or after the last crash."""
BY_TRAVEL = "travel_direction", "direction of travel"
BY_CIRCLE = "direction", "direction of the circle"
POSITION_EACH_WAY = each_way(v.POSITION, *BY_TRAVEL)
RAIL_EACH_WAY = each_way(v.OF_GUIDEWAY[0], *BY_TRAVEL)
JOINT_ANGLE_EACH_WAY = each_way(v.JOINT_ANGLE, "slider_joint_direction", "sense of the joint's turning")
READING_EACH_WAY = (
    *(each_way(each, *BY_CIRCLE) for each in (v.ANGLE, v.BAR_ANGLE)),
    each_way(v.DEFLECTION, "deflection_direction", "sense in which the gauge moves"),
)
SINCE_TURN_BY_DEFLECTION = replace(
    v.SINCE_TURN,
    name=f"{v.SINCE_TURN.name}_by_deflection",
    words=f"{v.SINCE_TURN.words}, more or less where it is drawn out",
    beside=(v.SINCE_TURN.times,),
    times="deflection_turning_mm",
)
"""A lever worn where it is mostly used, a plunger that sticks the more the deeper it goes: without the deflection a
function of the angle turned, or a cup that moves along three axes, said more."""
SCREW_WAVES = tuple(
    swinging(each, f"screw_wave_{each.name}", "of the screw's turn", ("screw_cos", "screw_sin"), SPLINES)
    for each in (v.POSITION, v.VELOCITY)
)
"""A bent screw drags its carriage round or moves it along, most in mid-travel or at the speed at which it whips: cosine
and sine of its turn, each times a function."""
LEG_DIRECTIONS = tuple(
    Variable(
        f"leg_in_{where}",
        f"leg_aside_in_{where}",
        "",
        f"direction of the leg in the {where}",
        8,
        times=f"leg_tilt_in_{where}_squared",
        beside=("", f"leg_tilt_in_{where}"),
    )
    for where in ("platform", "base")
)
"""A ball out of round, or a worn patch of its seat, changes the length of the leg by its direction, in two angles: any
function of one, times a parabola of the other. With eight splines they explained 99 % of the faults of two simulators,
lobes and a patch, at the right leg, and 29 to 78 % at the others; readings may ask for more splines."""
SINCE_START = tuple(following(v.TIME_IN_SWEEP, AFTER, each) for each in RUN_UPS_DEG)
SETTLING_POSITION = tuple(following(v.TIME_POSITION, SETTLING, each) for each in GROWTHS_S)
HEATED_POSITION = tuple(following(v.POSITION, HEATED, each) for each in GROWTHS_S)
"""A screw that its nut warms grows from its fixed bearing, a beam that its carriages warm on top humps: with the feeds
of the circles before, not evenly with time."""
WARMING_POSITION = product("warming", v.POSITION)
PRODUCTS_OF_SLIDER = (
    *(product("velocity", each) for each in (v.POSITION, v.FORCE, v.DRIVE_LOAD)),
    product("acceleration", v.POSITION),
    *(product("leg_force", each) for each in (v.POSITION,)),
    *(product("direction", each) for each in (v.FORCE, v.DRIVE_LOAD, v.CARRIAGE_LOAD, v.TIME, v.WARMING)),
    product("direction", v.SCREW_PHASE),
    *(product(each, v.TIME) for each in ("velocity", "leg_force")),
    WARMING_POSITION,
)
PRODUCTS_OF_LEG = (
    *(each for each in PRODUCTS_OF_SLIDER if not each.period),
    *(product("leg_force", each) for each in (v.JOINT_ANGLE, v.SWING_ANGLE)),
    *(product("joint_direction", each) for each in (v.FORCE, v.TIME)),
    *(product("time", each) for each in (v.JOINT_ANGLE,)),
)
PRODUCTS_OF_GUIDEWAY = (
    *(product("leg_force", each) for each in (v.POSITION,)),
    *(product("direction", each) for each in (v.CARRIAGE_LOAD, v.TIME)),
    product("velocity", v.POSITION),
    RAIL_EACH_WAY,
)
PRODUCTS_OF_READING = (
    product("deflection", v.TIME),
    product("time", v.ANGLE),
    *(product("warming", each) for each in (v.DEFLECTION, v.ANGLE)),
    *(product("deflection_direction", each) for each in (v.DEFLECTION,)),
    *(product("speed", each) for each in (v.ANGLE, v.DEFLECTION)),
    *(product("circle_direction", each) for each in (v.BAR_ANGLE, v.DEFLECTION, v.TIME, v.SPEED)),
)


OTHER_DRIVES = tuple(of_drives((v.VELOCITY,)))
"""A controller may send the feed-forward of one drive to another."""
CROSSTALK = (*OTHER_DRIVES, *of_drives((v.ACCELERATION,)))
"""The current of a motor, which friction and acceleration ask for, couples into the gauge's cable."""
NEIGHBOURS = tuple(map(neighbour, (v.POSITION, v.DIRECTION, v.ACCELERATION, v.FORCE)))
COVERS = (v.GAP, v.GAP_RATE, *(following(v.GAP, SLIPPING, most_mm) for most_mm in (1.0, 3.0)))
"""What spans two carriages pushes them apart, or drags them by friction, at once or as far as it yields: covers have
some millimetres of play. The readings then move how far."""
OF_PAIR_OF_SLIDERS = (
    *(v.POSITION, v.FINE_POSITION, v.DIRECTION, v.DIRECTION_POSITION, v.TRAVEL, v.VELOCITY, v.ACCELERATION, v.FORCE),
    *(v.TIME, v.TIME_POSITION, v.WARMING, v.SCREW_PHASE),
    *COVERS,
)
OF_PAIR_OF_LEGS = (
    *(each for each in OF_PAIR_OF_SLIDERS if each not in (v.FINE_POSITION, v.SCREW_PHASE, *COVERS)),
    *(v.TURNING, v.JOINT_ANGLE, v.JOINT_ANGLE_DIRECTION, v.PLATFORM_TURNING, v.PLATFORM_ANGLE, v.SWING, v.SWING_ANGLE),
)
ROCKING = (v.CARRIAGES_ACCELERATION, *(along("acceleration", each) for each in DIRECTIONS_DEG))
"""A base that stands softly rocks by the inertia of what moves on it: alike in every direction, or along one."""
LEANING = tuple(along("position", each) for each in DIRECTIONS_DEG)
"""A frame bends, or a table tips, by where the platform's weight stands; the cup stands on it."""

SINKING = (v.TILT, *(along("gravity", each) for each in DIRECTIONS_DEG))
"""What is clamped loosely to the platform sinks towards where that leans, along one direction most."""


def _by_speed(course: Variable) -> Variable:
    return replace(
        v.SPEED,
        name="course_speed",
        words=f"{v.SPEED.words}, along the {course.words}",
        count=SPLINES,
        times=course.times,
        parts=("course",),
        is_vector=True,
    )


COURSES, COURSES_IN_PLATFORM = ((each, _by_speed(each)) for each in (v.COURSE, v.COURSE_IN_PLATFORM))
"""Friction and play along the direction of motion: constant, or a function of the speed."""
OF_BALL = (
    *(v.ANGLE, v.ANGLE_DIRECTION, v.SPEED),
    *(*LINGERING_ANGLE, *LATE_WARMING),
    *ROCKING,
    *CREEPING,
    *SINCE_START,  # who leans on the table to start a circle steps back then
    *(product(factor, v.ANGLE) for factor in ("speed", "time")),
)
OF_GUIDEWAY = (
    *(v.POSITION, v.DIRECTION_POSITION, v.TRAVEL, v.VELOCITY, v.ACCELERATION, v.CARRIAGE_LOAD, v.TIME_POSITION, v.GAP),
    product("leg_force", v.POSITION),
    *SETTLING_POSITION,
)
"""Variables of a guideway that pushes its joints in both directions, when the direction is not known."""
OF_SLIDER_JOINT = (
    *(v.DIRECTION, v.DIRECTION_POSITION, v.TRAVEL, v.VELOCITY, v.ACCELERATION, v.CARRIAGE_LOAD, v.TIME_IN_SWEEP),
    *SCREW_WAVES,
    *HEATED_BY_TRAVEL,
    *CREEPING,
    POSITION_EACH_WAY,
)
"""Variables of one carriage that is pushed across its guideway: it tilts, floats or yields, or its nut warms it. What
depends on the position alone is a fault of the rail, which both carriages of a guideway have."""
OF_PLATFORM_JOINT = (v.DIRECTION, v.TRAVEL, v.FORCE, *COURSES_IN_PLATFORM, *CREEPING)
"""Variables of a platform's joint that is loose, or soft, in whatever direction."""
OF_PAIR_OF_JOINTS = (v.ANGLE, v.ANGLE_DIRECTION, v.CIRCLE_DIRECTION, v.SPEED, *COURSES_IN_PLATFORM, *CREEPING)
"""Variables of the platform's joint that two legs share: those that both have. No free function of time is among those
of several axes here: such follow any drift, and claim nothing of a time that was left out."""


def _of_loads(count: int, *variables: Variable) -> tuple[Variable, ...]:
    return tuple(replace(each, count=count, is_coarse=True) for each in variables)


DRAGGED = Variable(
    "course", "", "", "direction in which the platform moves", times="course_y", beside=("course_x",), is_coarse=True
)
"""A cable that drags over a cover pulls against the motion with one force, and turns the platform by where it is tied:
each pull and couple by both parts of the direction."""
DRAGGED_FASTER = replace(
    DRAGGED, name="course_speed", column="speed_mm_s", unit="mm/s", count=4, words=f"{v.SPEED.words}, along its course"
)
"""What drags the more the faster it is moved, as through oil. Four splines: two feeds and run-ups are few speeds."""
LOADS = (
    v.CONSTANT,
    DRAGGED,
    DRAGGED_FASTER,
    *_of_loads(8, *LEANING[1::2]),
    *_of_loads(4, v.TURNED, v.TIME, v.ROLL, v.PITCH, v.YAW),
    *_of_loads(6, v.ANGLE),
    *_of_loads(1, *(along("velocity", each) for each in DIRECTIONS_DEG[1::2])),
)
"""What a hose or a cable pulls by, what rubs, what is hung on the platform; each function six times.

Eight splines follow a hose that goes taut, with six of them one was taken for a function of the angle; over turns, time
and orientations four follow what grows steadily, over the angle six two waves; what rubs has its sign and is in
proportion to the velocity. Directions are tried every 30° only, since each has some fifty coefficients: a load along
the nearest explains 93 % at least.
"""
GROWS = (v.TIME, v.WARMING)
"""Variables of what a whole structure does: it grows."""

OF_RAIL = (
    *(v.CARRIAGE_LOAD, v.GAP, *PRODUCTS_OF_GUIDEWAY, v.WARMING, *SETTLING_POSITION, *HEATED_POSITION),
    *remembered(v.CARRIAGE_LOAD),
)
FURTHER: dict[str, tuple[Variable, ...]] = {
    "slider": (
        v.DRIVE_LOAD,
        v.CARRIAGE_LOAD,
        v.GAP,
        v.GAP_RATE,
        v.POWER,
        *PRODUCTS_OF_SLIDER,
        *NEIGHBOURS,
        *remembered(v.DRIVE_LOAD),
        *SETTLING_POSITION,
        *HEATED_POSITION,
        *SINCE_START,
        *OTHER_DRIVES,
        *HEATED_BY_TRAVEL,
        *HEATED_THERE,
        *SCREW_WAVES,
        POSITION_EACH_WAY,
    ),
    "leg": (
        *PRODUCTS_OF_LEG,
        *NEIGHBOURS,
        *remembered(v.FORCE, v.JOINT_ANGLE),
        *(*slipping(v.SWING_ANGLE), *slipping(v.PLATFORM_ANGLE)),  # dry friction in either joint strains the leg
        *SETTLING_POSITION,
        *SINCE_START,
        *HEATED_BY_TRAVEL,
        *HEATED_THERE,
        *LEG_DIRECTIONS,
        JOINT_ANGLE_EACH_WAY,
        *(v.TURNED, v.WOUND),  # a leg turns in its thread as the platform circles
    ),
    "lateral": OF_RAIL,
    "vertical": OF_RAIL,
    "guideway": OF_GUIDEWAY,
    "slider_joint": OF_SLIDER_JOINT,
    "platform_joint": OF_PLATFORM_JOINT,
    "ball": (*OF_BALL, *COURSES_IN_PLATFORM, *SINKING),
    "cup": (*OF_BALL, *COURSES, *LEANING, *of_drives((v.POSITION,))),
    "load": LOADS,
    "reading": (
        *PRODUCTS_OF_READING,
        *READING_EACH_WAY,
        SINCE_TURN_BY_DEFLECTION,
        *remembered(v.DEFLECTION),
        *SINCE_START,
        *CROSSTALK,
        *LINGERING_ANGLE,
        *LATE_WARMING,
        v.WOUND,
    ),
}
"""Further variables of single elements by place."""
RELAYS: dict[str, tuple[Variable, ...]] = {
    "slider": (v.POSITION, v.DRIVE_LOAD),
    "leg": (v.FORCE, v.JOINT_ANGLE, v.SWING_ANGLE),
    "slider_joint": (v.POSITION, v.JOINT_ANGLE, v.SWING_ANGLE),
    "platform_joint": (v.FORCE, v.PLATFORM_JOINT_ANGLE),
    "cup": LEANING,
    "ball": SINKING[1:],
}
"""Variables by place, at whose values a stop, a seat or a spring may give way, so that there are two states: a frame
tips on a loose foot, a stem falls over to the other side."""
OF_PAIRS: dict[str, tuple[Variable, ...]] = {
    "slider": OF_PAIR_OF_SLIDERS,
    "leg": OF_PAIR_OF_LEGS,
    "platform_joint": OF_PAIR_OF_JOINTS,
}
"""Variables of two sliders, legs or joints of one guideway that share a function, by place."""
OF_WHOLE: dict[str, tuple[Variable, ...]] = {"lateral": GROWS, "platform": GROWS}
"""Variables of structures whose elements all move outward alike, by place."""
