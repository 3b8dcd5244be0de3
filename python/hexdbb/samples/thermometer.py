"""Smoothing of a thermometer's readings: parts of a machine warm slowly, readings of a sensor scatter.

Model: within half a minute the temperature changes evenly; every reading is replaced by the value there of the line
through its neighbours of the same sweep, by least squares.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

HALF_WINDOW_S = 30.0
"""Half the time over which the temperature changes evenly: short against a machine's time constants of many minutes,
long against the sensor's sampling."""


def smoothed(time_s: Floats, sweep: NDArray[np.integer], temperature_c: Floats) -> Floats:
    """Return the temperatures without the sensor's noise.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Rising within a sweep.
    sweep : ndarray of int, shape (n,)
    temperature_c : ndarray, shape (n,)

    Returns
    -------
    ndarray, shape (n,)
        nan in a sweep that has one.
    """
    out = np.empty(len(time_s))
    for each in np.unique(sweep):
        rows = np.flatnonzero(sweep == each)
        out[rows] = _local_lines(time_s[rows], temperature_c[rows])
    return out


def _local_lines(time_s: Floats, values: Floats) -> Floats:
    first = np.searchsorted(time_s, time_s - HALF_WINDOW_S, "left")
    last = np.searchsorted(time_s, time_s + HALF_WINDOW_S, "right")
    t, y = time_s - time_s.mean(), values - values.mean()
    count, t1, t2, y1, ty = (_sums(each, first, last) for each in (np.ones_like(t), t, t * t, y, t * y))
    spread = count * t2 - t1**2
    slope = np.divide(count * ty - t1 * y1, spread, out=np.zeros_like(t), where=spread > 0.0)
    line: Floats = values.mean() + (y1 + slope * (count * t - t1)) / count
    return line


def _sums(values: Floats, first: NDArray[np.intp], last: NDArray[np.intp]) -> Floats:
    """Return the sums over rows [first, last)."""
    running = np.concatenate([[0.0], np.cumsum(values)])
    summed: Floats = running[last] - running[first]
    return summed
