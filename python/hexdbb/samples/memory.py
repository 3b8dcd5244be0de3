"""Columns that remember others: `leg_force.lagged@12`, `leg_force.relaxing@12`.

Rubber yields late, grease and warmth follow slowly: what acts is a state as it was some time before. The lag is of
first order, y' = (x - y) / tau, x linear between samples; what relaxes is x - y. Between two sweeps nobody knows what
the machine did: it is taken to have stood where the next one begins.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

NAME = re.compile(r"(?P<column>\w+)\.(?P<how>lagged|relaxing)@(?P<constant_s>[0-9.e+-]+)")
LONGEST = 30.0
"""Time constants in one block of a recursion that is summed at once: e to the 30th is far from the largest number."""


def remembered_of(name: str) -> re.Match[str] | None:
    """Return the parts of the name of a column that remembers another; None where it is not of that kind."""
    return NAME.fullmatch(name)


def remembered_column(
    how: str, constant_s: float, column: Floats, time_s: Floats, sweep: NDArray[np.integer[Any]]
) -> Floats:
    """Return a column that remembers another one, of the same shape.

    Parameters
    ----------
    how : str
        `lagged` or `relaxing`.
    constant_s : float
        Its time constant.
    column : ndarray, shape (n,) or (n, k)
    time_s : ndarray, shape (n,)
        Rising within a sweep.
    sweep : ndarray of int, shape (n,)
    """
    values = np.asarray(column, np.float64).reshape(len(column), -1)
    lagged = np.empty_like(values)
    last: Floats | None = None
    ended_s = 0.0
    begins = np.flatnonzero(np.diff(sweep, prepend=sweep[0] - 1))
    for first, end in zip(begins, np.append(begins[1:], len(values)), strict=True):
        rows = slice(first, end)
        start = values[first]
        if last is not None:
            start = start + (last - start) * np.exp(-max(time_s[first] - ended_s, 0.0) / constant_s)
        lagged[rows] = _lagged(values[rows], (time_s[rows] - time_s[first]) / constant_s, start)
        last, ended_s = lagged[end - 1], float(time_s[end - 1])
    found: Floats = lagged if how == "lagged" else values - lagged
    return found.reshape(column.shape)


def _lagged(values: Floats, at: Floats, start: Floats) -> Floats:
    """Return the lag of values, shape (n, k), from a state on; `at` is the time in time constants, shape (n,)."""
    steps = np.maximum(np.diff(at), 0.0)[:, None]
    part = -np.expm1(-steps)
    # The exact response to a line from one sample to the next.
    ramp = np.where(steps > 1e-6, 1.0 - part / np.maximum(steps, 1e-12), 0.5 * steps)
    added = values[:-1] * (part - ramp) + values[1:] * ramp
    found = np.empty_like(values)
    found[0] = state = start
    first = 0
    while first < len(added):
        last = max(int(np.searchsorted(at, at[first] + LONGEST, "right")) - 1, first + 1)
        grown = np.exp(np.minimum(at[first + 1 : last + 1] - at[first], 2.0 * LONGEST))[:, None]
        found[first + 1 : last + 1] = (state + np.cumsum(added[first:last] * grown, axis=0)) / grown
        state, first = found[last], last
    return found
