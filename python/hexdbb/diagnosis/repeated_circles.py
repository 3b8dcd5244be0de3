"""Differences of readings at one angle of a circle that was driven more than once, of one lap each: at other feeds.

What is rough along a circle, as a screw's pitch error that turns by half a turn from one reading to the next, is no
noise, and is the same each time. What a feed changes is smooth for the most part, and goes with the lowest harmonics,
which are removed from each time by itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.samples import Samples

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]

SAME = "record", "circle", "mount", "direction"
"""What sweeps that are compared have in common: where the direction is another, so is what turns over with it."""


def circle_differences(
    samples: Samples, residual_mm: Floats, without_contour: Callable[[Floats, Floats], tuple[Floats, int]]
) -> Iterator[Floats]:
    """Yield the differences between consecutive sweeps of a circle in one direction, in units of one reading's noise.

    Parameters
    ----------
    samples : Samples
    residual_mm : ndarray, shape (n,)
        Of their readings, without what a machine without errors reads.
    without_contour : callable
        Of angles and values of a sweep: the values without the lowest harmonics, and how many numbers these are.
    """
    angle_rad, sweeps = samples["angle_rad"], samples.sweeps()
    left_mm, number = np.empty(len(samples)), np.empty(len(samples), np.int64)
    driven: dict[tuple[int, ...], list[Rows]] = {}
    for place, rows in enumerate(sweeps):
        left, removed = without_contour(angle_rad[rows], residual_mm[rows])
        # As large as the noise is without what the harmonics took of it.
        left_mm[rows], number[rows] = left * np.sqrt(len(rows) / (len(rows) - removed)), place
        driven.setdefault(tuple(int(samples[each][rows[0]]) for each in SAME), []).append(rows)
    # The earlier of two is interpolated: that with more readings.
    ordered = (sorted(times, key=len, reverse=True) for times in driven.values())
    pairs = [np.concatenate(pair) for times in ordered for pair in pairwise(times)]
    yield from _core.lap_differences(angle_rad, number, left_mm, pairs, [0] * len(pairs))
