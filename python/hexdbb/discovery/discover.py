"""See where the model fails, learn which effect is missing.

The way of a verdict: fit the model; test what is left against noise (`lack_of_fit`); screen all absent effects at once
to first order (`screen`); give the best a fit of their own (`search`, `trial`); judge (`verdict`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hexdbb.discovery.judging import JudgingNoise, judging_noise
from hexdbb.discovery.lack_of_fit import FitTest
from hexdbb.discovery.own_effects import failing_effects
from hexdbb.discovery.result import Discovery
from hexdbb.discovery.search import Progress, Search, absent_effects
from hexdbb.discovery.trial import Base, fitted_base
from hexdbb.discovery.unexplained import unexplained_structure
from hexdbb.discovery.verdict import judge
from hexdbb.errors import InputError
from hexdbb.model import Model
from hexdbb.samples import Samples

MOST_TRIED = 8
"""So many effects get a fit of their own."""
LEAST_READINGS = 200
LEAST_SWEEPS = 2


def discover(
    samples: Samples,
    model: Model,
    candidates: Sequence[str] | None = None,
    progress: Progress = lambda _: None,
) -> Discovery:
    """Look for one missing effect.

    Parameters
    ----------
    samples : Samples
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
    _require_enough(samples)
    known = model.with_mounts(samples.mounts)
    judging = judging_noise(samples)
    progress("fitting the model as it is")
    base = fitted_base(samples, known, judging.noise)
    asked = list(candidates) if candidates is not None else absent_effects(base.model)
    failed = failing_effects(samples, base.model, asked)
    names = tuple(name for name in asked if name not in failed)
    search = Search(base, FitTest(samples, judging.noise), names, progress)
    progress("screening all effects")
    ranked, tried = search.ranked()
    found = judge(search, search.trials([each for each in ranked if each.gain > 0.0][:MOST_TRIED], tried))
    found = replace(found, remarks=(*found.remarks, *(f"left out: {error}" for error in failed.values())))
    return _with_remark(found, base, judging)


def _with_remark(found: Discovery, base: Base, judging: JudgingNoise) -> Discovery:
    """Say what laps tell of the noise; a machine that does not repeat does not lack nothing."""
    if judging.remark is None:
        return found
    found = replace(found, remarks=(*found.remarks, judging.remark))
    if judging.is_steady or found.verdict != "none":
        return found
    structure = unexplained_structure(base.samples, base.model, base.residual_mm, base.noise)
    return replace(found, verdict="unknown", structure=structure)


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
