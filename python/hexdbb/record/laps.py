"""Laps counted from the polar angle, for records of programs that do not count them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

ROUNDING_TURNS = 1e-6
"""Limits by how much of a turn a sample may lie before the start of a lap and still belong to it: above the rounding
of angles written with 4 decimals (3e-7 turns), below the distance of two samples at 100,000 samples per lap."""
NEEDED = ("sweep", "direction", "angle_deg")


def counted_laps(columns: Mapping[str, Any]) -> NDArray[np.float64] | None:
    """Count the turns completed since the first sample of each sweep.

    Assumes that consecutive samples of a sweep lie less than half a turn apart; angles may be wrapped or not. A last
    sample that closes a turn belongs to it: a lap of one sample is none, and nothing could be predicted from it.

    Parameters
    ----------
    columns : mapping of str to array_like, each of shape (n,)

    Returns
    -------
    ndarray, shape (n,), or None
        None where `sweep`, `direction` or `angle_deg` are missing too. Laps are 0 where these are not numbers: the
        check of the record names what is wrong with them.
    """
    if any(name not in columns for name in NEEDED):
        return None
    sweep, direction, angle_deg = (np.asarray(columns[name], dtype=np.float64) for name in NEEDED)
    laps = np.zeros(len(angle_deg))
    for each in np.unique(sweep[np.isfinite(sweep)]):
        rows = np.flatnonzero(sweep == each)
        steps = np.diff(angle_deg[rows], prepend=angle_deg[rows[0]])
        turned = np.cumsum(((steps + 180.0) % 360.0 - 180.0) * direction[rows]) / 360.0
        laps[rows] = np.floor(np.nan_to_num(turned) + ROUNDING_TURNS)
        if len(rows) > 1 and laps[rows[-1]] > laps[rows[-2]]:
            laps[rows[-1]] = laps[rows[-2]]
    return np.maximum(laps, 0.0)
