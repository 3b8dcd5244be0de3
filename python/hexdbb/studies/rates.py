"""Shares and quantiles of a number of cases, with 95 % confidence bounds that hold whatever the distribution is.

Share of independent cases: Clopper and Pearson (Biometrika 26(4), 1934), exact: it covers at least as often as stated.
Share of values that come several a case (the values of one machine are fitted together): the same with the effective
number of values p (1 - p) / var(p), var(p) from the scatter between cases (Korn and Graubard, Survey Methodology
24(2), 1998). Quantile: order statistics, whose ranks are binomial (Conover, Practical Nonparametric Statistics, 1999).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

Floats = NDArray[np.float64]

CONFIDENCE = 0.95
"""Level of confidence of all bounds, which metrology states as k = 2 (GUM)."""


@dataclass(frozen=True)
class Bounded:
    """A value with confidence bounds, nan where there is none.

    Attributes
    ----------
    value, low, high : float
    number : int
        Of what it was computed from.
    """

    value: float
    low: float
    high: float
    number: int


def share(good: int, number: int) -> Bounded:
    """Return how large a share of independent cases is good, with bounds of Clopper and Pearson.

    Parameters
    ----------
    good, number : int
        Good ones, and all; no share where there is none.
    """
    if not number:
        return Bounded(np.nan, np.nan, np.nan, 0)
    low, high = _clopper_pearson(good / number, number)
    return Bounded(good / number, low, high, number)


def clustered_share(good: Sequence[int], numbers: Sequence[int]) -> Bounded:
    """Return how large a share of values is good where cases have several, with bounds of Korn and Graubard.

    Parameters
    ----------
    good, numbers : sequence of int
        Good values and all values of each case.
    """
    hits, counts = np.asarray(good, dtype=float), np.asarray(numbers, dtype=float)
    total, cases = float(counts.sum()), int(np.count_nonzero(counts))
    if not total:
        return Bounded(np.nan, np.nan, np.nan, 0)
    value = float(hits.sum()) / total
    # Values of one case are as good as one where nothing shows how they vary.
    effective = float(cases)
    if cases > 1:
        variance = cases / (cases - 1) * float(np.sum((hits - value * counts) ** 2)) / total**2
        if variance > 0.0:
            wider = stats.t.ppf(0.025, total - 1) / stats.t.ppf(0.025, cases - 1)
            effective = min(value * (1.0 - value) / variance * wider**2, total)
    low, high = _clopper_pearson(value, effective)
    return Bounded(value, low, high, int(total))


def quantile(values: ArrayLike, level: float) -> Bounded:
    """Return a quantile of independent values; a bound is infinite where there are too few values for it.

    Parameters
    ----------
    values : array_like, shape (n,)
    level : float
        0.5 for the median.
    """
    ordered = np.sort(np.asarray(values, dtype=float))
    n = len(ordered)
    if not n:
        return Bounded(np.nan, np.nan, np.nan, 0)
    below = int(stats.binom.ppf((1.0 - CONFIDENCE) / 2.0, n, level))
    above = int(stats.binom.ppf((1.0 + CONFIDENCE) / 2.0, n, level)) + 1
    low = float(ordered[below - 1]) if below >= 1 else -np.inf
    high = float(ordered[above - 1]) if above <= n else np.inf
    return Bounded(float(np.quantile(ordered, level, method="inverted_cdf")), low, high, n)


def _clopper_pearson(value: float, number: float) -> tuple[float, float]:
    """Return the bounds of a share of a number of independent cases, which need not be whole."""
    good, tail = value * number, (1.0 - CONFIDENCE) / 2.0
    low = stats.beta.ppf(tail, good, number - good + 1.0) if good > 0.0 else 0.0
    high = stats.beta.ppf(1.0 - tail, good + 1.0, number - good) if good < number else 1.0
    return float(low), float(high)
