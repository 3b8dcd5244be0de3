"""Effects added to a model and taken away, everything free fitted again, and what that did to the error.

Before and after are both fits to the same readings, so that the fall is the effect's doing and not that of a fit that
was stale. Circles left out of both fits say whether it holds where it was not made.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import Diagnosis, diagnose, ledger_step, noise_of, refitter
from hexdbb.diagnosis.heldout import Refit, as_it_is
from hexdbb.errors import InputError
from hexdbb.ledger.choice import held_at_zero, with_effect
from hexdbb.model import Model, Size, split_choice
from hexdbb.record import Record
from hexdbb.samples import knowing, residual_mm
from hexdbb.units import shown_factor, shown_unit

Floats = NDArray[np.float64]


def add_effect(
    records: Sequence[Record], model: Model, choice: str, *, robust: bool = False
) -> tuple[Model, Diagnosis]:
    """Add an effect to a model and fit everything that is free.

    Parameters
    ----------
    records : sequence of Record
        Of the model's machine; mounts it does not know become known.
    model : Model
    choice : str
        ``pitch_cyclic``, ``backlash:4``, ``backlash:2:4``: an effect, or some of its elements; the others' values are
        held at zero. Elements of an effect the model has are freed.
    robust : bool
        Let readings far off (a gauge glitch) count less.

    Returns
    -------
    model : Model
        Fitted; the last step of its ledger says what was gained.
    diagnosis : Diagnosis
        Of this fit; its errors before are those of the model without the effect, fitted to the same readings.

    Raises
    ------
    InputError
        What `with_effect` and `hexdbb.diagnosis.diagnose` refuse.
    RunError
        Where a fit did not end in a usable solution.
    """
    with_effect(knowing(model, records), choice)  # refuse before anything is computed
    base, before_mm, refit = _fitted_as_it_is(records, model, robust)
    found = diagnose(records, with_effect(base, choice), robust=robust, against=(base, refit))
    return _with_step("add", model, records, choice, before_mm, found, _sizes(found.model, choice))


def remove_effect(
    records: Sequence[Record], model: Model, choice: str, *, robust: bool = False
) -> tuple[Model, Diagnosis]:
    """Take an effect, or some elements of it, out of a model and fit everything that is free.

    Parameters and returns are those of `add_effect`; the step's sizes are the values that were taken away.

    Raises
    ------
    InputError
        What `held_at_zero` and `hexdbb.diagnosis.diagnose` refuse.
    RunError
        Where a fit did not end in a usable solution.
    """
    held_at_zero(knowing(model, records), choice)  # refuse before anything is computed
    base, before_mm, refit = _fitted_as_it_is(records, model, robust)
    found = diagnose(records, held_at_zero(base, choice), robust=robust, against=(base, refit))
    return _with_step("remove", model, records, choice, before_mm, found, _sizes(base, choice))


def _fitted_as_it_is(records: Sequence[Record], model: Model, robust: bool) -> tuple[Model, Floats, Refit]:
    """Fit a model without the change: the model, its residuals, and how it is fitted to some of the circles.

    A model with nothing free stands as it is.
    """
    if not records:
        raise InputError("no record to fit to (expected at least one)")
    if model.free.any():
        base = diagnose(records, model, robust=robust, check_held_out=False)
        fitted = replace(base.model, ledger=model.ledger)
        return fitted, base.residual_mm, refitter(noise_of(records), robust)
    known = knowing(model, records)
    return known, residual_mm(records, known), as_it_is


def _with_step(
    what: str,
    model: Model,
    records: Sequence[Record],
    choice: str,
    before_mm: Floats,
    found: Diagnosis,
    sizes: tuple[Size, ...],
) -> tuple[Model, Diagnosis]:
    effect, elements = split_choice(choice)
    step = ledger_step(what, model, records, (before_mm, found.residual_mm), found.held_out, effect, elements, sizes)
    changed = replace(found.model, ledger=(*model.ledger, step))
    return changed, replace(found, model=changed)


def _sizes(model: Model, choice: str) -> tuple[Size, ...]:
    """Values of the elements chosen, in the units shown."""
    effect, elements = split_choice(choice)
    sizes = []
    for parameter, value, sigma in zip(model.parameters(), model.values, model.sigma, strict=True):
        if parameter.effect == effect and (not elements or parameter.element in elements):
            factor = shown_factor(parameter.unit)
            known = None if np.isnan(sigma) else float(sigma) * factor
            unit = shown_unit(parameter.unit)
            sizes.append(Size(parameter.element, parameter.name, float(value) * factor, known, unit))
    return tuple(sizes)
