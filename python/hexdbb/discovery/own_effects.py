"""Users' own effects as candidates: each is evaluated for the samples at hand before anything rests on it."""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.effects import UserEffect, same_effects
from hexdbb.model import Model
from hexdbb.samples import Samples


def require_usable_effects(samples: Samples, model: Model, names: Sequence[str]) -> None:
    """Check that those of a model's own effects that are to compete can be used on some samples.

    Parameters
    ----------
    samples : Samples
    model : Model
    names : sequence of str
        Effects to check; the engine's among them are always good.

    Raises
    ------
    UserEffectError
        Naming file and line of the first that is wrong: the function raises, or returns a wrong shape, a value that is
        not finite, the same push in every sample, or the push of another effect.
    """
    asked = [each for name, each in model.own_effects.items() if name in names and isinstance(each, UserEffect)]
    for each in asked:
        each.require_usable(samples)
    for error in same_effects(asked, samples).values():
        raise error
