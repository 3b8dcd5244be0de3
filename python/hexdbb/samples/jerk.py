"""Jerk of the sliders: what a feed-forward of it does, or what a structure answers to it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.samples.over_time import sweeps_of

Floats = NDArray[np.float64]

JERK = "jerk_mm_s3"
JERK_FROM = ("acceleration_mm_s2", "time_s", "sweep")
"""Columns that it follows from."""
LEAST = 3
"""Samples of a sweep from which a rate is taken."""


def jerk_mm_s3(acceleration_mm_s2: Floats, time_s: Floats, sweep: NDArray[np.integer[Any]]) -> Floats:
    """Return the rate of the accelerations within each sweep, shape (n, 6); zero in one of fewer than three samples.

    Parameters
    ----------
    acceleration_mm_s2 : ndarray, shape (n, 6)
        Of the sliders; smooth, as the engine derives it.
    time_s : ndarray, shape (n,)
    sweep : ndarray of int, shape (n,)
    """
    found = np.zeros_like(acceleration_mm_s2)
    for rows in sweeps_of(sweep):
        if rows.stop - rows.start >= LEAST:
            found[rows] = np.gradient(acceleration_mm_s2[rows], time_s[rows], axis=0)
    return found
