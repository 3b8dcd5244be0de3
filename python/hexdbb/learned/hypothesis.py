"""A hypothesis about a learned function: a place, an element, a variable; its name is `learned:leg:5:turning_rate`."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.learned import variables as v
from hexdbb.learned.beside import BESIDE, EVERYWHERE
from hexdbb.learned.crossed import every_variable_of
from hexdbb.learned.further import RELAYS
from hexdbb.learned.numbered import numbered, with_number
from hexdbb.learned.places import (
    ALL,
    AXES,
    COMPONENTS,
    EACH,
    KINDS,
    LEVER,
    LEVERS,
    OF_GUIDEWAY,
    PORTS,
    PREFIX,
    SHARED,
    VARIABLES,
    elements_by_name,
    members,
    variables_of,
)
from hexdbb.learned.repeating import by_direction
from hexdbb.learned.variable import AXES_OF_VECTOR, Variable

FINER = (2, 4, 8, 16)
"""Multiples of a variable's splines that readings may ask for: sixteen times twelve knots follow a dent that is a
hundredth of the range wide, or a kink, as far as a reading every millimetre or two determines it."""
MOST_SPLINES = 640
"""Splines of one function at most: sixteen times those of the finest function of time; a fit's time grows with their
square."""


class _Base(Protocol):
    @property
    def guideway_angles_rad(self) -> Sequence[float]: ...


class _Platform(Protocol):
    @property
    def joint_angles_rad(self) -> Sequence[float]: ...


class Directed(Protocol):
    """A machine, of which this package knows the directions alone (`hexdbb.machine.MachineFile`)."""

    @property
    def base(self) -> _Base:
        """Has the directions of the guideways about z, rad."""
        ...

    @property
    def platform(self) -> _Platform:
        """Has the directions of its joints about its own z, rad."""
        ...


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
        elements = elements_by_name(place)
        given = parts[1] if elements and len(parts) > 1 else ""
        if elements and given not in elements:
            raise InputError(f"{name}: element {given!r} (expected one of {', '.join(elements)})")
        element = elements.get(given, ALL)
        rest = ":".join(parts[2:] if elements else parts[1:])
        every = every_variable_of(place, element)
        known = {each.name: each for each in reversed(every)}
        variable = known.get(rest) or numbered(rest, (*every, *RELAYS.get(place, ())))
        if variable is None:
            listed = ", ".join(each.name for each in variables_of(place, element))
            raise InputError(f"{name}: variable {rest!r} (expected one of {listed})")
        return cls(place, element, variable)

    @property
    def name(self) -> str:
        """Name, as `hexdbb add` takes it."""
        return ":".join(filter(None, (PREFIX, self.place, self.element_name, self.variable.name)))

    @property
    def element_name(self) -> str:
        """Name of the element: `4`, `1-2`, `all`; empty where the place has one only."""
        return next((name for name, each in elements_by_name(self.place).items() if each == self.element), "")

    def with_number(self, number: float) -> Learned:
        """Return the same with another period or time constant in the variable's name."""
        variables = every_variable_of(self.place, self.element)
        return replace(self, variable=with_number(self.variable, number, variables))

    def is_within(self, place: str, element: int) -> bool:
        """Check whether it acts at an element of a part of the machine, as far as that reaches: a pair has two."""
        return part_of(self) == place and (element == ALL or {*members(self.element)} <= {*members(element)})

    def other_of_pair(self, one: Learned) -> Learned | None:
        """Return what a function that two share, and one of the first of them alone, say of the second; else None."""
        left = {*members(self.element)} - {one.element}
        if (self.place, self.variable) != (one.place, one.variable) or len(left) != 1 or left == {self.element}:
            return None
        return replace(self, element=left.pop())

    @property
    def of_each(self) -> tuple[Learned, ...]:
        """The same function of each element that a pair has, alone; none where it is no pair."""
        elements = members(self.element)
        return tuple(replace(self, element=each) for each in elements) if len(elements) == 2 else ()

    @property
    def after_each_fixing(self) -> Learned | None:
        """The function of the time since the fixing at the same place; None where it is no function of time."""
        is_there = self.is_of_time and v.SINCE_FIXING in variables_of(self.place, self.element)
        return replace(self, variable=v.SINCE_FIXING) if is_there else None

    @property
    def by_direction(self) -> Learned | None:
        """The same times the direction of travel, where it repeats along a slider's travel; else None."""
        is_along = self.variable.period != 0.0 and self.variable.name.startswith("position_period@")
        return replace(self, variable=by_direction(self.variable)) if is_along else None

    @property
    def of_its_form(self) -> tuple[Learned, ...]:
        """Functions of other variables in which the form of an effect may be wrong that lives in this one."""
        there = variables_of(self.place, self.element)
        others = BESIDE.get(self.place, EVERYWHERE).get(self.variable, ())
        found = (replace(self, variable=each) for each in others if each in there)
        return (*found, *filter(None, (self.after_each_fixing,)))

    @property
    def parts(self) -> tuple[Learned, ...]:
        """Where the variable is a product of two states: the hypotheses of either state alone at this place."""
        variables = {each.name: each for each in every_variable_of(self.place, self.element)}
        return tuple(replace(self, variable=variables[name]) for name in self.variable.parts if name in variables)

    def finer(self, times: int) -> Learned:
        """Return the same hypothesis, name and all, with so many times as many splines."""
        return replace(self, variable=replace(self.variable, count=self.variable.count * times))

    def variants(self) -> Iterator[Learned]:
        """Yield the same hypothesis, name and all, with every set of splines that its function may have, few first."""
        plain = Learned.parse(self.name)
        if plain.variable.is_smooth:
            yield plain
        if plain.variable.may_be_finer:
            yield from (plain.finer(each) for each in FINER if each * plain.variable.count <= MOST_SPLINES)
            if plain.variable.signed:
                yield replace(plain, variable=replace(plain.variable, is_even=True))

    def is_but_finer(self, other: Learned) -> bool:
        """Check for the same function under another name, which has another number of splines."""
        as_fine = replace(self.variable, name=other.variable.name, count=other.variable.count)
        return (self.place, self.element, as_fine) == (other.place, other.element, other.variable)

    def is_at_the_rail_of(self, other: Learned) -> bool:
        """Check for what a guideway does by a slider's position, where another is what the slider's leg does by it."""
        is_below = self.place in OF_GUIDEWAY and members(self.element) == ((other.element + 1) // 2,)
        return is_below and other.goes_by_the_rail and self.variable.column == other.variable.column

    @property
    def goes_by_the_rail(self) -> bool:
        """Whether a leg, or its joint, goes by where its slider stands, as the rail under the slider does."""
        by_place = self.variable.column == "sliders_mm" and not self.variable.times
        return by_place and self.place in ("leg", "platform_joint")

    @property
    def is_of_time(self) -> bool:
        """Whether it is a free function of time, which says nothing of a time that was left out."""
        return self.variable.column == "time_s" or self.variable.is_anew

    @property
    def ball(self) -> str:
        """At which of the bar's two balls its direction counts: `platform`, `cup`; empty for all else."""
        variable = self.variable
        return "" if self.place != "reading" or variable.times else v.OF_BALLS.get(variable.column, "")

    @property
    def port(self) -> str:
        """Port of the engine that is pushed."""
        return PORTS.get(self.place, self.place)

    @property
    def kind(self) -> str:
        """What an element is: `slider`, `leg`, `guideway`, `machine`."""
        return KINDS.get(self.place, "machine")

    @property
    def components(self) -> int:
        """Number of axes along which it pushes, where the direction is not known, or of elements, each by its own."""
        if self.element == EACH:
            return len(members(EACH))
        return 1 if self.variable.is_vector else COMPONENTS.get(self.place, 1)

    @property
    def size(self) -> int:
        """Number of coefficients."""
        return self.components * self.variable.columns

    @property
    def functions(self) -> int:
        """Number of functions of the variable, all components together."""
        return self.components * self.variable.ways

    def component_of(self, function: int) -> int:
        """Return the component that a function, from 0, belongs to: both ways of one come after each other."""
        return function // self.variable.ways

    def times_of(self, function: int) -> str:
        """Return the column that multiplies a function; empty where none does."""
        return self.variable.all_times[function % self.variable.ways]

    def axis_name(self, function: int) -> str:
        """Name of the axis along which a function, from 0, pushes, or of its element; empty where there is one only."""
        component = self.component_of(function)
        if self.element == EACH:
            return str(members(EACH)[component])
        if self.place in LEVERS:
            return self.lever(component).removeprefix(LEVER)
        return AXES.get(self.place, "xyz")[component] if self.components > 1 else ""

    def lever(self, component: int) -> str:
        """Return the column that says how much of a push each element gets, shape (n, 6); empty where each gets all."""
        return LEVERS[self.place][component] if self.place in LEVERS else ""

    def part_name(self, function: int) -> str:
        """Name of a function, from 0, among its own: axis, and what multiplies it; empty where there is one only."""
        times = self.times_of(function) if self.variable.beside else ""
        by = "by_direction" if self.variable.each_way else f"times_{times}"
        return "_".join(filter(None, (self.axis_name(function), by if times else "")))

    @property
    def elements(self) -> tuple[int, ...]:
        """Elements, from 0, whose variable the functions depend on; for a vector, its axes."""
        if self.place in LEVERS:
            return (0,)
        return (
            tuple(range(AXES_OF_VECTOR)) if self.variable.is_vector else tuple(self._by(each) for each in self._pushed)
        )

    @property
    def _pushed(self) -> tuple[int, ...]:
        """Elements, from 0, that are pushed."""
        is_whole = self.place == "platform" or self.place in LEVERS
        if is_whole or (self.place in (*SHARED, *OF_GUIDEWAY) and self.element == ALL):
            return tuple(range(6))
        if self.place in OF_GUIDEWAY:
            return (2 * self.element - 2, 2 * self.element - 1)
        return tuple(max(each - 1, 0) for each in members(self.element))

    def _by(self, pushed: int) -> int:
        """Return the element by whose variable another is pushed: two sliders share a guideway, 0 and 1 to 4 and 5."""
        if self.variable.of_element:
            return self.variable.of_element - 1
        return pushed ^ 1 if self.variable.of_neighbour else pushed

    def pushes(self, component: int, machine: Directed) -> tuple[Push, ...]:
        """Return by which element's variable one function goes, and what it pushes.

        Parameters
        ----------
        component : int
            Of the functions, from 0.
        machine : Directed
        """
        first = _core.PORTS[self.port][0]
        if self.place in LEVERS:
            return ((0, tuple((first + each, 1.0) for each in self._pushed)),)
        if self.variable.is_vector:
            axes = range(AXES_OF_VECTOR)
            return tuple((axis, tuple((first + 3 * each + axis, 1.0) for each in self._pushed)) for axis in axes)
        if self.place in SHARED:
            pushed = self._pushed if self.element != EACH else self._pushed[component : component + 1]
            return tuple((self._by(each), ((first + each, 1.0),)) for each in pushed)
        along = ((each, self._axis(component, each, machine)) for each in self._pushed)
        return tuple(
            (self._by(each), tuple((first + 3 * each + k, weight) for k, weight in enumerate(axis) if weight != 0.0))
            for each, axis in along
        )

    def _axis(self, component: int, pushed: int, machine: Directed) -> tuple[float, float, float]:
        """Return the direction in which one joint is pushed: in the base's frame, or in the platform's."""
        if self.place not in (*AXES, "platform"):
            return (float(component == 0), float(component == 1), float(component == 2))
        if self.place != "platform" and AXES[self.place][component] == "z":
            return (0.0, 0.0, 1.0)
        outward = machine.platform.joint_angles_rad if self.place == "platform" else machine.base.guideway_angles_rad
        angle = outward[pushed // 2]
        return (math.cos(angle), math.sin(angle), 0.0)


def part_of(learned: Learned) -> str:
    """Return the part of the machine at which a function acts: a guideway's two directions are one."""
    return "guideway" if learned.place in OF_GUIDEWAY else learned.place
