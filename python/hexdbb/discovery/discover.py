"""See where the model fails, learn what is missing.

The model's free values are fitted and what is left is judged (`hexdbb.diagnosis.sufficiency`). Hypotheses, known and
learned, are searched and decided by their evidence (`hexdbb.evidence`); their outcome is told here (`causes`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from hexdbb import _core
from hexdbb.diagnosis import Sufficiency, explains_changes
from hexdbb.discovery.begun import Begun, begin
from hexdbb.discovery.calibrated import Calibrated
from hexdbb.discovery.causes import Told, told
from hexdbb.discovery.look import Look
from hexdbb.discovery.own_effects import require_usable_effects
from hexdbb.discovery.result import Discovery
from hexdbb.discovery.unexplained import unexplained_structure
from hexdbb.discovery.words import NOTHING, joined
from hexdbb.errors import InputError
from hexdbb.evidence.criteria import DEFAULT, Criteria
from hexdbb.evidence.fit.sufficiency import repeats_but_for_forms
from hexdbb.evidence.linear.engine import Engine
from hexdbb.model import Model
from hexdbb.samples import Samples, predict
from hexdbb.samples.places import with_set_up_of
from hexdbb.samples.unmeasured import judged_effects, not_measured_sentences, require_judged, with_judged_free
from hexdbb.threads import one_thread
from hexdbb.threads.heap import give_back, gives_back

Progress = Callable[[str], None]

LEAST_READINGS = 200
"""Readings below which nothing is judged: a model has some forty values."""
LEAST_SWEEPS = 2
"""Sweeps below which no direction, circle or feed can be held out."""


@gives_back
@one_thread
def discover(
    samples: Samples,
    model: Model,
    candidates: Sequence[str] | None = None,
    progress: Progress = lambda _: None,
    *,
    matters_um: float | None = None,
    known_only: bool = False,
    criteria: Criteria = DEFAULT,
    with_tables: bool = True,
) -> Discovery:
    """Look for what is missing from a model.

    Parameters
    ----------
    samples : Samples
    model : Model
        Its free values are fitted first.
    candidates : sequence of str, optional
        Known effects to try, beside the learned hypotheses; all that are not wholly in the model where not given.
    progress : callable
        Is told what is being done.
    matters_um : float, optional
        Unexplained RMS below which nothing is missing that matters (`hexdbb.diagnosis.sufficiency`).
    known_only : bool
        Try known effects alone, in a fraction of the time: what none of them explains is not learned.
    criteria : Criteria
        Constants that decide.
    with_tables : bool
        Whether other hypotheses are held out, and predictors of what remains ranked, to be shown beside the verdict.

    Raises
    ------
    InputError
        Too few readings or sweeps to judge; records of another machine; a candidate that is not known; an effect of
        the user's own that fails, with file and line.
    RunError
        Where the model itself cannot be fitted.
    """
    _require_enough(samples)
    _require_size(matters_um)
    known = with_set_up_of(samples, model)
    names = _asked(samples, known, candidates)
    require_usable_effects(samples, known, names)
    progress("fitting the model as it is")
    begun = begin(samples, with_judged_free(samples.unmeasured, known), criteria)
    enough = begun.enough(matters_um)
    if not enough.matters:
        return _with_remarks(_nothing(begun.engine, enough), begun)
    calibrated = Calibrated.of(begun.engine.base)
    fitting = begin(samples, calibrated.model, criteria) if calibrated.names else None
    # Beside effects in the model what is left may be their forms, which the search asks for.
    if fitting is not None and not (begun.engine.present() or (less := fitting.enough(matters_um)).matters):
        return _with_calibrated(_with_remarks(_nothing(fitting.engine, less), fitting), fitting, calibrated)
    progress("screening all hypotheses, fitting the best")
    look = Look.of(begun, names, matters_um, learns=not known_only)
    is_off = fitting is not None and calibrated.is_off(look.search, look.verdict.node, is_sure=look.is_sure)
    if fitting is not None and is_off:
        progress(f"screening again, {joined(calibrated.names)} fitted")
        look.search.forget()
        give_back()
        again = Look.of(fitting, names, matters_um, learns=not known_only)
        is_off = again.is_better(look)
        look = again if is_off else look
    begun, search, verdict = look.begun, look.search, look.verdict
    suffices, enough = begun.suffices(matters_um), begun.enough(matters_um)
    engine, samples, noise = begun.engine, begun.engine.samples, begun.judging.noise
    outcome = _outcome(told(search, verdict, suffices, enough.matters_um, with_tables), engine, enough)
    repeats = verdict.grade == "none" and repeats_but_for_forms(search.root.trial, search.trials, begun.judging)
    if with_tables and outcome.verdict != "none" and (outcome.remaining or enough).matters:
        residual_mm = predict(samples, outcome.model).residual_mm
        structure = unexplained_structure(samples, outcome.model, residual_mm, noise)
        outcome = replace(outcome, structure=structure)
    outcome = _with_remarks(outcome, begun, repeats=repeats)
    return _with_calibrated(outcome, begun, calibrated) if is_off else outcome


def _with_calibrated(found: Discovery, begun: Begun, calibrated: Calibrated) -> Discovery:
    """Add how far off is what is calibrated, and was fitted."""
    sentences = calibrated.sentences(begun.engine, found.model)
    return replace(found, remarks=(*sentences, *found.remarks), calibrated=calibrated.names)


def absent_effects(model: Model) -> list[str]:
    """Return the effects that could be missing: known ones that the model lacks, or holds in part."""
    partly = {term.effect for term in model.terms if not term.free.all() and not np.any(term.values[~term.free])}
    wholly = {term.effect for term in model.terms} - partly
    return [name for name in (*_core.effect_names("catalogue"), *model.own_effects) if name not in wholly]


def _nothing(engine: Engine, enough: Sufficiency) -> Discovery:
    rms_um = enough.lack_of_fit.rms_um
    sentence = f"nothing that matters is missing: {enough.sentence}" if enough.is_significant else NOTHING
    return Discovery(
        "none", sentence, enough, (), (), engine.samples, engine.noise, engine.base, engine.base, None, rms_um, rms_um
    )


def _outcome(found: Told, engine: Engine, enough: Sufficiency) -> Discovery:
    left = enough if found.remaining is None else found.remaining
    return Discovery(
        verdict=found.verdict,
        sentence=found.sentence,
        sufficiency=enough,
        causes=found.causes,
        candidates=found.candidates,
        samples=engine.samples,
        noise=engine.noise,
        base=engine.base,
        model=found.model,
        remaining=found.remaining,
        rms_before_um=enough.lack_of_fit.rms_um,
        rms_after_um=left.lack_of_fit.rms_um,
        next_test=found.next_test,
        remarks=found.remarks,
        likely=found.likely,
        learned=found.learned,
        refinements=found.refinements,
    )


def _with_remarks(found: Discovery, begun: Begun, *, repeats: bool = False) -> Discovery:
    """Add what was left out or not measured, and what laps tell of the noise.

    A machine that does not repeat does not lack nothing, unless the model explains why (a screw that warms), or it
    repeats but for the forms of the model's effects.
    """
    engine, judging = begun.engine, begun.judging
    left_out = () if begun.left_out is None else (begun.left_out,)
    records = engine.samples.records
    found = replace(found, remarks=(*found.remarks, *left_out, *not_measured_sentences(records)))
    explained = not judging.is_steady and (repeats or explains_changes(engine.samples, engine.residual_mm, judging))
    if judging.remark is None or explained:
        return found
    found = replace(found, remarks=(*found.remarks, judging.remark))
    if judging.is_steady or found.verdict != "none":
        return found
    structure = unexplained_structure(engine.samples, engine.base, engine.residual_mm, judging.noise)
    sentence = "something changes from lap to lap that no model of the machine explains"
    return replace(found, verdict="unknown", sentence=sentence, structure=structure)


def _asked(samples: Samples, model: Model, candidates: Sequence[str] | None) -> list[str]:
    if candidates is None:
        return judged_effects(samples.unmeasured, model, absent_effects(model))
    possible = {*_core.effect_names("catalogue"), *model.own_effects}
    for name in candidates:
        if name not in possible:
            raise InputError(f"candidate {name}: not a known effect (expected one of {', '.join(sorted(possible))})")
        require_judged(samples.unmeasured, model, name, samples.name)
    return [name for name in absent_effects(model) if name in candidates]


def _require_size(matters_um: float | None) -> None:
    if matters_um is not None and not 0.0 <= matters_um < float("inf"):
        raise InputError(f"matters: {matters_um:g} µm (expected a length, 0 or larger)")


def _require_enough(samples: Samples) -> None:
    sweeps = len(samples.sweeps())
    if len(samples) < LEAST_READINGS:
        raise InputError(
            f"{samples.name}: {len(samples)} readings are too few to judge (expected {LEAST_READINGS} at least)"
        )
    if sweeps < LEAST_SWEEPS:
        raise InputError(
            f"{samples.name}: {sweeps} sweep is too few to judge"
            f" (expected {LEAST_SWEEPS} at least: another direction, circle or feed)"
        )
