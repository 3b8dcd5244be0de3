"""Laps counted from the angle, for records of programs that do not count them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

ALMOST = 1e-6
"""Of a turn: a sample meant to be the first of a lap must not fall into the one before it by rounding."""
NEEDED = ("sweep", "direction", "angle_deg")


def counted_laps(columns: Mapping[str, Any]) -> NDArray[np.float64] | None:
    """Count the turns since each sweep began; neighbouring samples lie less than half a turn apart.

    Parameters
    ----------
    columns : mapping of str to array_like, each of shape (n,)

    Returns
    -------
    ndarray, shape (n,), or None
        None where sweep, direction or angle are missing too. Where these are no numbers laps are 0: what is wrong with
        them is said when they are checked.
    """
    if any(name not in columns for name in NEEDED):
        return None
    sweep, direction, angle_deg = (np.asarray(columns[name], dtype=np.float64) for name in NEEDED)
    laps = np.zeros(len(angle_deg))
    for each in np.unique(sweep[np.isfinite(sweep)]):
        rows = np.flatnonzero(sweep == each)
        steps = np.diff(angle_deg[rows], prepend=angle_deg[rows[0]])
        turned = np.cumsum(((steps + 180.0) % 360.0 - 180.0) * direction[rows]) / 360.0
        laps[rows] = np.floor(np.nan_to_num(turned) + ALMOST)
    return np.maximum(laps, 0.0)
