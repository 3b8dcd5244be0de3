"""Learned causes as members of a model: fitted to all readings, so that their functions can be stated and drawn."""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb import _core
from hexdbb.diagnosis import Noise, evaluate_fit, learned_effect
from hexdbb.diagnosis.smoothing import with_bands
from hexdbb.errors import InputError, RunError
from hexdbb.learned import Hypothesis
from hexdbb.model import Choice, Model
from hexdbb.samples import Samples


def can_learn(name: str) -> bool:
    """Check whether a model can hold a hypothesis: instants and periods found in the readings it cannot."""
    try:
        Hypothesis.parse(name)
    except InputError:
        return False
    return True


def with_learned(
    samples: Samples, model: Model, names: Sequence[str], noise: Noise
) -> tuple[Model, _core.FitResult] | None:
    """Fit a model with learned effects beside its own.

    Parameters
    ----------
    samples : Samples
    model : Model
        Fitted to them.
    names : sequence of str
        As `hexdbb add` takes them.
    noise : Noise

    Returns
    -------
    tuple of Model and FitResult, or None
        None where there is none that a model can hold, or the fit does not succeed.
    """
    possible = [each for each in names if can_learn(each)]
    if not possible:
        return None
    try:
        wider = model.knowing_effects([learned_effect(samples, model, each, noise) for each in possible])
        for each in possible:
            wider = wider.with_effect(Choice.parse(each))
        fitted, result = evaluate_fit(samples, wider, wider.free, noise, hypothesis=True)
    except (InputError, RunError):  # a variable that hardly varies, a fit without a solution: described without it
        return None
    return with_bands(fitted, result.covariance, samples), result
