"""The likely cause of a residual: a quick look for one cause or two by the analysis that gives the verdicts.

Who compares a model with readings wants to know first why it fails. A step or two of the search of `discover` (all
hypotheses screened, the best few fitted, their prediction of what was left out checked) answer that in a second or two;
more causes at once, exchanges between them and the whole table of rivals are left to `discover`.
Before anything is sought, the model's own geometry is fitted: where values that do not belong to these readings explain
most of the residual, no effect is missing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis import FitTest, Noise, Sufficiency, assess_sufficiency, evaluate_fit, judging_noise
from hexdbb.discovery.discover import LEAST_READINGS, LEAST_SWEEPS, discover
from hexdbb.discovery.result import Cause
from hexdbb.errors import RunError
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.learned.places import KINDS, is_learned
from hexdbb.model import Choice, Model, default_effects
from hexdbb.samples import Samples, predict

Floats = NDArray[np.float64]
Judged = Callable[[Model, Floats], Sufficiency]
"""Judges what a fitted model leaves."""

QUICK = replace(
    DEFAULT,
    max_effects=2,
    beam=1,
    max_expansions=2,
    most_expansions=2,
    most_rounds=0,
    full_fits=4,
    later_fits=1,
    fit_rows=1500,
    thinned_rows=1200,
)
"""Two steps of the search at most, four known and four learned hypotheses fitted in the first: with less, a short spike
at reversals went unfitted; with more, a machine with one fault takes no less time than a whole discovery."""
MOST = 0.5
"""Part of the residual beyond the noise from which the model's own values are its likely cause: the larger part."""
LINEAR = 0.02
"""Part that they must explain to first order to be fitted at all: a fit that bends geometry far explained up to twelve
times as much, which is half of `MOST`."""
STRAND = ("slider", "leg")
"""Kinds of elements that belong together by number: leg k stands on slider k, what one does the other seems to do."""
SET_UP = {"mount": ("ball", "cup"), "ball": ("ball", "cup"), "cup": ("ball", "cup")}
"""What belongs together in a set-up: ball and cup shift the reading nearly alike."""


@dataclass(frozen=True)
class LikelyCause:
    """The likely cause of a residual.

    Attributes
    ----------
    sentence : str
        It, and how much it explains.
    choices : tuple of str
        The effect, or two together, as `hexdbb add` takes them; none where it is the model's own values.
    subjects : tuple of str
        Elements that it acts at (``slider 4``); none where it belongs to the whole machine or the gauge.
    residual_mm : ndarray, shape (n,)
        What a model with it, fitted, leaves.
    is_all : bool
        Whether nothing that matters is left.
    """

    sentence: str
    choices: tuple[str, ...]
    subjects: tuple[str, ...]
    residual_mm: Floats = field(repr=False)
    is_all: bool


def likely_cause(samples: Samples, model: Model, residual_mm: Floats) -> LikelyCause | None:
    """Look for the likely cause of what a model leaves.

    Parameters
    ----------
    samples : Samples
    model : Model
        That knows the samples' mounts.
    residual_mm : ndarray, shape (n,)
        What it leaves as it is.

    Returns
    -------
    LikelyCause or None
        None where nothing that matters is left, where the readings are too few to judge, or where nothing explains it.

    Raises
    ------
    UserEffectError
        An effect of the user's own that fails, with file and line.
    """
    if len(samples) < LEAST_READINGS or len(samples.sweeps()) < LEAST_SWEEPS:
        return None
    judging = judging_noise(samples)
    test = FitTest(samples, judging.noise)

    def judged(fitted: Model, left_mm: Floats) -> Sufficiency:
        return assess_sufficiency(samples, fitted, left_mm, noise=judging, test=test)

    if not judged(model, residual_mm).matters:
        return None
    try:
        return _own_values(samples, model, residual_mm, judging.noise, judged) or _missing(samples, model, judged)
    except RunError:  # a model that cannot be fitted to these readings is compared with them all the same
        return None


