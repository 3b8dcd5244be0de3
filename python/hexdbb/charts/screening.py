"""Screening of a line to the resolution of a display: fewer points, the same picture.

Of each column of the display the first and last point and those with the smallest and largest value are kept (M4:
Jugel, Jerzak, Hackenbroich, Markl, "M4: a visualization-oriented time series data aggregation", PVLDB 7(10), 2014). A
line through these covers the same pixels as one through all points, so that no peak is lost, however short; averages
and every n-th point lose them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Indices = NDArray[np.intp]

KEPT_PER_COLUMN = 4
"""First, last, smallest and largest."""


def screened(x: ArrayLike, y: ArrayLike, columns: int) -> Indices:
    """Choose the points of a line that a display of some columns needs.

    Parameters
    ----------
    x : array_like, shape (n,)
        Ascending; equal values allowed, nan not.
    y : array_like, shape (n,)
        Where it is nan the line breaks; such points are kept, one for each run of them.
    columns : int
        Width of the drawing in pixels; on paper, 2 for each mm are enough.

    Returns
    -------
    ndarray of int
        Places of the points kept, ascending; all of them where there are at most four for each column.
    """
    across, value = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    if len(across) <= KEPT_PER_COLUMN * columns:
        return np.arange(len(across))
    there = np.flatnonzero(np.isfinite(value))
    broken = np.flatnonzero(~np.isfinite(value))
    broken = broken[np.diff(broken, prepend=-2) > 1]
    if not len(there):
        return broken
    width = across[-1] - across[0]
    place = (across[there] - across[0]) * (columns / width if width > 0.0 else 0.0)
    column = np.minimum(place.astype(np.intp), columns - 1)
    begins = np.flatnonzero(np.diff(column, prepend=-1))
    ends = np.append(begins[1:], len(column)) - 1
    by_value = np.lexsort((value[there], column))
    kept = np.concatenate([begins, ends, by_value[begins], by_value[ends]])
    return np.unique(np.concatenate([there[kept], broken]))
