"""The step that a fit adds to a model's ledger: what fell, on which readings, and the model before it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import Diagnosis
from hexdbb.model import Choice, LearnedEffect, LedgerStep, Model, Size, Term
from hexdbb.units import shown_factor, shown_unit

UM_PER_MM = 1e3


def with_step(
    what: str,
    model: Model,
    before_mm: NDArray[np.float64],
    found: Diagnosis,
    choice: Choice | None = None,
    sizes: tuple[Size, ...] = (),
) -> Diagnosis:
    """Return a diagnosis whose model has one step more in its ledger.

    Parameters
    ----------
    what : str
        ``diagnose``, ``add`` or ``remove``.
    model : Model
        Before the step.
    before_mm : ndarray, shape (n,)
        Residual before the step, of the samples of `found`.
    found : Diagnosis
        Of the model after the step.
    choice : Choice, optional
        The effect added or removed, or some of its elements.
    sizes : tuple of Size
        Its values.
    """
    checked, records = found.held_out, found.samples.records
    kind = ""
    if choice is not None:  # a learned effect is known to the model that has it
        has_it = model if found.model.term(choice.effect) is None else found.model
        kind = has_it.info(choice.effect).element_kind
    step = LedgerStep(
        step=len(model.ledger) + 1,
        what=what,
        effect="" if choice is None else choice.effect,
        elements=() if choice is None else choice.elements,
        element_kind=kind,
        sizes=sizes,
        rms_before_um=_rms_um(before_mm),
        rms_after_um=_rms_um(found.residual_mm),
        peak_to_valley_before_um=float(np.ptp(before_mm)) * UM_PER_MM,
        peak_to_valley_after_um=float(np.ptp(found.residual_mm)) * UM_PER_MM,
        heldout_before_um=None if checked is None else checked.before_um,
        heldout_after_um=None if checked is None else checked.after_um,
        heldout_peak_to_valley_before_um=None if checked is None else checked.peak_to_valley_before_um,
        heldout_peak_to_valley_after_um=None if checked is None else checked.peak_to_valley_after_um,
        records=tuple(record.name for record in records),
        record_hashes=tuple(record.content_hash() for record in records),
        before=model.snapshot,
    )
    return replace(found, model=replace(found.model, ledger=(*model.ledger, step)))


def sizes_of(model: Model, choice: Choice) -> tuple[Size, ...]:
    """Return the values of an effect's elements, in their units of output."""
    parameters, values, sigmas = model.parameters(), model.values, model.sigma
    term = model.term(choice.effect)
    if term is not None and term.learned is not None:
        return _sizes_of_learned(term.learned, term)
    sizes = []
    for index in np.flatnonzero(model.values_of(choice)):
        parameter, factor = parameters[index], shown_factor(parameters[index].unit)
        sigma = None if np.isnan(sigmas[index]) else float(sigmas[index]) * factor
        value = float(values[index]) * factor
        sizes.append(Size(parameter.element, parameter.name, value, sigma, shown_unit(parameter.unit)))
    return tuple(sizes)


def _sizes_of_learned(effect: LearnedEffect, term: Term) -> tuple[Size, ...]:
    """Return how far each function varies, with the median of its band."""
    element = effect.info().elements[0]
    sizes = []
    for number, curve in enumerate(effect.curves(term.values)):
        name = "range" if len(curve.at) > 1 else "size"
        value = float(np.ptp(curve.value_mm)) if len(curve.at) > 1 else float(curve.value_mm[0])
        sigma = float(np.median(curve.sigma_mm)) * UM_PER_MM
        named = "_".join(filter(None, (name, effect.space.hypothesis.part_name(number))))
        sizes.append(Size(element, named, value * UM_PER_MM, None if np.isnan(sigma) else sigma, "um"))
    return tuple(sizes)


def _rms_um(residual_mm: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(residual_mm**2))) * UM_PER_MM