def _own_values(
    samples: Samples, model: Model, residual_mm: Floats, noise: Noise, judged: Judged
) -> LikelyCause | None:
    """Return the geometry as the cause where it is not, or badly, fitted; None where it explains little."""
    geometry = {name for name, is_free in default_effects(model.machine).items() if is_free}
    wider = model
    for effect in geometry - {term.effect for term in model.terms}:
        wider = wider.with_effect(Choice(effect))
    lacks_some = len(wider.terms) > len(model.terms)
    wider = wider.with_free(wider.free | np.array([each.effect in geometry for each in wider.parameters()]))
    if _linear_share(samples, wider, residual_mm, noise) < LINEAR:
        return None
    fitted, result = evaluate_fit(samples, wider, wider.free, noise, hypothesis=True)
    if _share(residual_mm, result.residual_mm, noise.sigma_mm) < MOST:
        return None
    whose = "the machine's geometric errors, which the model lacks" if lacks_some else "the model's own values"
    sentence = (
        f"likely cause: {whose}; fitted to these readings (hexdbb diagnose) they leave"
        f" {_rms_um(result.residual_mm):.2f} µm of {_rms_um(residual_mm):.2f} µm"
    )
    return LikelyCause(sentence, (), (), result.residual_mm, not judged(fitted, result.residual_mm).matters)


def _linear_share(samples: Samples, model: Model, residual_mm: Floats, noise: Noise) -> float:
    """Return the part of the mean square beyond the noise that a model's free values explain to first order.

    It takes one pass over the readings, a fit takes three to twenty.
    """
    sums = _core.normal_equations(samples.engine(model), samples.block(model), samples.reading_mm)
    scale = model.prior_sigma[model.free] / noise.sigma_mm
    information = sums.information[np.ix_(model.free, model.free)] * np.outer(scale, scale)
    gradient = sums.gradient[model.free] * scale / noise.sigma_mm
    gained = gradient @ np.linalg.solve(information + np.eye(len(scale)), gradient)
    left_mm2 = float(np.mean(residual_mm**2)) - noise.sigma_mm**2
    return float(gained) * noise.sigma_mm**2 / len(residual_mm) / max(left_mm2, 1e-18)


def _missing(samples: Samples, model: Model, judged: Judged) -> LikelyCause | None:
    """Return the effect that is likely missing."""
    found = discover(samples, model, criteria=QUICK, with_tables=False)
    if not found.causes and not found.calibrated:
        return None
    with_all = found.learned or found.model
    left_mm = predict(samples, with_all).residual_mm
    choices = (*found.calibrated, *(each.choice for each in found.causes))
    subjects = tuple(subject for each in found.causes for subject in subjects_of(each, with_all))
    sentence = found.likely or f"likely cause: {found.remarks[0]}"  # that of what is calibrated, and off
    return LikelyCause(sentence, choices, subjects, left_mm, not judged(with_all, left_mm).matters)


def subjects_of(cause: Cause, model: Model) -> tuple[str, ...]:
    """Return the elements that a cause acts at, as predictors of a residual name them."""
    if is_learned(cause.choice):
        _, place, *rest = cause.choice.split(":")
        kind, elements = KINDS.get(place, place), tuple(each for each in rest[:1] if each.isdecimal())
    else:
        kind, elements = model.info(cause.effect).element_kind, cause.elements
    if kind in SET_UP:
        return SET_UP[kind]
    kinds = STRAND if kind in STRAND else (kind,) if kind in KINDS.values() else ()
    return tuple(f"{each} {element}" for element in elements for each in kinds)


def _share(before_mm: Floats, after_mm: Floats, noise_mm: float) -> float:
    """Return the part of the mean square beyond the noise that is gone."""
    before, after = float(np.mean(before_mm**2)), float(np.mean(after_mm**2))
    return min(max((before - after) / max(before - noise_mm**2, 1e-18), 0.0), 1.0)


def _rms_um(values_mm: Floats) -> float:
    return float(np.sqrt(np.mean(values_mm**2))) * 1e3
