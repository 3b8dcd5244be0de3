"""Every hypothesis about a learned function: a closed list."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from hexdbb.learned import further
from hexdbb.learned import variables as v
from hexdbb.learned.combined import is_slow
from hexdbb.learned.crossed import CROSSED, CROSSED_PAIRS
from hexdbb.learned.hypothesis import Learned
from hexdbb.learned.places import ALL, PAIRS, SHARED, VARIABLES, members, single


def hypotheses(*, of_forms: bool = False) -> Iterator[Learned]:
    """Yield every simple hypothesis, or all that only describe forms; whether a variable varies, `Space.of` checks."""
    for place, variables in VARIABLES.items():
        for element in single(place):
            for variable in variables:
                if variable.of_forms == of_forms and not (element == ALL and place in SHARED and variable in v.OF_ONE):
                    yield Learned(place, element, variable)


def products() -> Iterator[Learned]:
    """Yield the hypotheses in which one state multiplies functions of another, those that all elements share too.

    In them a known effect's form may be wrong. What changes with time or warmth is no form of what does not, and
    a growth that goes by the place is another cause.
    """
    for place, variables in further.FURTHER.items():
        for element in single(place):
            every = (Learned(place, element, each) for each in variables if each.times and not each.beside)
            yield from (each for each in every if not each.is_of_time and not is_slow(each.variable))


def grown_with_warmth() -> Iterator[Learned]:
    """Yield growth with warmth along sliders and legs: what grows with time there may follow the temperature."""
    for place in ("slider", "leg"):
        yield from (Learned(place, element, further.WARMING_POSITION) for element in single(place))


def settling(learned: Learned) -> Iterator[Learned]:
    """Yield what grows towards an end where a function grows evenly, by the place: one cause by another law."""
    if learned.variable == v.TIME_POSITION:
        yield from (replace(learned, variable=each) for each in further.SETTLING_POSITION)


def further_hypotheses() -> Iterator[Learned]:
    """Yield the hypotheses that are looked at where no simple one settles: products, memory, neighbours, pairs."""
    for place, variables in further.FURTHER.items():
        for element in single(place):
            if element != ALL or place not in SHARED:
                every = (Learned(place, element, each) for each in variables)
                yield from (each for each in every if not _is_of_own_pair(each))
    for place, variables in further.OF_PAIRS.items():
        yield from (Learned(place, pair, each) for pair in PAIRS.values() for each in variables)
    for place, variables in further.OF_WHOLE.items():
        yield from (Learned(place, ALL, each) for each in variables)


def crossed_hypotheses() -> Iterator[Learned]:
    """Yield the hypotheses that are looked at last: every state of elements and pairs, and products of any two."""
    for place, variables in CROSSED.items():
        for element in single(place):
            yield from (Learned(place, element, each) for each in variables if element != ALL or place not in SHARED)
    for place, variables in CROSSED_PAIRS.items():
        for pair in PAIRS.values():
            yield from (Learned(place, pair, each) for each in variables)


def _is_of_own_pair(learned: Learned) -> bool:
    """Check for an element's function of its own column, or its neighbour's, by number: both have shorter names."""
    both = {learned.element, learned.variable.of_element}
    return learned.place == "slider" and any(both <= {*members(pair)} for pair in PAIRS.values())
