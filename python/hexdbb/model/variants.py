"""Variants of a model that are looked at, not fitted: effects switched off, single values set.

What such a variant predicts shows what an effect does to a circle. The fit that the model came from is not changed.
"""

from __future__ import annotations

import math

import numpy as np

from hexdbb.errors import InputError
from hexdbb.model.choice import Choice
from hexdbb.model.model import Model
from hexdbb.units import shown_factor, shown_unit


def switched_off(model: Model, *choices: str) -> Model:
    """Return a model in which some effects do nothing: their values are what they are before any fit.

    Parameters
    ----------
    model : Model
    choices : str
        ``backlash``, ``backlash:4``: an effect, or some of its elements.

    Raises
    ------
    InputError
        An effect that the model does not have, or an element that the effect does not have.
    """
    values = model.values
    for text in choices:
        choice = Choice.parse(text)
        if model.term(choice.effect) is None:
            present = ", ".join(term.effect for term in model.terms)
            raise InputError(f"{text}: not in {model.name} (expected one of {present})")
        values = np.where(model.values_of(choice), model.start, values)
    return model.with_values(values)


def with_value(model: Model, label: str, value: float) -> Model:
    """Return a model in which one value is another, all others as they are.

    Parameters
    ----------
    model : Model
    label : str
        Effect, element and parameter, as tables name them (`Parameter.label`): ``backlash:4 play``.
    value : float
        In the unit of output: µm, µrad, µm/N.

    Raises
    ------
    InputError
        No such value in the model, or a number that is not finite.
    """
    parameters = model.parameters()
    index = next((place for place, each in enumerate(parameters) if each.label == label), None)
    if index is None:
        raise InputError(f"{label}: no such value in {model.name} (expected effect:element parameter)")
    unit = parameters[index].unit
    if not math.isfinite(value):
        raise InputError(f"{label}: {value} (expected a number of {shown_unit(unit)})")
    values = model.values.copy()
    values[index] = value / shown_factor(unit)
    return model.with_values(values)
