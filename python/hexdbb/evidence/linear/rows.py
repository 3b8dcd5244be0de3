"""Rows of the evidence: blocks of neighbouring readings, and the numbers of the groups that they belong to."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.intp]
Floats = NDArray[np.float64]

ARCS = 20
"""Arcs of a sweep: a left-out one lasts some seconds, less than what warms or settles takes."""
ARC_GROUPS = 5
"""Groups that arcs belong to in turn: each is predicted from four fifths of the readings."""


def blocks_of(sweep: NDArray[np.integer], max_rows: int) -> tuple[Ints, Ints]:
    """Cut sweeps into blocks of neighbouring readings: first row and length of each."""
    length = max(1, int(np.ceil(len(sweep) / max_rows)))
    edges = np.concatenate([[0], np.flatnonzero(np.diff(sweep)) + 1, [len(sweep)]])
    begin = np.concatenate(
        [
            np.linspace(first, last, max(1, round((last - first) / length)) + 1)[:-1].round()
            for first, last in pairwise(edges)
        ]
    ).astype(np.intp)
    return begin, np.diff(np.append(begin, len(sweep)))


def middles_of(begin: Ints, count: Ints, sliders_mm: Floats, within_mm: float) -> tuple[Ints, Ints]:
    """Shorten blocks to their middles, in which no slider travels further: first row and length of each.

    A mean over half a turn of a screw is none of the pitch error there.

    Parameters
    ----------
    begin, count : ndarray of int, shape (blocks,)
    sliders_mm : ndarray, shape (n, 6)
    within_mm : float
    """
    last = begin + count - 1
    travel_mm = np.max(np.abs(sliders_mm[last] - sliders_mm[begin]), axis=1) / np.maximum(count - 1, 1)
    longest = np.floor(within_mm / np.maximum(travel_mm, within_mm / count)).astype(np.intp)
    kept = np.clip(longest, 1, count)
    return begin + (count - kept) // 2, kept


def means_of(values: Floats, begin: Ints, count: Ints) -> Floats:
    """Return the mean of some values in each block."""
    until = np.concatenate([[0.0], np.cumsum(values)])
    found: Floats = (until[begin + count] - until[begin]) / count
    return found


def codes_of(values: NDArray[np.generic]) -> Ints:
    """Return the number of each row's value among the different ones, from 0."""
    codes: Ints = np.unique(values, return_inverse=True)[1].ravel()
    return codes


def arcs_of(sweep: Ints) -> Ints:
    """Return the group of the arc in which each row lies."""
    found = np.empty(len(sweep), np.intp)
    for each in np.unique(sweep):
        rows = np.flatnonzero(sweep == each)
        found[rows] = np.arange(len(rows)) * ARCS // len(rows) % ARC_GROUPS
    return found
