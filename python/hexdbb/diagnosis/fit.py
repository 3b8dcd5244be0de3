"""Fitting a model to samples: the engine's least squares, and its outcome in words."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis.extrapolation import expected_error
from hexdbb.diagnosis.glitches import glitches_in, glitches_sentence
from hexdbb.diagnosis.heldout import Refit, as_it_is, held_out
from hexdbb.diagnosis.judging import judging_noise
from hexdbb.diagnosis.mirror import settle_signs
from hexdbb.diagnosis.noise import Noise, noise_of
from hexdbb.diagnosis.result import Diagnosis, unknown_directions
from hexdbb.diagnosis.sanity import warnings_of
from hexdbb.diagnosis.shaping import fit_shapes
from hexdbb.diagnosis.smoothing import with_bands
from hexdbb.diagnosis.sufficiency import Sufficiency, assess_sufficiency
from hexdbb.errors import InputError, RunError
from hexdbb.identifiability import KNOWN_PART, Displacements, sentences
from hexdbb.model import Model
from hexdbb.samples import Samples, predict
from hexdbb.samples.places import with_places_free
from hexdbb.samples.unmeasured import not_measured_sentences, with_judged_free

NO_ACTION = 1e-9
"""An effect whose values keep their prior standard deviations to this relative part acts on no reading: rounding of the
covariance stays some orders below."""
GLITCH_SIGMAS = 3.0
"""With a robust loss, residuals beyond this many standard deviations of the noise count linearly: one in 370 of normal
noise, so that clean readings lose next to nothing."""
PRIOR_DOMINATED = 0.99
"""Posterior over prior standard deviation above which readings say nothing of a value: less than 2 % of information."""


def evaluate_fit(
    samples: Samples,
    model: Model,
    free: NDArray[np.bool_],
    noise: Noise,
    *,
    robust: bool = False,
    hypothesis: bool = False,
    from_minimum: bool = False,
) -> tuple[Model, _core.FitResult]:
    """Fit chosen values of a model, no more: no held-out circles, no words.

    Parameters
    ----------
    samples : Samples
        Of mounts the model knows.
    model : Model
        Start of the fit.
    free : ndarray of bool, shape (size,)
    noise : Noise
    robust : bool
        Huber's loss beyond `GLITCH_SIGMAS`.
    hypothesis : bool
        A fit that only serves to compare models: it ends sooner, and its covariance is to first order.
    from_minimum : bool
        Of a hypothesis: the start was fitted to nearly the same readings, and the values at the minimum near it are
        wanted, without uncertainties: they stay those of the start.

    Raises
    ------
    InputError
        Records of another machine, or a sample the machine cannot reach.
    RunError
        Where the fit did not end in a usable solution.
    """

    def fit(start: Model, from_minimum: bool = False) -> _core.FitResult:
        try:
            result = _core.fit(
                samples.engine(start),
                samples.block(start),
                samples.reading_mm,
                noise_mm=noise.sigma_mm,
                free=[bool(each) for each in free],
                robust_mm=GLITCH_SIGMAS * noise.sigma_mm if robust else 0.0,
                sweep=samples["sweep"],
                hypothesis=hypothesis,
                from_minimum=from_minimum,
                covariance=not from_minimum,
            )
        except ValueError as error:
            raise InputError(f"{samples.name}: {error}") from None
        if not result.usable:
            raise RunError(f"{samples.name}: the fit did not succeed: {result.termination}")
        return result

    if (free & model.shaped).any():
        return _with_spread(*fit_shapes(samples, model, free, noise, fit))
    result = fit(model, from_minimum)
    fitted = model.with_values(np.where(model.shaped, model.values, result.values))
    return (fitted, result) if from_minimum else _with_spread(fitted, result)


@dataclass(frozen=True, eq=False)
class Fit:
    """A model's free values fitted, before anything is said of them.

    Attributes
    ----------
    samples : Samples
        What was fitted to: all that were given but those that stand alone.
    known : Model
        The start, with the mounts of the samples.
    model : Model
        With the fitted values.
    noise : Noise
        Of one reading.
    first, result : FitResult
        Of the engine: from the start; from where the signs that the readings leave open were settled.
    either_sign : tuple of str
        Values that are as good with the other sign, in sentences.
    left_out : str or None
        How many readings stand alone, in a sentence.
    alone : ndarray of bool, shape (n,), or None
        Readings that stand alone in what the fit leaves, against `noise`; None where they were not looked for.
    """

    samples: Samples
    known: Model
    model: Model
    noise: Noise
    first: _core.FitResult
    result: _core.FitResult
    either_sign: tuple[str, ...]
    left_out: str | None = None
    alone: NDArray[np.bool_] | None = None

    def assess_sufficiency(self) -> Sufficiency:
        """Judge what the fit leaves, against the noise that models of these samples are judged by."""
        judged = judging_noise(self.samples, self.noise)
        alone = self.alone if judged.noise == self.noise else None
        return assess_sufficiency(self.samples, self.model, self.result.residual_mm, noise=judged, alone=alone)


def fit_free(samples: Samples, model: Model, *, robust: bool = False) -> Fit:
    """Fit a model's free effects to samples and say no more of it; parameters and errors are those of `diagnose`."""
    model = with_places_free(samples.records, with_judged_free(samples.unmeasured, model))
    if not model.free.any():
        raise InputError("the model has no free value (expected at least one to fit)")
    _require_distinct(samples)
    known = model.with_mounts(samples.mounts)
    fit = _fit(samples, known, robust)
    if robust:
        return fit
    residual_mm = fit.result.residual_mm
    alone = glitches_in(samples, residual_mm, fit.noise.sigma_mm)
    if not alone.any():
        return replace(fit, alone=alone)
    told = glitches_sentence(samples, residual_mm, alone)
    return replace(_fit(samples.part(~alone), known, robust), left_out=told)


