"""Choosing values of a model on the command line: `leg_length`, `guideway_translation:3`, `leg_length:1:3:5`.

A choice is an effect's name, or a name and the elements meant, each after a colon; several choices are separated by
commas.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.model.model import Model


def parse_selection(text: str, model: Model, option: str) -> NDArray[np.bool_]:
    """Find the values a text chooses.

    Parameters
    ----------
    text : str
        Choices separated by commas.
    model : Model
    option : str
        Where the text comes from, for errors (``--free``).

    Returns
    -------
    ndarray of bool, shape (size,)

    Raises
    ------
    InputError
        Naming an effect the model does not have, or an element the effect does not have.
    """
    chosen = np.zeros(len(model.values), dtype=bool)
    for choice in filter(None, (part.strip() for part in text.split(","))):
        chosen |= _choice(choice, model, option)
    if not chosen.any():
        raise InputError(
            f'{option}: "{text}" chooses nothing (expected effects, as in leg_length,guideway_translation:3)'
        )
    return chosen


def split_choice(choice: str) -> tuple[str, tuple[str, ...]]:
    """Give the effect and the elements of one choice; no elements mean all."""
    effect, *elements = choice.split(":")
    return effect, tuple(elements)


def _choice(choice: str, model: Model, option: str) -> NDArray[np.bool_]:
    effect, elements = split_choice(choice)
    present = [term.effect for term in model.terms]
    if effect not in present:
        raise InputError(f'{option}: "{effect}" is not in the model (expected one of {", ".join(present)})')
    known = model.info(effect).elements
    for element in elements:
        if element not in known:
            raise InputError(f'{option}: {effect} has no element "{element}" (expected one of {", ".join(known)})')
    return np.array(
        [each.effect == effect and (not elements or each.element in elements) for each in model.parameters()]
    )
