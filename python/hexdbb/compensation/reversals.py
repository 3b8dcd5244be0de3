"""Directions of travel of sliders along a known motion, and how a change of direction is spread over time.

A slider that rests has the direction of the nearer motion, so that it changes over in the middle of its rest. The
change, a step from -1 to +1 or back, is smoothed by three moving averages of n cycles each: the second difference of a
step of height D is then at most D / n^2, the third at most 2 D / n^3.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

Floats = NDArray[np.float64]

REST_MM = 1e-9
"""Largest slider motion from row to row that counts as rest, mm: the rounding of inverse kinematics stays below it."""


def travel_directions(sliders_mm: Floats, before: Floats | None = None, after: Floats | None = None) -> Floats:
    """Return each slider's direction of travel: +1 where its coordinate grows, -1 where it falls.

    Parameters
    ----------
    sliders_mm : ndarray, shape (n, 6)
        Slider coordinates in order of motion, mm.
    before, after : ndarray, shape (6,), optional
        Directions of travel before the first and after the last row; by default those of the first and last motion.

    Returns
    -------
    ndarray, shape (n, 6)
        A resting slider has the direction of the nearer motion, `before` and `after` included; 0 where a slider never
        moves.
    """
    steps = np.diff(sliders_mm, axis=0)
    moved = np.where(np.abs(steps) > REST_MM, np.sign(steps), 0.0)
    # A row belongs to the motion that leads to it; the first row to the motion that leaves it.
    direction = np.vstack([moved[:1] if len(moved) else np.zeros((1, 6)), moved])
    rows = np.arange(len(direction))
    columns = [
        _nearest(direction[:, k], rows, None if before is None else before[k], None if after is None else after[k])
        for k in range(direction.shape[1])
    ]
    return np.column_stack(columns)


def smooth_changes(direction: Floats, cycles: int) -> Floats:
    """Return directions of travel (n,) smoothed by three moving averages of an odd number of cycles, ends held."""
    for _ in range(3 if cycles > 1 else 0):
        direction = uniform_filter1d(direction, cycles, mode="nearest")
    return np.clip(direction, -1.0, 1.0)


def _nearest(direction: Floats, rows: NDArray[np.intp], before: float | None, after: float | None) -> Floats:
    known, value = np.flatnonzero(direction), direction[direction != 0.0]
    if before is not None:
        known, value = np.append(-1, known), np.append(before, value)
    if after is not None:
        known, value = np.append(known, len(direction)), np.append(value, after)
    if not len(known):
        return np.zeros(len(direction))
    right = np.clip(np.searchsorted(known, rows), 0, len(known) - 1)
    left = np.clip(right - 1, 0, None)
    nearer_left = np.abs(rows - known[left]) < np.abs(known[right] - rows)
    found: Floats = np.where(nearer_left, value[left], value[right])
    return found
