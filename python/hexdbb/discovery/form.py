"""The form of a cause: the function that the readings have in its place, beside its formula where it has one.

A known effect is taken out of the fitted model and a learned function that contains its form put in its place. The same
model is then fitted to what the known effect predicts, so that its formula is seen through the same glasses: a part of
a function that geometry imitates (a constant, often a line) is in both as small as priors let it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from hexdbb.discovery.learning import with_learned
from hexdbb.discovery.result import Cause, Discovery
from hexdbb.errors import InputError
from hexdbb.learned import Curve
from hexdbb.learned.places import is_learned
from hexdbb.model import Choice, Model, Term
from hexdbb.samples import linearise, predict


@dataclass(frozen=True)
class CauseForm:
    """A cause as a function of a variable.

    Attributes
    ----------
    name : str
        The learned function, as `hexdbb add` takes it.
    model : Model
        With it, fitted.
    formula : tuple of Curve
        The known effect's own form, one a function; empty where the cause is learned.
    """

    name: str
    model: Model
    formula: tuple[Curve, ...]


def form_of(found: Discovery, cause: Cause) -> CauseForm | None:
    """Return the form of a cause; None where no function of one variable describes it.

    Parameters
    ----------
    found : Discovery
    cause : Cause
        One of its causes.
    """
    name = cause.function
    if name is None:
        return None
    if is_learned(cause.choice):
        return None if found.learned is None else CauseForm(name, found.learned, ())
    try:
        without = found.model.without_effect(Choice(cause.effect, cause.elements))
    except InputError:
        return None
    learned = with_learned(found.samples, without, [name], found.noise)
    if learned is None:
        return None
    term = learned[0].term(name)
    assert term is not None
    return CauseForm(name, learned[0], _formula(found, learned[0], term))


def _formula(found: Discovery, learned: Model, term: Term) -> tuple[Curve, ...]:
    """Fit the learned model to what the known effect's model predicts, to first order about the learned one."""
    free = learned.free
    here = linearise(found.samples, learned)
    jacobian = here.jacobian[:, free] / found.noise.sigma_mm
    missed = (predict(found.samples, found.model).reading_mm - here.reading_mm) / found.noise.sigma_mm
    weight = np.array([each.prior_sigma for each in learned.parameters()])[free] ** -2.0
    standing = (learned.values - learned.start)[free]
    step = np.linalg.solve(jacobian.T @ jacobian + np.diag(weight), jacobian.T @ missed - weight * standing)
    values = learned.values.copy()
    values[free] += step
    own = [each.effect == term.effect for each in learned.parameters()]
    effect = term.learned
    assert effect is not None
    pairs = zip(effect.curves(values[own]), effect.curves(term.values), strict=True)
    # A constant push is a leg's or a slider's offset in other words: both are drawn with the same.
    return tuple(
        _level(formula, function) if effect.has_constant(number) else formula
        for number, (formula, function) in enumerate(pairs)
    )


def _level(formula: Curve, function: Curve) -> Curve:
    """Shift a curve to the mean of another over the samples."""
    offset_mm = np.average(function.value_mm - formula.value_mm, weights=function.samples)
    return replace(formula, value_mm=formula.value_mm + offset_mm)
