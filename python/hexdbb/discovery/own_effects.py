"""Users' own effects as candidates: each is asked for its push in the samples at hand before anything rests on it."""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.effects import UserEffect, UserEffectError, sample_state, tabulate
from hexdbb.model import Model
from hexdbb.record import Record
from hexdbb.samples import knowing, samples_of


def failing_effects(records: Sequence[Record], model: Model, names: Sequence[str]) -> dict[str, UserEffectError]:
    """Give what is wrong with those of a model's own effects that cannot be used on some records.

    Parameters
    ----------
    records : sequence of Record
    model : Model
    names : sequence of str
        Effects that are asked; the engine's among them are always good.

    Returns
    -------
    dict of str to UserEffectError
        By name; the error names file and line: the function raises, or gives a wrong shape, a value that is not finite,
        or the same push in every sample.
    """
    asked = [each for name, each in model.own_effects.items() if name in names and isinstance(each, UserEffect)]
    if not asked:
        return {}
    known = knowing(model, records)
    state = sample_state(samples_of(records, known), known.machine)
    failed = {}
    for each in asked:
        for error in tabulate([each], state)[1]:
            failed[each.name] = error
    return failed
