"""Users' own effects as candidates: each is evaluated for the samples at hand before anything rests on it."""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.effects import UserEffect
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
        not finite, or the same push in every sample.
    """
    for name, each in model.own_effects.items():
        if name in names and isinstance(each, UserEffect):
            each.require_usable(samples)
