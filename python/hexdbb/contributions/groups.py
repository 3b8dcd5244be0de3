"""Groups of a model's values that are ranked as one error.

An effect of the geometry (all leg lengths, all home positions) is one group: its elements were not asked for one by
one, and a machine has them all. An effect that was added is one group for each element (play of slider 2, play of
slider 4), because a mechanic mends elements. A learned effect is one group. Effects of the set-up (where cup and ball
sit) are groups apart: they are no error of the machine.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.ledger.words import name_words
from hexdbb.model import Model, effect_names

Columns = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Group:
    """Values of a model that are ranked as one error.

    Attributes
    ----------
    effect : str
    elements : tuple of str
        Those meant; empty where all are.
    label : str
        ``leg_length``, ``backlash of slider 4``.
    physics : str
        What it is, in a sentence.
    is_set_up : bool
        Whether it belongs to the measurement and not to the machine.
    columns : ndarray of int
        Places of its values in the model's.
    """

    effect: str
    elements: tuple[str, ...]
    label: str
    physics: str
    is_set_up: bool
    columns: Columns


def groups_of(model: Model) -> tuple[Group, ...]:
    """Return the groups of all values that are free or differ from their start, in the model's order."""
    whole = {name for group in ("geometry", "set-up", "places") for name in effect_names(group)}
    parameters = model.parameters()
    acts = model.free | (model.values != model.start)
    found: list[Group] = []
    for term in model.terms:
        info = model.info(term.effect)
        own = [place for place, each in enumerate(parameters) if each.effect == term.effect]
        if term.effect in whole or term.learned is not None or info.element_kind == "machine":
            parts: list[tuple[tuple[str, ...], list[int]]] = [((), own)]
        else:
            parts = [((name,), [each for each in own if parameters[each].element == name]) for name in info.elements]
        found += [
            Group(
                effect=term.effect,
                elements=elements,
                label=name_words(term.effect, info.element_kind, elements),
                physics=info.physics,
                is_set_up=info.is_set_up,
                columns=np.array(columns, dtype=np.intp),
            )
            for elements, columns in parts
            if acts[columns].any()
        ]
    return tuple(found)
