"""Fits that a model's ledger keeps: its free values fitted, effects added to it and removed from it.

Before and after an effect are both fits to the same readings, so that the fall is the effect's doing and not that of a
fit that was stale. Circles held out of both fits say whether it holds where it was not fitted.
"""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import Diagnosis, Refit, as_it_is, diagnose, learned_effect, noise_of, refitter, space_of
from hexdbb.learned.places import is_learned
from hexdbb.ledger.step import sizes_of, with_step
from hexdbb.model import Choice, Model
from hexdbb.samples import Samples, predict
from hexdbb.samples.unmeasured import require_judged
from hexdbb.threads import one_thread

Floats = NDArray[np.float64]
AsItIs = tuple[Model, Floats, Refit]

_last: WeakKeyDictionary[Samples, tuple[Model, bool, AsItIs]] = WeakKeyDictionary()
"""The model that the last change to some samples began from, with its fit."""


@one_thread
def fit_model(samples: Samples, model: Model, *, robust: bool = False, check_held_out: bool = True) -> Diagnosis:
    """Fit a model's free effects to samples and enter that into its ledger.

    Parameters, returns and errors are those of `hexdbb.diagnosis.diagnose`; the ledger of the diagnosis' model has one
    step more.
    """
    found = diagnose(samples, model, robust=robust, check_held_out=check_held_out)
    return with_step("diagnose", model, found.residual_before_mm, found)


@one_thread
def add_effect(samples: Samples, model: Model, choice: str, *, robust: bool = False) -> Diagnosis:
    """Add an effect to a model and fit everything that is free.

    Parameters
    ----------
    samples : Samples
        Of the model's machine; mounts it does not know become known.
    model : Model
    choice : str
        ``pitch_cyclic``, ``backlash:4``, ``backlash:2:4``: an effect, or some of its elements; the others' values are
        held at zero. Elements of an effect the model has are freed.
    robust : bool
        Let readings far off (a gauge glitch) count less.

    Returns
    -------
    Diagnosis
        Of the fit with the effect. Its `model` has one step more in its ledger, which says what was gained; its errors
        before are those of the model without the effect, fitted to the same readings.

    Raises
    ------
    InputError
        What `Model.with_effect` and `hexdbb.diagnosis.diagnose` refuse.
    RunError
        Where a fit did not end in a usable solution.
    """
    added = Choice.parse(choice)
    _require_addable(samples, model, added)  # refused before anything is computed
    base, before_mm, refit = _fitted_as_it_is(samples, model, robust)
    if is_learned(added.effect) and base.own(added.effect) is None:
        base = base.knowing_effects([learned_effect(samples, base, added.effect)])
    found = diagnose(samples, base.with_effect(added), robust=robust, against=(base, refit))
    return with_step("add", model, before_mm, found, added, sizes_of(found.model, added))


@one_thread
def remove_effect(samples: Samples, model: Model, choice: str, *, robust: bool = False) -> Diagnosis:
    """Remove an effect, or some elements of it, from a model and fit everything that is free.

    Parameters, returns and errors are those of `add_effect`; the step's sizes are the values that were removed.
    """
    removed = Choice.parse(choice)
    model.with_mounts(samples.mounts).without_effect(removed)  # refused before anything is computed
    base, before_mm, refit = _fitted_as_it_is(samples, model, robust)
    found = diagnose(samples, base.without_effect(removed), robust=robust, against=(base, refit))
    return with_step("remove", model, before_mm, found, removed, sizes_of(base, removed))


def _require_addable(samples: Samples, model: Model, added: Choice) -> None:
    if is_learned(added.effect) and model.own(added.effect) is None:
        space_of(samples, model, added.effect)
    else:
        model.with_mounts(samples.mounts).with_effect(added)
    require_judged(samples.unmeasured, model, added.effect, samples.name)


def _fitted_as_it_is(samples: Samples, model: Model, robust: bool) -> AsItIs:
    """Fit a model without the change, or return the fit where the last change to these samples began from it too.

    Of several functions that may describe a form each is added to the same model, to see which predicts.
    """
    last = _last.get(samples)
    if last is None or last[0] is not model or last[1] != robust:
        last = _last[samples] = model, robust, _as_it_is(samples, model, robust)
    return last[2]


def _as_it_is(samples: Samples, model: Model, robust: bool) -> AsItIs:
    """Fit a model: the model, its residual, and how it is fitted to some of the circles.

    A model with nothing free stays as it is.
    """
    if model.free.any():
        base = diagnose(samples, model, robust=robust, check_held_out=False)
        return base.model, base.residual_mm, _once(refitter(noise_of(samples), robust))
    known = model.with_mounts(samples.mounts)
    return known, predict(samples, known).residual_mm, as_it_is


def _once(refit: Refit) -> Refit:
    """Return a function that fits a model to the same part of the samples once."""
    known: dict[tuple[int, bytes], tuple[Model, Model]] = {}

    def refitted(samples: Samples, model: Model) -> Model:
        key = id(model), samples.row_numbers.tobytes()
        if key not in known:
            known[key] = model, refit(samples, model)  # the model is kept, lest another gets its id
        return known[key][1]

    return refitted
