"""Undoing the last step of a model's ledger."""

from __future__ import annotations

from dataclasses import replace

from hexdbb.errors import InputError
from hexdbb.model import Model


def undo(model: Model) -> Model:
    """Return a model as it was before the last step of its ledger.

    The model's file holds every earlier state, so this can be done as often as there are steps.

    Raises
    ------
    InputError
        Where the ledger is empty, or its last step has no earlier state.
    """
    if not model.ledger:
        raise InputError(f"{model.name}: nothing to undo (expected a model with a step in its ledger)")
    last = model.ledger[-1]
    if last.before is None:
        raise InputError(
            f"{model.name}: step {last.step} ({last.what}) cannot be undone: the model before it was not kept"
            " (expected an [[earlier]] section)"
        )
    before = last.before
    return replace(model, terms=before.terms, mounts=before.mounts, ledger=model.ledger[:-1])
