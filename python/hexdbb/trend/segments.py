"""Change points of a series: where one straight line of time ends and another begins.

Model: y_i = line of its segment at t_i + e_i, lines constant or sloped, the standard deviation s_i of e_i known. A
constant is a state, a slope is wear, a jump between lines is an event.
Criterion: the segmentation of least BIC (Schwarz 1978),
    sum ((y_i - line) / s_i)^2 + ln(n) (values of the lines + change points),
found exactly by dynamic programming over all segmentations (optimal partitioning: Jackson et al. 2005; PELT, Killick et
al. 2012, is the same with pruning, which a few hundred records do not need).
Scatter: what records scatter beyond their own intervals (form, set-up, temperature) is estimated from second
differences, which a straight line does not have: their median magnitude, of normal scatter s, is 0.6745 sqrt(6) s at
even steps. It is added in squares; a few jumps do not move a median.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LEAST = 3
"""Records of a segment at least: one alone is an outlier, and a line through two fits whatever they are."""
MEDIAN_OF_NORMAL = 0.6745
"""Median magnitude of a standard normal value."""


@dataclass(frozen=True)
class Segment:
    """A stretch of records on one line: `first` to `last`, from 0; level at its first record, slope per day."""

    first: int
    last: int
    level: float
    slope: float
    slope_sigma: float


def scatter(days: Floats, values: Floats, sigma: Floats) -> Floats:
    """Return the standard deviations of values about their lines: their own, and what records scatter beyond them.

    Parameters
    ----------
    days : ndarray, shape (n,)
        Increasing.
    values, sigma : ndarray, shape (n,)
        Sigma is nan or 0 where not known.
    """
    own = np.nan_to_num(sigma, nan=0.0)
    extra = 0.0
    if len(values) > 3:
        before, after = np.diff(days)[:-1], np.diff(days)[1:]
        share = np.where(before + after > 0.0, after / np.maximum(before + after, 1e-9), 0.5)
        bent = values[1:-1] - share * values[:-2] - (1.0 - share) * values[2:]
        size = np.sqrt(1.0 + share**2 + (1.0 - share) ** 2)
        spread = float(np.median(np.abs(bent) / size)) / MEDIAN_OF_NORMAL
        extra = max(spread**2 - float(np.median(own**2)), 0.0)
    least = 1e-9 + 1e-6 * float(np.ptp(values))  # of equal values: no line may fit infinitely well
    return np.asarray(np.sqrt(own**2 + extra + least**2))


def segments(days: Floats, values: Floats, sigma: Floats) -> list[Segment]:
    """Return the segments of a series, the first from the first record.

    Parameters
    ----------
    days : ndarray, shape (n,)
        Times, increasing.
    values : ndarray, shape (n,)
        Finite.
    sigma : ndarray, shape (n,)
        Of each value, nan where not known (`scatter` is added).
    """
    n = len(values)
    spread, price = scatter(days, values, sigma), np.log(max(n, 2))
    best: list[tuple[float, list[Segment]]] = [(0.0, [])]
    for end in range(1, n + 1):
        options = []
        for begin in range(end):
            if (end - begin < LEAST and n >= LEAST) or not np.isfinite(best[begin][0]):
                continue
            cost, segment = _line(days, values, spread, begin, end, price)
            options.append((best[begin][0] + cost + (price if begin else 0.0), begin, segment))
        if not options:
            best.append((np.inf, []))
            continue
        cost, begin, segment = min(options, key=lambda each: each[0])
        best.append((cost, [*best[begin][1], segment]))
    return best[n][1]


def _line(days: Floats, values: Floats, spread: Floats, begin: int, end: int, price: float) -> tuple[float, Segment]:
    """Return the cheaper of a constant and a sloped line through values `begin` to `end`, with its cost."""
    t, y, weight = days[begin:end], values[begin:end], 1.0 / spread[begin:end] ** 2
    centre, level = np.average(t, weights=weight), np.average(y, weights=weight)
    flat = float(weight @ (y - level) ** 2) + price
    moment = float(weight @ (t - centre) ** 2)
    if end - begin < LEAST or moment == 0.0:
        return flat, Segment(begin, end - 1, float(level), 0.0, float("nan"))
    slope = float(weight @ ((t - centre) * y)) / moment
    sloped = float(weight @ (y - level - slope * (t - centre)) ** 2) + 2.0 * price
    if flat <= sloped:
        return flat, Segment(begin, end - 1, float(level), 0.0, float("nan"))
    return sloped, Segment(begin, end - 1, float(level + slope * (t[0] - centre)), slope, moment**-0.5)
