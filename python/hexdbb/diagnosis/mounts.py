"""Set-ups a model has not seen: where the cups of a record's mounts stand, found with all else held."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hexdbb import _core
from hexdbb.diagnosis.fit import evaluate_fit
from hexdbb.diagnosis.noise import noise_of
from hexdbb.model import Model, MountKey, new_term
from hexdbb.record import Record
from hexdbb.samples import unseen_mounts
from hexdbb.units import shown_factor, shown_unit


def fit_mounts(record: Record, model: Model) -> tuple[Model, list[str]]:
    """Find where the cups of mounts stand that a model has not seen, holding all else: a set-up, not the machine.

    Returns
    -------
    model : Model
        Knowing the record's mounts; the same object where it knew them.
    said : list of str
        What was found, one sentence a mount.
    """
    unseen = unseen_mounts(record, model)
    if not unseen:
        return model, []
    known = _with_mount_effects(model).with_mounts(unseen)
    kinds = {term.effect: known.info(term.effect).element_kind for term in known.terms}
    places = {str(known.mounts.index(key) + 1): key for key in unseen}
    free = np.array([kinds[each.effect] == "mount" and each.element in places for each in known.parameters()])
    fitted, _ = evaluate_fit([record], known, free, noise_of([record]))
    return fitted, [_sentence(record, fitted, element, key) for element, key in places.items()]


def with_mounts_fitted(records: Sequence[Record], model: Model) -> tuple[Model, list[str]]:
    """Do `fit_mounts` for several records, one after another."""
    said: list[str] = []
    for record in records:
        model, more = fit_mounts(record, model)
        said += more
    return model, said


def _with_mount_effects(model: Model) -> Model:
    present = {term.effect for term in model.terms}
    infos = [model.info(name) for name in _core.effect_names()]
    missing = [info for info in infos if info.element_kind == "mount" and info.name not in present]
    return replace(model, terms=(*model.terms, *(new_term(info.name, 0) for info in missing)))


def _sentence(record: Record, model: Model, element: str, key: MountKey) -> str:
    moved = [
        f"{parameter.name} {value * shown_factor(parameter.unit):+.1f} {shown_unit(parameter.unit)}"
        for parameter, value in zip(model.parameters(), model.values, strict=True)
        if model.info(parameter.effect).element_kind == "mount" and parameter.element == element
    ]
    return f"{record.name}: mount {key.mount_id} is new to the model; its cup was fitted first: {', '.join(moved)}"