def _fit(samples: Samples, known: Model, robust: bool) -> Fit:
    noise = noise_of(samples)
    first = evaluate_fit(samples, known, known.free, noise, robust=robust)
    (fitted, result), either_sign = settle_signs(
        samples, first, lambda start: evaluate_fit(samples, start, start.free, noise, robust=robust), noise.sigma_mm
    )
    fitted = with_bands(fitted, result.covariance, samples)
    _require_determined(fitted, result, samples)
    return Fit(samples, known, fitted, noise, first[1], result, tuple(either_sign))


def diagnose(
    samples: Samples,
    model: Model,
    *,
    robust: bool = False,
    check_held_out: bool = True,
    against: tuple[Model, Refit] | None = None,
) -> Diagnosis:
    """Fit a model's free effects to samples. The model's ledger stays as it is (`hexdbb.ledger.fit_model` writes it).

    Readings that stand alone (`hexdbb.diagnosis.glitches`) are left out, unless a robust fit is asked for.

    Parameters
    ----------
    samples : Samples
        Every mount counts as one fixing of the cup, with a position of its own.
    model : Model
        Start of the fit.
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
        Records of another machine or one of them twice, nothing free, a sample the machine cannot reach, readings that
        determine nothing.
    RunError
        Where the fit did not end in a usable solution.
    """
    fit = fit_free(samples, model, robust=robust)
    samples, known, fitted, noise, result = fit.samples, fit.known, fit.model, fit.noise, fit.result
    after = (fitted, refitter(noise, robust))
    checked = held_out(samples, against or (known, as_it_is), after) if check_held_out else None
    expected = None if checked is None else expected_error(samples, fitted, result.noise_mm * 1e3)
    enough = fit.assess_sufficiency()
    parameters = known.parameters()
    judged = [column for column in result.free_columns if not parameters[column].is_coefficient]
    unknown = unknown_directions(result.covariance, known, judged)
    displaced = Displacements.of(samples, known).of_values(judged)
    return Diagnosis(
        samples=samples,
        model=fitted,
        rms_before_um=fit.first.rms_before_mm * 1e3,
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
        residual_before_mm=predict(samples, known).residual_mm,
        residual_mm=result.residual_mm,
        held_out=checked,
        unidentifiable=tuple(sentences(unknown, [parameters[each] for each in judged], displaced)),
        warnings=(
            *not_measured_sentences(samples.records),
            *([] if fit.left_out is None else [fit.left_out]),
            *fit.either_sign,
            *warnings_of(fitted, result, enough, checked, expected),
        ),
        sufficiency=enough,
    )


def refitter(noise: Noise, robust: bool = False) -> Refit:
    """Return a function that fits a model's free values, fitted to more samples, to some of them."""

    def refit(samples: Samples, model: Model) -> Model:
        fit = evaluate_fit(samples, model, model.free, noise, robust=robust, hypothesis=True, from_minimum=True)
        return fit[0]

    return refit


def _require_distinct(samples: Samples) -> None:
    seen: dict[str, str] = {}
    for record in samples.records:
        content = record.content_hash()
        if content in seen:
            raise InputError(f"{record.name}: the same readings as {seen[content]} (expected each record once)")
        seen[content] = record.name


def _require_determined(model: Model, result: _core.FitResult, samples: Samples) -> None:
    spread, prior = np.sqrt(np.diag(result.covariance)), model.prior_sigma
    parameters = model.parameters()
    for effect in dict.fromkeys(parameters[column].effect for column in result.free_columns):
        own = [column for column in result.free_columns if parameters[column].effect == effect]
        # Curvature can widen a value that the readings hardly determine beyond its prior; one that acts nowhere
        # keeps it.
        if (np.abs(spread[own] - prior[own]) < NO_ACTION * prior[own]).all():
            raise InputError(
                f"{samples.name}: {effect} acts nowhere in these readings (expected to hold it: --fix {effect})"
            )
    if (spread > PRIOR_DOMINATED * prior)[result.free_columns].all():
        raise InputError(f"{samples.name}: rank 0: the readings determine no free value (expected one at least)")


def _with_spread(model: Model, result: _core.FitResult) -> tuple[Model, _core.FitResult]:
    """Return a fitted model with the uncertainties of its fit, and the fit."""
    spread = np.sqrt(np.diag(result.covariance))
    identifiable = spread <= KNOWN_PART * model.prior_sigma
    held = np.ones(len(spread), bool)
    held[result.free_columns] = False
    sigma = np.where(held, model.sigma, np.where(identifiable, spread, np.nan))
    return model.with_values(model.values, sigma, np.where(held, model.identifiable, identifiable)), result
