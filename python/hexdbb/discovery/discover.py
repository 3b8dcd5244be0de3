"""See where the model fails, learn which effect is missing.

The way of a verdict: fit the model; test what is left against noise; screen all absent effects at once to first
order; give the best a fit of their own; ask of the winner that it explains a substantial share of what is
unexplained, or leaves only noise, and that it does so on circles it was not fitted to; look for others that explain
the same. Evidence alone never decides: with 20,000 readings everything is significant.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hexdbb import _core
from hexdbb.diagnosis import HeldOut, Noise, held_out, noise_of, refitter, stated_noise
from hexdbb.discovery.lack_of_fit import FitTest, LackOfFit
from hexdbb.discovery.next_test import next_test
from hexdbb.discovery.own_effects import failing_effects
from hexdbb.discovery.result import Candidate, Discovery, Verdict
from hexdbb.discovery.screen import Screen, Screened, screen
from hexdbb.discovery.trial import Base, fitted_base, holm, try_effect
from hexdbb.discovery.unexplained import unexplained_structure
from hexdbb.errors import InputError
from hexdbb.model import Model
from hexdbb.prediction import knowing
from hexdbb.record import Record

SHAPES = (-2.0, 2.0)
"""Shaping values are screened at these expected sizes besides zero."""
MOST_TRIED = 6
"""So many effects get a fit of their own."""
SUBSTANTIAL = 0.5
"""Share of the unexplained that an effect must explain, where structure stays beside it."""
FEW_VALUES = 3
PER_VALUE = 0.03
MOST_ASKED = 0.95
SUBSTANTIAL_LEFT_OUT = 0.3
"""The same on readings left out of the fit."""
COMPLETE = 0.97
"""Share of the unexplained that two effects together must explain, where a little structure stays."""
STRONG = 10.0
"""Fall of BIC that counts as very strong evidence (Kass and Raftery 1995)."""
SIGNIFICANT_P = 1e-3
ALIKE = 10.0
"""Effects whose chi-squares differ by less explain the readings alike."""
MOST_FOLDS = 4
UNSTEADY = 1.25
"""Noise of repeated laps over the gauge's stated noise beyond which the machine does not repeat."""
LEAST_READINGS = 200
LEAST_SWEEPS = 2

Progress = Callable[[str], None]


@dataclass(frozen=True)
class _Trial:
    candidate: Candidate
    result: _core.FitResult
    lack: LackOfFit


def discover(
    records: Sequence[Record],
    model: Model,
    candidates: Sequence[str] | None = None,
    progress: Progress = lambda _: None,
) -> Discovery:
    """Look for one missing effect.

    Parameters
    ----------
    records : sequence of Record
    model : Model
        Its free values are fitted first.
    candidates : sequence of str, optional
        Effects to try; all that are not wholly in the model where not given.
    progress : callable
        Is told what is being done.

    Returns
    -------
    Discovery

    Raises
    ------
    InputError
        Too few readings or sweeps to judge; records of another machine.
    RunError
        Where the model itself cannot be fitted.
    """
    _require_enough(records)
    known = knowing(model, records)
    noise, unsteady = _noise(records)
    progress("fitting the model as it is")
    base = fitted_base(records, known, noise)
    adjusted = _adjusted(base.model)
    test = FitTest(records, noise)
    lack = test.of(base.residual_mm, adjusted)
    progress("screening all effects")
    asked = list(candidates) if candidates is not None else absent_effects(base.model)
    failed = failing_effects(records, base.model, asked)
    names = [name for name in asked if name not in failed]
    screened = screen(records, base.model, names, noise, 1.0)
    ranked = _ranked(base, screened, names)
    trials = _try(base, [each for each in ranked if each.gain > 0.0][:MOST_TRIED], test, adjusted, progress)
    tried = sum(1 + len(screened.elements(name)) for name in screened.effects())
    trials = _sorted_trials(trials, tried)
    found = _judge(base, test, lack, trials, names, progress)
    found = replace(found, remarks=(*found.remarks, *(f"left out: {error}" for error in failed.values())))
    return _with_unsteadiness(found, base, unsteady) if unsteady is not None else found


