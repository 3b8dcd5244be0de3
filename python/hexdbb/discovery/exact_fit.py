"""The known causes of a verdict, fitted to all readings in their exact form, as they would be added to a model."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis import evaluate_fit
from hexdbb.evidence.fit.trial import Trial
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.physical import is_one_sided
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.search.search import Search
from hexdbb.model import Choice, Model, Parameter, Size
from hexdbb.units import shown_factor, shown_unit

Floats = NDArray[np.float64]
Key = tuple[str, str, str]
"""Effect, element and name of a value."""


@dataclass(frozen=True)
class ExactFit:
    """A model with known causes, fitted.

    Attributes
    ----------
    model : Model
    residual_mm : ndarray, shape (n,), or None
        What it leaves of the readings; None without a known cause.
    spread : mapping
        Standard deviation of each value, as far as the readings tell it.
    """

    model: Model
    residual_mm: Floats | None
    spread: Mapping[Key, float]

    def values_of(self, own: Known, told: Model | None = None) -> tuple[Size, ...]:
        """Return the values of an effect; those of another model where that one tells them."""
        model = self.model if told is None else told
        rows = []
        for each, value in zip(model.parameters(), model.values, strict=True):
            if each.effect == own.effect and each.element in own.elements:
                factor = shown_factor(each.unit)
                sigma = self.spread[_key(each)] * factor
                rows.append(Size(each.element, each.name, float(value) * factor, sigma, shown_unit(each.unit)))
        return tuple(rows)


def exactly(search: Search, trial: Trial, hypotheses: Sequence[Hypothesis]) -> ExactFit:
    """Fit the known ones of a trial's hypotheses in their exact form.

    A value that physics does not admit, of drives that lag as much as they like because no reading tells it, is held at
    zero, the farthest off first: so is the largest value of a posterior with one-sided priors.
    """
    engine = search.engine
    known = [each for each in hypotheses if isinstance(each, Known)]
    if not known:
        return ExactFit(engine.base, None, {})
    model = engine.base
    for each in known:
        model = model.with_effect(Choice(each.effect, each.elements))
    # Learned functions stand in a trial with fewer axes, and near where the base has them.
    there = {term.effect: term.values for term in trial.model.terms}
    terms = tuple(
        term if term.learned is not None else replace(term, values=there[term.effect]) for term in model.terms
    )
    fitted, result = _evaluated(engine, replace(model, terms=terms))
    spread = dict(zip(map(_key, fitted.parameters()), np.sqrt(np.diag(result.covariance)).tolist(), strict=True))
    while (place := _farthest_off(fitted, {(each.effect, one) for each in known for one in each.elements})) is not None:
        there_only = np.arange(len(fitted.values)) == place
        held = fitted.with_values(np.where(there_only, 0.0, fitted.values)).with_free(fitted.free & ~there_only)
        fitted, result = _evaluated(engine, held)
    return ExactFit(fitted.with_free(model.free), result.residual_mm, spread)


def _evaluated(engine: Engine, start: Model) -> tuple[Model, _core.FitResult]:
    return evaluate_fit(engine.samples, start, start.free, engine.noise, hypothesis=True)


def _farthest_off(model: Model, own: Collection[tuple[str, str]]) -> int | None:
    """Return the place of the free value of some effects' elements that is farthest beyond physics; None if none is."""
    beyond = [
        -value / sigma
        if is_free and (each.effect, each.element) in own and is_one_sided(model.info(each.effect), each.name)
        else 0.0
        for each, value, sigma, is_free in zip(
            model.parameters(), model.values, model.prior_sigma, model.free, strict=True
        )
    ]
    place = int(np.argmax(beyond))
    return place if beyond[place] > 0.0 else None


def _key(parameter: Parameter) -> Key:
    return parameter.effect, parameter.element, parameter.name
