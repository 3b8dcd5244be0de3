"""Users' own effects as candidates: each is evaluated for the samples at hand before anything rests on it."""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.effects import UserEffect, UserEffectError, same_effects
from hexdbb.model import Model
from hexdbb.samples import Samples


def failing_effects(samples: Samples, model: Model, names: Sequence[str]) -> dict[str, UserEffectError]:
    """Return what is wrong with those of a model's own effects that cannot be used on some samples.

    Parameters
    ----------
    samples : Samples
    model : Model
    names : sequence of str
        Effects to check; the engine's among them are always good.

    Returns
    -------
    dict of str to UserEffectError
        By name; the error names file and line: the function raises, or returns a wrong shape, a value that is not
        finite, the same push in every sample, or the push of another effect.
    """
    failed = {}
    for name, each in model.own_effects.items():
        if name in names and isinstance(each, UserEffect):
            try:
                each.require_usable(samples)
            except UserEffectError as error:
                failed[name] = error
    usable = [each for name, each in model.own_effects.items() if name in names and isinstance(each, UserEffect)]
    return failed | same_effects([each for each in usable if each.name not in failed], samples)