def _ranked(base: Base, screened: Screen, names: Sequence[str]) -> list[Screened]:
    """Rank candidates by the evidence they offer, those with a shape of their own (a time constant) at several."""
    best = {name: screened.best_elements(name) for name in screened.effects()}
    shaping = [name for name in names if any(each.is_shape for each in base.model.info(name).parameters)]
    for shape in SHAPES if shaping else ():
        again = screen(base.records, base.model, shaping, base.noise, 1.0, shape)
        for name in again.effects():
            best[name] = max(best[name], again.best_elements(name), key=lambda each: each.bic_drop(again.readings))
    return sorted(best.values(), key=lambda each: -each.bic_drop(screened.readings))


def _noise(records: Sequence[Record]) -> tuple[Noise, str | None]:
    """Noise to judge by: of repeated laps where they are as steady as the gauge is stated to be, else the gauge's.

    Where laps repeat much worse than the gauge should, something is missing that no lap shares with the next; that is
    said, and what is stated counts.
    """
    repeated, stated = noise_of(records), stated_noise(records)
    if stated is None or repeated.sigma_mm < UNSTEADY * stated.sigma_mm:
        return repeated, None
    return stated, (
        f"laps repeat to {repeated.sigma_mm * 1e3:.2f} um only,"
        f" the gauge is stated to have {stated.sigma_mm * 1e3:.2f} um:"
        " something changes from lap to lap"
    )


def judging_noise(records: Sequence[Record]) -> Noise:
    """Give the noise of one reading that a model of some records is judged by."""
    return _noise(records)[0]


def _with_unsteadiness(found: Discovery, base: Base, unsteady: str) -> Discovery:
    if found.verdict != "none":
        return replace(found, remarks=(*found.remarks, unsteady))
    structure = unexplained_structure(base.records, base.model, base.residual_mm, base.noise)
    return replace(found, verdict="unknown", structure=structure, remarks=(*found.remarks, unsteady))


def absent_effects(model: Model) -> list[str]:
    """Name the effects that could be missing: known ones that the model lacks, or holds in part."""
    partly = {term.effect for term in model.terms if not term.free.all() and not np.any(term.values[~term.free])}
    wholly = {term.effect for term in model.terms} - partly
    return [name for name in (*_core.effect_names("catalogue"), *model.own_effects) if name not in wholly]


def _try(base: Base, chosen: Sequence[Screened], test: FitTest, adjusted: int, progress: Progress) -> list[_Trial]:
    trials = []
    for each in chosen:
        progress(f"trying {each.effect}")
        candidate, result = try_effect(base, each.effect, each.elements, each.shape)
        lack = test.of(result.residual_mm, adjusted + len(candidate.values))
        trials.append(_Trial(candidate, result, lack))
    return trials


def _sorted_trials(trials: Sequence[_Trial], tried: int) -> list[_Trial]:
    corrected = {each.effect: each for each in holm([trial.candidate for trial in trials], tried)}
    with_p = [replace(trial, candidate=corrected[trial.candidate.effect]) for trial in trials]
    return sorted(with_p, key=lambda trial: -trial.candidate.bic_drop)


def _judge(
    base: Base, test: FitTest, lack: LackOfFit, trials: list[_Trial], names: Sequence[str], progress: Progress
) -> Discovery:
    best = trials[0] if trials and _is_evident(trials[0].candidate) else None
    if best is None or (not lack.is_significant and best.candidate.bic_drop < 3.0 * STRONG):
        verdict: Verdict = "unknown" if lack.is_significant else "none"
        return _outcome(verdict, base, lack, trials, None)
    progress("confirming on readings left out of the fit")
    checked = _confirm(base, best.candidate)
    convincing = best.candidate.share >= _substantial(best.candidate) or not best.lack.is_significant
    holds = checked is None or checked.share(lack.noise_um) >= SUBSTANTIAL_LEFT_OUT * best.candidate.share
    if not (convincing and holds) and not (holds and _completes(base, best, test, names, progress)):
        return _outcome("unknown" if lack.is_significant else "none", base, lack, trials, checked)
    alike = [
        trial.candidate
        for trial in trials[1:]
        if best.candidate.chi_square_drop - trial.candidate.chi_square_drop < ALIKE and _is_evident(trial.candidate)
    ]
    if not alike:
        return _outcome("effect", base, lack, trials, checked)
    progress("looking for a circle that tells them apart")
    return replace(
        _outcome("ambiguous", base, lack, trials, checked),
        ambiguous_with=tuple(each.effect for each in alike),
        next_test=next_test(base, best.candidate, alike[0]),
    )


