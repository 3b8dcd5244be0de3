"""Is what differs from lap to lap noise? White series of equal variance are; a line in the spectrum or a burst is not.

Line: of white noise the largest of m periodogram ordinates exceeds x times their mean with probability m e^-x
(Fisher 1929, for large m). Burst: the logarithms of the series' variances scatter by sqrt(2 / n) each; more is tested
by chi-square (Bartlett 1937, simplified).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import stats

Floats = NDArray[np.float64]

LEAST_VALUES = 32
"""A shorter series tells nothing."""
CHANCE = 1e-4
"""Less probable than this is no chance."""
COLOURED = 4.0 / 3.0
"""Interpolation between readings lifts the lowest frequencies by so much above the mean, at most."""


def is_white(series: Sequence[Floats]) -> bool:
    """Whether some series are noise of one and the same size, each white.

    Parameters
    ----------
    series : sequence of ndarray
        Each of a stretch of time. Those shorter than `LEAST_VALUES` do not count.

    Returns
    -------
    bool
        False also where no series counts.
    """
    counting = [each - each.mean() for each in series if len(each) >= LEAST_VALUES]
    if not counting or not all(each.any() for each in counting):
        return False
    return _line_chance(counting) > CHANCE and _burst_chance(counting) > CHANCE


def _line_chance(series: Sequence[Floats]) -> float:
    """Probability of the strongest line by chance."""
    chances = []
    for each in series:
        power = np.abs(np.fft.rfft(each))[1:] ** 2
        chances.append(len(power) * float(np.exp(-power.max() / power.mean() / COLOURED)))
    return min(1.0, len(series) * min(chances))


def _burst_chance(series: Sequence[Floats]) -> float:
    """Probability of so different variances by chance."""
    count = np.array([len(each) for each in series])
    level = np.log([float(each.var()) for each in series])
    deviation = level - np.average(level, weights=count)
    return float(stats.chi2.sf(np.sum(0.5 * count * deviation**2), len(series) - 1)) if len(series) > 1 else 1.0
