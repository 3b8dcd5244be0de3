"""Fitting a model to records: the engine's least squares, and what it says put into words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis.extrapolation import foretold
from hexdbb.diagnosis.heldout import Refit, as_it_is, held_out
from hexdbb.diagnosis.mirror import settle_signs
from hexdbb.diagnosis.noise import Noise, noise_of
from hexdbb.diagnosis.result import Diagnosis, prior_sigmas, unknown_directions
from hexdbb.diagnosis.sanity import warnings_of
from hexdbb.diagnosis.step import ledger_step
from hexdbb.errors import InputError, RunError
from hexdbb.measured import Measured, measured
from hexdbb.model import Model
from hexdbb.prediction import knowing, residual_mm
from hexdbb.record import Record
from hexdbb.redundancy import KNOWN_PART, sentences

Floats = NDArray[np.float64]

NOWHERE = 1e-9
"""An effect whose values keep their expected sizes to this part acts on no reading."""
GLITCH_SIGMAS = 3.0
"""With a robust loss, residuals beyond this many standard deviations of the noise count linearly."""


def evaluate_fit(
    records: Sequence[Record] | Measured,
    model: Model,
    free: NDArray[np.bool_],
    noise: Noise,
    *,
    robust: bool = False,
    judging: bool = False,
) -> tuple[Model, _core.FitResult]:
    """Fit chosen values of a model, no more: no held-out circles, no words, no ledger.

    Parameters
    ----------
    records : sequence of Record, or Measured
        Of mounts the model knows.
    model : Model
        Start of the fit.
    free : ndarray of bool, shape (size,)
    noise : Noise
    robust : bool
        Huber's loss beyond `GLITCH_SIGMAS`.
    judging : bool
        A fit that only judges a model: it ends sooner, and its covariance is to first order.

    Raises
    ------
    InputError
        Records of another machine, or a sample the machine cannot reach.
    RunError
        Where the fit did not end in a usable solution.
    """
    taken = measured(records, model)
    try:
        result = _core.fit(
            taken.engine(model),
            taken.samples,
            taken.reading_mm,
            noise_mm=noise.sigma_mm,
            free=[bool(each) for each in free],
            robust_mm=GLITCH_SIGMAS * noise.sigma_mm if robust else 0.0,
            sweep=taken.sweep,
            hypothesis=judging,
        )
    except ValueError as error:
        raise InputError(f"{taken.names}: {error}") from None
    if not result.usable:
        raise RunError(f"{taken.names}: the fit did not succeed: {result.termination}")
    return _fitted_model(model, result), result


def diagnose(
    records: Sequence[Record],
    model: Model,
    *,
    robust: bool = False,
    check_held_out: bool = True,
    against: tuple[Model, Refit] | None = None,
) -> Diagnosis:
    """Fit a model's free effects to records.

    Parameters
    ----------
    records : sequence of Record
        Every mount counts as one fixing of the cup, with a position of its own.
    model : Model
        Start of the fit; its ledger gains a step.
    robust : bool
        Let readings far off (a gauge glitch) count less.
    check_held_out : bool
        Fit again without each group of circles in turn and predict them, where there are two circles or more.
    against : tuple of Model and callable, optional
        What the held-out circles' error is compared with: a model and how it is fitted to the other circles. The start
        as it is, where not given.

    Raises
    ------
    InputError
        No records, records of another machine, nothing free, a sample the machine cannot reach, readings that tell
        nothing.
    RunError
        Where the fit did not end in a usable solution.
    """
    if not records:
        raise InputError("no record to diagnose (expected at least one)")
    if not model.free.any():
        raise InputError("the model has no free value (expected at least one to fit)")
    _require_distinct(records)
    known = knowing(model, records)
    noise = noise_of(records)
    taken = measured(records, known)
    first = evaluate_fit(taken, known, known.free, noise, robust=robust)
    (fitted, result), either_sign = settle_signs(
        first, lambda start: evaluate_fit(taken, start, start.free, noise, robust=robust), noise.sigma_mm
    )
    _require_told(fitted, result, records)
    after = (fitted, refitter(noise, robust))
    checked = held_out(taken, against or (known, as_it_is), after) if check_held_out else None
    expected = None if checked is None else foretold(records, fitted, result.noise_mm * 1e3)
    parameters = known.parameters()
    step = ledger_step("diagnose", model, records, (residual_mm(records, known), result.residual_mm), checked)
    unknown = unknown_directions(result.covariance, known, result.free_columns)
    return Diagnosis(
        model=replace(fitted, ledger=(*model.ledger, step)),
        rms_before_um=first[1].rms_before_mm * 1e3,
        rms_after_um=result.rms_after_mm * 1e3,
        noise=noise,
        noise_um=result.noise_mm * 1e3,
        correlation=result.correlation,
        rank=result.machine.rank,
        condition=result.machine.condition,
        usable=result.usable,
        iterations=result.iterations,
        termination=result.termination,
        covariance=result.covariance,
        residual_mm=result.residual_mm,
        held_out=checked,
        unidentifiable=tuple(sentences(unknown, [parameters[column] for column in result.free_columns])),
        warnings=(*either_sign, *warnings_of(fitted, result, noise, checked, expected)),
    )


def _require_distinct(records: Sequence[Record]) -> None:
    seen: dict[str, str] = {}
    for record in records:
        content = record.content_hash()
        if content in seen:
            raise InputError(f"{record.name}: the same readings as {seen[content]} (expected each record once)")
        seen[content] = record.name


def refitter(noise: Noise, robust: bool = False) -> Refit:
    """Give a function that fits a model's free values to records."""

    def refit(records: Measured, model: Model) -> Model:
        return evaluate_fit(records, model, model.free, noise, robust=robust, judging=True)[0]

    return refit


def _require_told(model: Model, result: _core.FitResult, records: Sequence[Record]) -> None:
    spread, sizes = np.sqrt(np.diag(result.covariance)), prior_sigmas(model)
    names = ", ".join(record.name for record in records)
    parameters = model.parameters()
    for effect in dict.fromkeys(parameters[column].effect for column in result.free_columns):
        own = [column for column in result.free_columns if parameters[column].effect == effect]
        # Curvature can widen a value that the readings hardly tell beyond its expected size; one that acts nowhere
        # keeps it.
        if (np.abs(spread[own] - sizes[own]) < NOWHERE * sizes[own]).all():
            raise InputError(f"{names}: {effect} acts nowhere in these readings (expected to hold it: --fix {effect})")
    if (spread > 0.99 * sizes)[result.free_columns].all():
        raise InputError(f"{names}: rank 0: the readings say nothing about any free value (expected one at least)")


def _fitted_model(model: Model, result: _core.FitResult) -> Model:
    spread = np.sqrt(np.diag(result.covariance))
    identifiable = spread <= KNOWN_PART * prior_sigmas(model)
    sigma = np.where(identifiable, spread, np.nan)
    held = np.ones(len(sigma), bool)
    held[result.free_columns] = False
    keep = np.concatenate([np.zeros(0, bool), *(term.identifiable for term in model.terms)])
    return model.with_values(result.values, np.where(held, model.sigma, sigma), np.where(held, keep, identifiable))
