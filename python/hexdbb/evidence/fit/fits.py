"""Fits of models with hypotheses: where each begins, and how the shapes of effects are found.

A shape, as the time in which a spike decays, has no first-order column where its effect is not yet there: a fit begins
from several. One shape for all elements of an effect is held at a grid of values, each a fit of its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import RunError
from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.linear.axes import LearnedAxes
from hexdbb.evidence.linear.engine import Engine, Fitted
from hexdbb.evidence.linear.screen import Known
from hexdbb.model import Model, Term

Floats = NDArray[np.float64]


def fitted(
    engine: Engine,
    members: Sequence[Member],
    before: Trial | None = None,
    near: Trial | None = None,
    less: Floats | None = None,
) -> Fitted:
    """Fit the model of some members.

    Parameters
    ----------
    engine : Engine
    members : sequence of Member
    before : Trial, optional
        Of all but the last, from which the fit begins; from the start of all fits where not given.
    near : Trial, optional
        Of nearly the same members: the fit starts from its values.
    less : ndarray, shape (n,), optional
        What stands beside the members, as the functions of their forms do, in noise standard deviations.

    Raises
    ------
    RunError
        Where the engine cannot fit it.
    """
    model, added = (engine.start, members) if before is None else (before.model, members[-1:])
    for member in added:
        if isinstance(member.hypothesis, Known):
            model = engine.with_effect(model, member.hypothesis.effect, member.hypothesis.elements)
        else:
            assert member.factor is not None
            model = engine.with_learned(model, member.hypothesis, member.factor, member.size_mm)
    known = [each.hypothesis for each in added if isinstance(each.hypothesis, Known)]
    # Shapes of known effects that `near` has are known from there: one start serves.
    if near is not None and {each.name for each in known} <= {*near.names}:
        return engine.fit(_from(near.model, model), from_minimum=True, less=less)
    shapes, one_for_all = (
        _free_shapes(model, {each.effect for each in some})
        for some in (known, [each for each in known if len(each.elements) > 1])
    )
    if not shapes.any():
        return engine.fit(model, less=less)
    if one_for_all.any():
        return _with_one_shape_for_all(engine, model, one_for_all, less)
    starts = engine.criteria.shape_starts
    begun = [np.where(shapes, start * model.prior_sigma, model.values) for start in starts]
    return engine.fit(model.with_values(begun[0]), starts=begun[1:], less=less)


def _with_one_shape_for_all(engine: Engine, model: Model, shapes: NDArray[np.bool_], less: Floats | None) -> Fitted:
    """Fit a model whose effects share their shapes among elements: one is held, each value a fit of its own.

    Where an effect has two shapes, as a spike at reversals has its time and its travel, the second follows the
    first: moved together, a spike that lasts was also one that takes millimetres to rise.
    """
    model, names = model.with_free(model.free & ~shapes), [each.name for each in model.parameters()]
    best: Fitted | None = None
    for name in dict.fromkeys(each for each, is_shape in zip(names, shapes, strict=True) if is_shape):
        at = shapes & (np.array(names) == name)
        start = model if best is None else best.model
        held = (np.where(at, each * model.prior_sigma, start.values) for each in engine.criteria.shapes_for_all)
        found = _best_fit(engine, (start.with_values(each) for each in held), less)
        best = found if best is None or found.linear.log_evidence > best.linear.log_evidence else best
    assert best is not None
    return best


def _best_fit(engine: Engine, models: Iterable[Model], less: Floats | None) -> Fitted:
    """Fit several models, and return the fit of most evidence."""
    found = []
    for each in models:
        try:
            found.append(engine.fit(each, less=less))
        except RunError:
            continue
    if not found:
        raise RunError("no start of the fit succeeded")
    return max(found, key=lambda each: each.linear.log_evidence)


def _from(found: Model, model: Model) -> Model:
    """Return a model that begins where another ended, with the effects and functions that both have."""
    known = {term.effect: term for term in found.terms}

    def begun(term: Term) -> Term:
        other, own, before = known.get(term.effect), model.own(term.effect), found.own(term.effect)
        if other is None or len(other.values) != len(term.values):
            return term
        is_same = own.is_like(before) if isinstance(own, LearnedAxes) else own is before
        # At other elements than the model's the effect was there, and is not now.
        return replace(term, values=np.where(term.free, other.values, term.values)) if is_same else term

    return replace(model, terms=tuple(begun(term) for term in model.terms))


def _free_shapes(model: Model, effects: set[str]) -> NDArray[np.bool_]:
    """Return which values of a model are free shapes of some effects of the engine's, shape (size,)."""
    of = [each.is_shape and each.shape is None and each.effect in effects for each in model.parameters()]
    return np.array(of, bool) & model.free
