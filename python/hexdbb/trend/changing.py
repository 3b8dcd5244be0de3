"""Which values change from record to record: found one after another, each weighed against all others by evidence.

A change of one element of one effect is a hypothesis. Its evidence is the marginal likelihood of all readings with
departures of that element allowed in every record, of the scale that fits best, over that with what has been found so
far: first order about the present fit, so that each costs one solution of the arrow-shaped system (`joint`). The
strongest is fitted with all else, then all are weighed again, until none is left that the readings ask for and that
matters. So wear is told from set-up: cups and ball are free in every record and explain what they can.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis.sufficiency import MATTERS_OF_NOISE
from hexdbb.model import Model
from hexdbb.trend.arrow import Changing, Solution, cost, solve
from hexdbb.trend.joint import JointFit, Part, fit_together, started

Floats = NDArray[np.float64]

SCALES = (0.01, 0.03, 0.1, 0.3, 1.0)
"""Standard deviations of departures that are tried, in prior standard deviations: from 1 µm of a leg's 100 µm upwards;
half a decade apart, which costs a hypothesis one unit of log evidence at most."""
ENOUGH = 10.0
"""Gain of log evidence from which a change is believed: odds of 22,000 to 1, some hundred elements being tried."""
MOST_FALSE = 3
"""Candidates that first order promises and the fit refuses, after which the search ends: along directions that only
the curvature of the readings determines, first order promises too much."""
MOST = 8
"""Changes looked for at most: a machine of which more elements change was rebuilt, and needs a model of its own."""


@dataclass(frozen=True)
class Found:
    """A change that was found.

    Attributes
    ----------
    changing : Changing
    gain : float
        Of log evidence, over the next best without it.
    rivals : tuple of str
        Elements whose change explains the same nearly as well.
    """

    changing: Changing
    gain: float
    rivals: tuple[str, ...]


def candidates(fit: JointFit) -> list[Changing]:
    """Return every element of every shared effect that may change."""
    columns: dict[tuple[str, str], list[int]] = {}
    parameters, model = fit.models[0].parameters(), fit.models[0]
    for column in fit.layout.shared:
        each = parameters[column]
        if model.info(each.effect).element_kind == "mount":
            continue  # of a fixing that records share: a set-up does not wear
        element = each.element if len(model.info(each.effect).elements) > 1 else ""
        columns.setdefault((each.effect, element), []).append(int(column))
    return [Changing(effect, element, tuple(each)) for (effect, element), each in columns.items()]


def find_changes(
    parts: Sequence[Part], model: Model, progress: Callable[[str], None] = lambda _: None
) -> tuple[JointFit, list[Found]]:
    """Fit records together and find what changes between them.

    Parameters
    ----------
    parts : sequence of Part
        One of each record, two at least.
    model : Model
        Its free values are fitted; the start of the fit.
    progress : callable
        Told what is done.

    Returns
    -------
    fit : JointFit
        With all changes found.
    found : list of Found
        Strongest first.
    """
    progress("fitting all records together")
    fit = fit_together(parts, started(parts, model))
    found: list[Found] = []
    refused: list[str] = []
    while len(found) < MOST and len(refused) < MOST_FALSE:
        best = strongest(fit, found, refused)
        if best is None:
            break
        progress(f"fitting with {best.changing.label} changing")
        changing = [*(each.changing for each in found), best.changing]
        departures = [np.append(each, np.zeros(len(best.changing.columns))) for each in fit.departures]
        more = fit_together(parts, fit.models, changing, departures)
        if not _falls_enough(fit, more) or not _matters(more, best.changing):
            refused.append(best.changing.label)
            continue
        fit, found = more, [*found, best]
    return fit, found


def strongest(fit: JointFit, found: Sequence[Found], refused: Sequence[str] = ()) -> Found | None:
    """Return the change that gains most evidence beside those found; None where none gains enough."""
    known = {*refused, *(each.changing.label for each in found)}
    base = _with(fit, None).log_evidence
    gains: list[tuple[float, Changing]] = []
    for each in candidates(fit):
        if each.label not in known:
            scaled = [replace(each, scale=scale) for scale in SCALES]
            gains.append(max(((_with(fit, one).log_evidence - base, one) for one in scaled), key=lambda pair: pair[0]))
    if not gains:
        return None
    gains.sort(key=lambda pair: -pair[0])
    gain, best = gains[0]
    if gain < ENOUGH:
        return None
    rivals = tuple(each.label for other, each in gains[1:] if other > gain - ENOUGH)
    return Found(best, gain, rivals)


def _with(fit: JointFit, one: Changing | None) -> Solution:
    """Return the system solved with one more element changing."""
    if one is None:
        return solve(fit.equations, fit.layout, fit.changing, fit.departures, fit.damping)
    departures = [np.append(each, np.zeros(len(one.columns))) for each in fit.departures]
    return solve(fit.equations, fit.layout, (*fit.changing, one), departures, fit.damping)


def _falls_enough(before: JointFit, after: JointFit) -> bool:
    """Whether a change lowers half chi-square by what its evidence promised at least, readings counting as before."""
    weighed = [
        replace(each, effective_mm=by.effective_mm) for each, by in zip(after.equations, before.equations, strict=True)
    ]
    return before.cost - cost(weighed, after.layout, after.changing, after.departures) >= ENOUGH


def _matters(fit: JointFit, one: Changing) -> bool:
    """Whether a change moves the readings of some record by enough, once the set-up has taken what it can."""
    noise_mm = float(np.sqrt(np.mean([each.noise_mm**2 for each in fit.equations])))
    return bool(shown_mm(fit, one).max() >= MATTERS_OF_NOISE * noise_mm)


def shown_mm(fit: JointFit, one: Changing) -> Floats:
    """Return the RMS (mm) by which a change moves each record's readings against the records' mean, set-up fitted."""
    columns = np.array(one.columns, dtype=np.intp)
    place = [each.label for each in fit.changing].index(one.label)
    first = sum(len(each.columns) for each in fit.changing[:place])
    departed = np.array([each[first : first + len(one.columns)] for each in fit.departures])
    departed -= departed.mean(axis=0)
    shown = []
    for each, set_up, step in zip(fit.equations, fit.layout.set_up, departed, strict=True):
        inside = each.information[np.ix_(set_up, set_up)] + np.diag(np.full(len(set_up), each.effective_mm**2))
        across = each.information[np.ix_(set_up, columns)]
        own = each.information[np.ix_(columns, columns)]
        left = step @ (own - across.T @ np.linalg.solve(inside, across)) @ step
        shown.append(np.sqrt(max(left, 0.0) / each.readings))
    return np.array(shown)
