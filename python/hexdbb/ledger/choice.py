"""Models with an effect more or less, before anything is fitted.

A choice is an effect's name, or a name and the elements meant: ``pitch_cyclic``, ``backlash:4``, ``backlash:2:4``.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.model import Model, Term, new_term, split_choice


def with_effect(model: Model, choice: str) -> Model:
    """Give a model that has an effect too: new values are zero, those of the elements chosen free, others held.

    Where the model has the effect, the elements chosen become free.

    Raises
    ------
    InputError
        An effect or element that is not known, or that the model has free already.
    """
    effect, elements = split_choice(choice)
    chosen = _chosen(model, effect, elements)
    present = _term(model, effect)
    if present is None:
        term = replace(new_term(effect, len(chosen)), free=chosen)
        return replace(model, terms=(*model.terms, term))
    if present.free[chosen].all():
        raise InputError(f"{choice}: {model.name} has it already, free to be fitted (expected what it has not)")
    return _with_term(model, replace(present, free=present.free | chosen))


def held_at_zero(model: Model, choice: str) -> Model:
    """Give a model without an effect, or with some elements of it held at zero; the last one takes the effect away.

    Raises
    ------
    InputError
        An effect or element that is not known, or that the model does not have.
    """
    effect, elements = split_choice(choice)
    chosen = _chosen(model, effect, elements)
    term = _term(model, effect)
    if term is None or not (term.free[chosen] | (term.values[chosen] != 0.0)).any():
        raise InputError(f"{choice}: not in {model.name} (expected one of {', '.join(_free_effects(model))})")
    left = Term(
        effect,
        free=term.free & ~chosen,
        values=np.where(chosen, 0.0, term.values),
        sigma=np.where(chosen, np.nan, term.sigma),
        identifiable=term.identifiable & ~chosen,
    )
    if left.free.any() or left.values.any():
        return _with_term(model, left)
    return replace(model, terms=tuple(each for each in model.terms if each.effect != effect))


def _chosen(model: Model, effect: str, elements: tuple[str, ...]) -> NDArray[np.bool_]:
    """Mask of the effect's own values, shape (size,)."""
    info = model.info(effect)
    for element in elements:
        if element not in info.elements:
            known = ", ".join(info.elements)
            raise InputError(f'{effect}:{element}: {effect} has no element "{element}" (expected one of {known})')
    meant = elements or tuple(info.elements)
    return np.array([element in meant for element in info.elements for _ in info.parameters], dtype=bool)


def _term(model: Model, effect: str) -> Term | None:
    return next((term for term in model.terms if term.effect == effect), None)


def _with_term(model: Model, term: Term) -> Model:
    return replace(model, terms=tuple(term if each.effect == term.effect else each for each in model.terms))


def _free_effects(model: Model) -> list[str]:
    return [term.effect for term in model.terms if term.free.any()]
