"""Distinct rows of several columns, by whole numbers: `numpy.unique` by rows compares bytes, ten times slower."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.intp]


def distinct_rows(*columns: NDArray[Any]) -> tuple[Ints, Ints]:
    """Find the distinct combinations of the values of some columns, each of shape (n,).

    Returns
    -------
    first : ndarray of int, shape (k,)
        First row of each combination; they are in ascending order of the first column, then of the second, and so on.
    member : ndarray of int, shape (n,)
        Combination of each row, from 0.
    """
    # Neighbours are mostly alike: of each run of equal rows its first one stands for all.
    changes = np.zeros(max(len(columns[0]) - 1, 0), np.bool_)
    for column in columns:
        changes |= column[1:] != column[:-1]
    begins = np.concatenate([np.zeros(min(len(columns[0]), 1), np.intp), np.flatnonzero(changes) + 1])
    member = np.zeros(len(begins), np.intp)
    first = np.zeros(min(len(member), 1), np.intp)
    for column in columns:
        values, code = np.unique(column[begins], return_inverse=True)
        _, first, member = np.unique(member * len(values) + code, return_index=True, return_inverse=True)
    return begins[first], np.repeat(member, np.diff(begins, append=len(columns[0])))


def rows_by_number(member: Ints) -> list[Ints]:
    """Return the rows of each number from 0, rising; `member`, of shape (n,), holds every number up to its largest."""
    order = np.argsort(member, kind="stable")
    return np.split(order, np.cumsum(np.bincount(member))[:-1])