def _substantial(candidate: Candidate) -> float:
    """Share an effect must explain where structure stays: the more values it brings, the more it could anyway."""
    return min(SUBSTANTIAL + PER_VALUE * max(len(candidate.values) - FEW_VALUES, 0), MOST_ASKED)


def _is_evident(candidate: Candidate) -> bool:
    return candidate.bic_drop > STRONG and candidate.p_value < SIGNIFICANT_P


def _completes(base: Base, best: _Trial, test: FitTest, names: Sequence[str], progress: Progress) -> bool:
    """Whether a second effect beside the best one leaves only noise: two faults of one size each explain half."""
    progress("looking for a second effect beside it")
    wider = replace(base, model=best.candidate.model)
    left = [name for name in absent_effects(wider.model) if name in names]
    again = screen(base.records, wider.model, left, base.noise, 1.0)
    ranked = sorted(
        (again.best_elements(name) for name in again.effects()), key=lambda each: -each.bic_drop(again.readings)
    )
    if not ranked:
        return False
    second = fitted_base(base.records, best.candidate.model, base.noise)
    candidate, result = try_effect(second, ranked[0].effect, ranked[0].elements)
    adjusted = _adjusted(base.model) + len(best.candidate.values) + len(candidate.values)
    after = test.of(result.residual_mm, adjusted)
    together = (base.squared - float(result.residual_mm @ result.residual_mm) / base.noise.sigma_mm**2) / base.excess
    return _is_evident(candidate) and (not after.is_significant or together > COMPLETE)


def _confirm(base: Base, candidate: Candidate) -> HeldOut | None:
    fit = refitter(base.noise)
    by_circle = base.model.info(candidate.effect).element_kind not in ("circle", "set-up")
    return held_out(
        base.records,
        (base.model, fit),
        (candidate.model, fit),
        "circle" if by_circle else "sweep",
        MOST_FOLDS,
    )


def _outcome(
    verdict: Verdict, base: Base, lack: LackOfFit, trials: Sequence[_Trial], checked: HeldOut | None
) -> Discovery:
    before = lack.rms_um
    named = verdict in ("effect", "ambiguous")
    residual = trials[0].result.residual_mm if named else base.residual_mm
    model = trials[0].candidate.model if named else base.model
    left = trials[0].lack if named else lack
    structure = unexplained_structure(base.records, model, residual, base.noise) if left.is_significant else ()
    remarks = (
        ("something else is missing besides: look again once this effect is added",)
        if named and left.is_significant
        else ()
    )
    return Discovery(
        verdict=verdict,
        lack_of_fit=lack,
        rms_before_um=before,
        rms_after_um=trials[0].candidate.rms_after_um if named else before,
        heldout_before_um=None if checked is None else checked.before_um,
        heldout_after_um=None if checked is None else checked.after_um,
        candidates=tuple(trial.candidate for trial in trials),
        ambiguous_with=(),
        next_test=None,
        structure=structure,
        remarks=remarks,
    )


def _adjusted(model: Model) -> int:
    """Directions a fit can adjust, at most: a bound that keeps the test for smoothness on the safe side."""
    return int(model.free.sum())


def _require_enough(records: Sequence[Record]) -> None:
    if not records:
        raise InputError("no record to judge by (expected at least one)")
    readings = sum(len(record.columns["t_s"]) for record in records)
    sweeps = sum(len(record.sweeps()) for record in records)
    names = ", ".join(record.name for record in records)
    if readings < LEAST_READINGS:
        raise InputError(f"{names}: {readings} readings are too few to judge (expected {LEAST_READINGS} at least)")
    if sweeps < LEAST_SWEEPS:
        raise InputError(
            f"{names}: {sweeps} sweep is too few to judge"
            f" (expected {LEAST_SWEEPS} at least: another direction, circle or feed)"
        )
