"""Learned causes as members of a model: fitted to all readings, so that their functions can be stated and drawn."""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb import _core
from hexdbb.diagnosis import Noise, evaluate_fit, learned_effect
from hexdbb.diagnosis.smoothing import with_bands
from hexdbb.errors import InputError, RunError
from hexdbb.model import Choice, Model
from hexdbb.samples import Samples


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
        None where there are none, or the fit does not succeed.
    """
    if not names:
        return None
    try:
        wider = model.knowing_effects([learned_effect(samples, model, each, noise) for each in names])
        for each in names:
            wider = wider.with_effect(Choice.parse(each))
        fitted, result = evaluate_fit(samples, wider, wider.free, noise, hypothesis=True)
    except (InputError, RunError):  # a variable that hardly varies, a fit without a solution: described without it
        return None
    return with_bands(fitted, result.covariance, samples), result
