"""Where a learned function may push: places, their elements, and the variables of each."""

from __future__ import annotations

from hexdbb.learned import further
from hexdbb.learned import variables as v
from hexdbb.learned.variable import Variable

LEVER = "force_by_"
"""How the name of a column begins that shares a load among the legs."""
BY_LOAD = tuple(f"{LEVER}{how}_{axis}" for how in ("pull", "turn") for axis in "xyz")
"""Forces in the legs by a pull on the platform along each axis, and by a couple that turns it about each."""

PREFIX = "learned"
ALL = 0
"""Element number of a function that all elements share, or of a place that has one element only."""
WHOLE = "all"
EACH, APART = 123456, "each"
"""Number and name of six elements of which each has a function of its own: legs that the sun warms from one side."""
PAIRS = {"1-2": 12, "3-4": 34, "5-6": 56}
"""Elements that share a guideway and a platform's joint, and with them a function: names, and their numbers."""

VARIABLES: dict[str, tuple[Variable, ...]] = {
    "slider": v.OF_SLIDER,
    "leg": v.OF_LEG,
    "lateral": v.OF_GUIDEWAY,
    "vertical": v.OF_GUIDEWAY,
    "platform_joint": v.OF_PLATFORM_JOINT,
    "ball": v.OF_BALL,
    "cup": v.OF_CUP,
    "reading": v.OF_READING,
    "guideway": (),
    "slider_joint": (),
    "platform": (),
    "load": (),
}
"""The simple variables of every place."""
ELEMENTS = {"slider": 6, "leg": 6, "lateral": 3, "vertical": 3, "guideway": 3, "slider_joint": 6, "platform_joint": 6}
"""Number of elements of those places that have more than one."""
COMPONENTS = {"platform_joint": 3, "ball": 3, "cup": 3, "guideway": 2, "slider_joint": 2, "load": 6}
"""Number of functions of places that push along several axes, because the direction is not known."""
LEVERS = {"load": BY_LOAD}
"""Columns of the samples that say, axis by axis, how much of its push each element gets: a load on the platform is
shared among the legs, and each yields by what it bears."""
KINDS = {
    "slider": "slider",
    "leg": "leg",
    "lateral": "guideway",
    "vertical": "guideway",
    "guideway": "guideway",
    "slider_joint": "slider",
    "platform_joint": "leg",
}
SHARED = ("slider", "leg")
"""Places whose elements may share one function."""
INSTRUMENT = frozenset({"reading", "ball", "cup"})
"""Ports of the ball bar and its set-up; all others are the machine's."""
PORTS = {
    "lateral": "slider_joint",
    "vertical": "slider_joint",
    "guideway": "slider_joint",
    "platform": "platform_joint",
    "load": "leg",
}
"""Ports of the engine that places push, where they have another name."""
AXES = {"lateral": "x", "vertical": "z", "guideway": "xz", "slider_joint": "xz"}
"""Axes of a guideway's frame (x outward from the base centre, z up) along which a place pushes."""
OF_GUIDEWAY = tuple(place for place in AXES if KINDS[place] == "guideway")
"""Places whose elements are guideways, each with the joints of both its sliders."""


def is_learned(name: str) -> bool:
    """Check whether an effect's name is that of a learned one."""
    return name.startswith(f"{PREFIX}:")


def variables_of(place: str, element: int) -> tuple[Variable, ...]:
    """Return the variables of an element of a place that are listed for it, the simple ones first."""
    if element in PAIRS.values():
        return further.OF_PAIRS[place]
    if element == ALL and place in further.OF_WHOLE:
        return further.OF_WHOLE[place]
    return (*VARIABLES[place], *further.FURTHER.get(place, ()))


def single(place: str) -> list[int]:
    """Return the elements of a place that have functions of their own, and what stands for all that share one."""
    numbers = list(range(1, 1 + ELEMENTS.get(place, 0)))
    return [*numbers, ALL] if place in SHARED or not numbers else numbers


def elements_by_name(place: str) -> dict[str, int]:
    """Return the elements of a place by name; none where it has one only."""
    numbers = {str(each): each for each in range(1, 1 + ELEMENTS.get(place, 0))}
    pairs = PAIRS if place in further.OF_PAIRS else {}
    whole = {WHOLE: ALL} if numbers and (place in SHARED or place in further.OF_WHOLE) else {}
    apart = {APART: EACH} if place in SHARED else {}
    return numbers | pairs | whole | apart


def members(element: int) -> tuple[int, ...]:
    """Return the elements, from 1, that an element's number stands for; 0 for that of a place that has one only."""
    return tuple(int(each) for each in str(element))
