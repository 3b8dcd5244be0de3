"""Sufficiency of a trial: the forms of the effects in the model count.

The question is a diagnosis' own (`hexdbb.diagnosis.sufficiency`); asked of a trial, its residual has the discrepancies
explained, and what the forms of the effects in the model may leave by their prior does not matter: an effect whose form
differs is no new cause.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import JudgingNoise, Sufficiency, explains_changes
from hexdbb.diagnosis.lack_of_fit import FitTest
from hexdbb.diagnosis.noise import residual_repeats_to
from hexdbb.diagnosis.sufficiency import default_matters_um, explained_um
from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.fit.trial import Trial
from hexdbb.evidence.fit.trials import Trials
from hexdbb.samples import Samples, predict

Floats = NDArray[np.float64]
FORM_STEPS = 4
"""Sizes tried of what changes from reading to reading, evenly up to the largest that forms have: a variance that is
off by a quarter is a standard deviation off by an eighth, half of what laps may be off (`UNSTEADY`)."""


def repeats_but_for_forms(trial: Trial, trials: Trials, judging: JudgingNoise) -> bool:
    """Check that what differs from lap to lap is explained where the forms of the effects in the model are.

    A drift off its formula leaves a part of itself that no lap shares with the next, and is known all the same; so is
    an effect whose size differs from reading to reading, as of a gauge that is read late when the bus is free.
    """
    engine, linear = trials.engine, trials.linear(trial)
    noise_mm = float(np.mean(engine.row_noise_mm))
    of_rows = replace(judging, noise=replace(judging.noise, sigma_mm=noise_mm))
    residual_mm = linear.residual * engine.row_noise_mm
    if explains_changes(engine.part, residual_mm, of_rows):
        return True
    push = trials.pushed(trial)
    parts = np.linspace(0.0, trials.criteria.form_variance, FORM_STEPS + 1)[1:]
    return any(_changes_with(push, part, engine.part, residual_mm, of_rows) for part in parts)


def _changes_with(push: Floats, part: float, samples: Samples, residual_mm: Floats, judging: JudgingNoise) -> bool:
    """Check that laps repeat as well as is stated, but for a part of what an effect pushes.

    The variance that grows with the push must describe the differences better than one for all readings does.
    """
    larger = np.sqrt(1.0 + part * push**2)
    if not explains_changes(samples, residual_mm / larger, judging):
        return False
    alike, scaled = (residual_repeats_to(samples, each) for each in (residual_mm, residual_mm / larger))
    return bool(np.log(scaled) + np.mean(np.log(larger)) < np.log(alike))


def left_over(trial: Trial, trials: Trials, criteria: Criteria, matters_um: float | None = None) -> Sufficiency:
    """Judge what a trial leaves."""
    engine, linear = trials.engine, trials.linear(trial)
    noise = replace(engine.noise, sigma_mm=float(np.mean(engine.row_noise_mm)))
    strength = np.linalg.eigvalsh(linear.own.T @ linear.own)
    fitted = float(np.sum(strength / (1.0 + strength)))
    lack = FitTest(engine.part, noise).of(linear.residual * engine.row_noise_mm, round(fitted))
    if matters_um is None:
        matters_um = default_matters_um(
            engine.noise.sigma_mm * 1e3,
            explained_um(engine.part, engine.base, predict(engine.part, engine.base).residual_mm),
        )
    # The variance below which the search looks for no further cause: to ask for one there would never end.
    by_form = criteria.form_variance * trials.explained_before
    form_um = float(np.sqrt(by_form)) * lack.noise_um
    return Sufficiency(lack, max(matters_um, form_um))
