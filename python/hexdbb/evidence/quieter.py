"""Readings judged again by the noise of what is left, where the laps' own differences were no noise.

Noise is told by laps that repeat each other at one angle, less what the nominal machine reads there. What changes
faster than that, or from lap to lap, is in it (`JudgingNoise.beside`). Once a cause explains it, what is left repeats
much better; other causes, hidden under what was taken for noise, are then looked for by that.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import JudgingNoise
from hexdbb.evidence.engine import Engine
from hexdbb.evidence.search import Search
from hexdbb.evidence.sums import Sums
from hexdbb.evidence.trial import Trial
from hexdbb.evidence.verdict import Verdict, judge

Floats = NDArray[np.float64]


def judged(search: Search, matters_um: float | None = None) -> tuple[Search, Verdict]:
    """Return a search and its verdict (`judge`), both made anew by the noise of what is left where that is much less.

    Parameters
    ----------
    search : Search
    matters_um : float, optional
        As for `judge`.
    """
    verdict = judge(search, matters_um)
    judging = JudgingNoise(search.engine.noise)
    quieter = judging.beside(search.engine.part, _left_mm(search, verdict.node.trial)) if verdict.found else judging
    if quieter is judging:
        return search, verdict
    engine = Engine(search.engine.samples, search.engine.base, quieter.noise, search.criteria)
    again = Search(engine, search.known, search.criteria, learns=search.learns)
    return again, judge(again, matters_um)


def _left_mm(search: Search, trial: Trial) -> Floats:
    """Return what a trial leaves of the rows, mm, as large as if no row were a mean of readings."""
    engine, linear = search.engine, search.trials.linear(trial)
    left: Floats = linear.residual - linear.own @ Sums(linear, engine.readings, ()).whole.own_values()
    return left * engine.noise.sigma_mm
