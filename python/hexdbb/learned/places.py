"""Where a learned function may push, and the names of hypotheses: `learned:leg:5:turning_rate`."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.learned import variables as v
from hexdbb.learned.variables import Variable

PREFIX = "learned"
ALL = 0
"""Element number of a function that all elements share, or of a place that has one element only."""
WHOLE = "all"

VARIABLES: dict[str, tuple[Variable, ...]] = {
    "slider": v.OF_SLIDER,
    "leg": v.OF_LEG,
    "lateral": v.OF_GUIDEWAY,
    "vertical": v.OF_GUIDEWAY,
    "platform_joint": v.OF_PLATFORM_JOINT,
    "ball": v.OF_BALL,
    "cup": v.OF_BALL,
    "reading": v.OF_READING,
}
"""The variables of every place."""
ELEMENTS = {"slider": 6, "leg": 6, "lateral": 3, "vertical": 3, "platform_joint": 6}
"""Number of elements of those places that have more than one."""
KINDS = {"slider": "slider", "leg": "leg", "lateral": "guideway", "vertical": "guideway", "platform_joint": "leg"}
FINER = (2, 4)
"""Multiples of a variable's splines that readings may ask for: four times twelve knots follow what is a fiftieth of the
range wide, as far as a reading every millimetre or two determines it."""
SHARED = ("slider", "leg")
"""Places whose elements may share one function."""
GUIDEWAY_PORT = "slider_joint"
AXIS = {"lateral": 0, "vertical": 2}
"""Axis of a guideway's frame (x outward from the base centre, z up) along which a place pushes."""

Push = tuple[int, tuple[tuple[int, float], ...]]
"""Element of the variable, from 0, and the engine's port columns that are pushed, each with its weight."""


@dataclass(frozen=True)
class Learned:
    """A place, its element and a variable."""

    place: str
    element: int
    variable: Variable

    @classmethod
    def parse(cls, name: str) -> Learned:
        """Find a hypothesis by name.

        Raises
        ------
        InputError
            Naming the part of the name that is not known and what was expected.
        """
        prefix, *parts = name.split(":")
        place = parts[0] if parts else ""
        if prefix != PREFIX or place not in VARIABLES:
            raise InputError(f"{name}: place {place!r} (expected {PREFIX}:PLACE, one of {', '.join(VARIABLES)})")
        elements = _element_names(place)
        given = parts[1] if elements and len(parts) > 1 else ""
        if elements and given not in elements:
            raise InputError(f"{name}: element {given!r} (expected one of {', '.join(elements)})")
        rest = ":".join(parts[2:] if elements else parts[1:])
        known = {each.name: each for each in VARIABLES[place]}
        variable = known.get(rest) or v.numbered(rest)
        if variable is None:
            raise InputError(f"{name}: variable {rest!r} (expected one of {', '.join(known)})")
        return cls(place, ALL if given in ("", WHOLE) else int(given), variable)

    @property
    def name(self) -> str:
        """Name, as `hexdbb add` takes it."""
        element = str(self.element) if self.element else WHOLE if self.place in SHARED else ""
        return ":".join(filter(None, (PREFIX, self.place, element, self.variable.name)))

    def finer(self, times: int) -> Learned:
        """Return the same hypothesis, name and all, with so many times as many splines."""
        return replace(self, variable=replace(self.variable, count=self.variable.count * times))

    def variants(self) -> Iterator[Learned]:
        """Yield the same hypothesis, name and all, with every set of splines that its function may have."""
        plain = Learned.parse(self.name)
        if plain.variable.is_smooth:
            yield from (plain, *(plain.finer(times) for times in FINER))
            if plain.variable.signed:
                yield replace(plain, variable=replace(plain.variable, is_even=True))

    @property
    def is_of_time(self) -> bool:
        """Whether it is a free function of time, which says nothing of a time that was left out."""
        return self.variable.column == "time_s"

    @property
    def port(self) -> str:
        """Port of the engine that is pushed."""
        return GUIDEWAY_PORT if self.place in AXIS else self.place

    @property
    def kind(self) -> str:
        """What an element is: `slider`, `leg`, `guideway`, `machine`."""
        return KINDS.get(self.place, "machine")

    @property
    def components(self) -> int:
        """Number of functions: one for each axis where the direction is not known."""
        return 3 if self.place in ("platform_joint", "ball", "cup") else 1

    @property
    def elements(self) -> tuple[int, ...]:
        """Elements, from 0, by whose variable the functions go."""
        return tuple(self._by(each) for each in self._pushed)

    @property
    def _pushed(self) -> tuple[int, ...]:
        """Elements, from 0, that are pushed."""
        if self.place in SHARED and self.element == ALL:
            return tuple(range(6))
        if self.place in AXIS:
            return (2 * self.element - 2, 2 * self.element - 1)
        return (max(self.element - 1, 0),)

    def _by(self, pushed: int) -> int:
        """Return the element by whose variable another is pushed: two sliders share a guideway, 0 and 1 to 4 and 5."""
        return pushed ^ 1 if self.variable.of_neighbour else pushed

    def pushes(self, component: int, guideway_angles_rad: Sequence[float]) -> tuple[Push, ...]:
        """Return by which element's variable one function goes, and what it pushes.

        Parameters
        ----------
        component : int
            Of the functions, from 0.
        guideway_angles_rad : sequence of float, length 3
            Directions of the machine's guideways about z.
        """
        first = _core.PORTS[self.port][0]
        if self.place in SHARED:
            return tuple((self._by(each), ((first + each, 1.0),)) for each in self._pushed)
        if self.place in AXIS:
            angle = guideway_angles_rad[self.element - 1]
            axis = ((math.cos(angle), math.sin(angle), 0.0), (), (0.0, 0.0, 1.0))[AXIS[self.place]]
            return tuple(
                (each, tuple((first + 3 * each + k, weight) for k, weight in enumerate(axis) if weight != 0.0))
                for each in self.elements
            )
        (element,) = self.elements
        return ((element, ((first + 3 * element + component, 1.0),)),)


def part_of(learned: Learned) -> str:
    """Return the part of the machine at which a function acts: a guideway's two directions are one."""
    return "guideway" if learned.place in AXIS else learned.place


def is_learned(name: str) -> bool:
    """Check whether an effect's name is that of a learned one."""
    return name.startswith(f"{PREFIX}:")


def hypotheses(*, of_forms: bool = False) -> Iterator[Learned]:
    """Yield every hypothesis, or all that only describe forms; whether a variable varies, `Space.of` checks."""
    for place, variables in VARIABLES.items():
        for name in _element_names(place) or ("",):
            for variable in variables:
                if variable.of_forms != of_forms or (name == WHOLE and variable in v.OF_ONE):
                    continue
                yield Learned(place, ALL if name in ("", WHOLE) else int(name), variable)


def _element_names(place: str) -> list[str]:
    names = [str(each + 1) for each in range(ELEMENTS.get(place, 0))]
    return [*names, WHOLE] if place in SHARED else names
