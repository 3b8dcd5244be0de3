"""Lines through a value over time: which grows, how fast, and which records are far off.

Model: value = a + b t + noise; least squares, weighted by the values' sigmas where they have one, uncertainties widened
where points scatter by more than these say. Points far off are told apart first: one after the other, the point with
the largest residual over that which the others lead to expect (externally studentised) is left out, and all up to the
last that is not chance are far off (Rosner's generalised test), so that two cannot hide one another.
What is named is not chance: its probability, multiplied by the number of slopes or points tried (Bonferroni), is below
`CHANCE`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtr, stdtrit

from hexdbb.fleet.observed import Floats, Series

DAYS_PER_YEAR = 365.25
LEAST_POINTS = 4
"""Points of a line at least: two more than it has values, so that their scatter is known at all."""
LEAST_FOR_OUTLIERS = 8
"""Points at least before one is called far off: with fewer, their scatter is not known well enough."""
OUTLIERS_PART = 0.25
"""Largest part of a series that is far off: with more, it is the machine that changed."""
CHANCE = 0.01
"""Probability that chance alone names a slope in a fleet where nothing grows."""


@dataclass(frozen=True, eq=False)
class Growth:
    """A line through a series.

    Attributes
    ----------
    series : Series
    outliers : ndarray of bool, shape (n,)
    slope, low, high : float
        Unit of the value a year; limits of the 95 % interval. nan with too few points.
    at_first, at_last : float
        The line at the first and the last point.
    p : float
        Probability of such a slope by chance; 1 where there is none.
    """

    series: Series
    outliers: NDArray[np.bool_]
    slope: float
    low: float
    high: float
    at_first: float
    at_last: float
    p: float

    @property
    def change(self) -> float:
        """From the first point to the last."""
        return self.at_last - self.at_first


def grown(series: Sequence[Series]) -> list[Growth]:
    """Return the line through each series."""
    tried = sum(len(each.value) for each in series)
    return [_line(each, tried) for each in series]


def significant(lines: Sequence[Growth]) -> list[Growth]:
    """Return the lines whose slopes are not chance, those that chance makes least first."""
    tried = [each for each in lines if not np.isnan(each.slope)]
    return sorted(
        (each for each in tried if each.p * len(tried) < CHANCE), key=lambda each: (each.p, -abs(each.change))
    )


def _line(series: Series, tried: int) -> Growth:
    outliers = _far_off(series, tried)
    kept = ~outliers
    years = (series.days - series.days[0]) / DAYS_PER_YEAR
    if kept.sum() < LEAST_POINTS or np.ptp(years[kept]) == 0.0:
        return Growth(series, outliers, np.nan, np.nan, np.nan, np.nan, np.nan, 1.0)
    slope, sigma, at_zero = _least_squares(years[kept], series.value[kept], series.sigma[kept])
    free = int(kept.sum()) - 2
    wide = float(stdtrit(free, 0.975)) * sigma
    p = 2.0 * float(stdtr(free, -abs(slope) / sigma)) if sigma > 0.0 else float(slope == 0.0)
    ends = at_zero + slope * years[[0, -1]]
    return Growth(series, outliers, slope, slope - wide, slope + wide, float(ends[0]), float(ends[1]), p)


def _weights(sigma: Floats) -> tuple[Floats, float]:
    """Return the weights of points, and the least scale of their scatter: one where they have sigmas."""
    known = np.isfinite(sigma).all() and (sigma > 0.0).all()
    return (1.0 / sigma**2, 1.0) if known else (np.ones(len(sigma)), 0.0)


def _least_squares(years: Floats, value: Floats, sigma: Floats) -> tuple[float, float, float]:
    """Return slope, its standard deviation, and the value at year zero."""
    weight, least = _weights(sigma)
    middle = np.average(years, weights=weight)
    spread = float(np.sum(weight * (years - middle) ** 2))
    slope = float(np.sum(weight * (years - middle) * value)) / spread
    at_zero = float(np.average(value, weights=weight)) - slope * float(middle)
    left = value - at_zero - slope * years
    scale = float(np.sum(weight * left**2)) / (len(value) - 2)
    return slope, float(np.sqrt(max(scale, least) / spread)), at_zero


def _far_off(series: Series, tried: int) -> NDArray[np.bool_]:
    """Return which points are far from the line through the others, of so many points tried altogether."""
    count = len(series.value)
    far = np.zeros(count, dtype=bool)
    if count < LEAST_FOR_OUTLIERS or np.ptp(series.days) == 0.0:
        return far
    left_out: list[int] = []
    named = 0
    for _ in range(int(OUTLIERS_PART * count)):
        kept = np.setdiff1d(np.arange(count), left_out)
        place, p = _farthest(series.days[kept] / DAYS_PER_YEAR, series.value[kept], series.sigma[kept])
        left_out.append(int(kept[place]))
        if p * tried < CHANCE:
            named = len(left_out)
    far[left_out[:named]] = True
    return far


def _farthest(years: Floats, value: Floats, sigma: Floats) -> tuple[int, float]:
    """Return the point with the largest externally studentised residual, and its two-sided probability."""
    weight, least = _weights(sigma)
    root = np.sqrt(weight)
    design = np.column_stack([root, root * (years - np.average(years, weights=weight))])
    basis, _ = np.linalg.qr(design)
    seen = root * value
    left = seen - basis @ (basis.T @ seen)
    free = 1.0 - np.sum(basis**2, axis=1)  # part of a point's own noise that stays in its residual
    square = left**2 / np.maximum(free, np.finfo(float).eps)
    scale = np.maximum((np.sum(left**2) - square) / (len(value) - 3), least)
    with np.errstate(divide="ignore", invalid="ignore"):
        size = np.nan_to_num(np.sqrt(square / scale), nan=0.0, posinf=np.inf)
    place = int(np.argmax(size))
    return place, 2.0 * float(stdtr(len(value) - 3, -size[place]))
