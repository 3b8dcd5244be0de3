"""Judge readings a second time, against the noise of the residual, if repeatability overestimated the noise.

The noise is estimated from differences between laps, which also contain errors that are not sampled alike in every lap
(`JudgingNoise.beside`). Once the cause of such an error is found, the residual is much smaller than that estimate, and
a second search finds smaller causes that the first one could not distinguish from noise.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import JudgingNoise
from hexdbb.evidence.fit.trial import Trial
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.verdict import Verdict, judge

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
    search.forget()
    engine = Engine(search.engine.samples, search.engine.base, quieter.noise, search.criteria)
    again = Search(engine, search.known, search.criteria, learns=search.learns)
    return again, judge(again, matters_um)


def _left_mm(search: Search, trial: Trial) -> Floats:
    """Return what a trial leaves of the rows, mm, as large as if no row were a mean of readings."""
    engine, linear = search.engine, search.trials.linear(trial)
    left: Floats = linear.residual - linear.own @ Sums(linear, engine.readings, ()).whole.own_values()
    return left * engine.noise.sigma_mm
