"""Rows of each uninterrupted capture."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def rows_of_sweeps(sweep: NDArray[np.integer[Any]]) -> list[NDArray[np.intp]]:
    """Return the rows of each sweep, rising, in the order in which the sweeps begin.

    Parameters
    ----------
    sweep : ndarray of int, shape (n,)
        Number of the capture of each row.
    """
    changes = np.flatnonzero(np.diff(sweep)) + 1
    runs = np.split(np.arange(len(sweep)), changes) if len(sweep) else []
    found: dict[int, list[NDArray[np.intp]]] = {}
    for run in runs:  # one for each sweep, unless rows of several alternate
        found.setdefault(int(sweep[run[0]]), []).append(run)
    return [np.concatenate(each) if len(each) > 1 else each[0] for each in found.values()]
