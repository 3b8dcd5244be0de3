"""Files of a version in which an effect had one shape less: its start stands for it at every element."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from hexdbb import _core

Written = TypeVar("Written")


def with_gained_shape(
    given: Sequence[Written], info: _core.EffectInfo, start: Callable[[str, Written], Written]
) -> list[Written]:
    """Return what a file holds of an effect's values, the last shape of each element put in where it has none of them.

    Parameters
    ----------
    given : sequence
        One for each value, element by element.
    info : EffectInfo
        The effect as it is now.
    start : callable
        Makes what stands for the shape, from the element and what is written for its value before.
    """
    elements, now = info.elements, info.parameters
    before = len(now) - 1
    if not now[-1].is_shape or before < 1 or len(given) != len(elements) * before:
        return list(given)
    found: list[Written] = []
    for place, element in enumerate(elements):
        own = given[place * before : (place + 1) * before]
        found += [*own, start(element, own[-1])]
    return found
