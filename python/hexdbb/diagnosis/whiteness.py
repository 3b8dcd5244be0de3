"""Test whether the differences between laps are noise: white, of one variance at each feed, without lines or bursts.

Line: of white noise the largest of m periodogram ordinates exceeds x times their mean with probability m e^-x
(Fisher 1929, for large m). Burst: the logarithms of the series' variances scatter by sqrt(2 / n) each; more is tested
by chi-square (Bartlett 1937, simplified). Machines vibrate more the faster they move: variances at different feeds are
not compared.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import compress

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core

Floats = NDArray[np.float64]

LEAST_VALUES = 32
"""Shorter series are left out: the asymptotic distribution of the periodogram's maximum needs this many values."""
CHANCE = 1e-4
"""Probability below which white noise is rejected: with tens of records a year, one false alarm in centuries."""
COLOURED = 4.0 / 3.0
"""Largest power over mean power that interpolation between readings gives white noise, at the lowest frequencies."""


def is_white(series: Sequence[Floats], feeds: Sequence[float] | None = None) -> bool:
    """Return whether some series are white noise, of one variance at each feed.

    Parameters
    ----------
    series : sequence of ndarray
        Each of a stretch of time. Those shorter than `LEAST_VALUES` do not count.
    feeds : sequence of float, optional
        Of each series; all have one where not given.

    Returns
    -------
    bool
        False also where no series counts.
    """
    counts = [len(each) >= LEAST_VALUES for each in series]
    counting = [each - each.mean() for each in compress(series, counts)]
    if not counting or not all(each.any() for each in counting):
        return False
    return (
        _line_chance(counting) > CHANCE
        and _burst_chance(counting, list(compress(feeds or [0.0] * len(series), counts))) > CHANCE
    )


def _line_chance(series: Sequence[Floats]) -> float:
    """Return the probability of so strong a spectral line in white noise."""
    chances = []
    for each in series:
        power = np.abs(np.fft.rfft(each))[1:] ** 2
        chances.append(len(power) * float(np.exp(-power.max() / power.mean() / COLOURED)))
    return min(1.0, len(series) * min(chances))


def _burst_chance(series: Sequence[Floats], feeds: Sequence[float]) -> float:
    """Return the probability of so different variances in noise of one variance at each feed."""
    count = np.array([len(each) for each in series])
    level = np.log([float(each.var()) for each in series])
    kinds, kind = np.unique(feeds, return_inverse=True)
    mean = np.bincount(kind, count * level) / np.bincount(kind, count)
    freedom = len(series) - len(kinds)
    return _core.chi_square_tail(freedom, float(np.sum(0.5 * count * (level - mean[kind]) ** 2))) if freedom else 1.0
