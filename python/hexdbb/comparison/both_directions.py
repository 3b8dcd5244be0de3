"""Residuals of the two directions of one circle, combined: the part common to both, and the part that reverses.

Half the sum is what the machine does at a place from either direction: geometry, screws. Half the difference reverses
with the direction: backlash, lag, a gauge read late. Averages over arcs of `ARC_DEG` degrees of commanded angle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hexdbb.comparison.iso230 import FloatArray

ARC_DEG = 5
"""Width of an arc: short against the orders of interest (12 periods a turn are 30 degrees); a divisor of 360."""


@dataclass(frozen=True)
class BothDirections:
    """Half the sum and half the difference (counter-clockwise minus clockwise) of the residuals, arc by arc.

    Attributes
    ----------
    angle_rad : (m,) array
        Middle of each arc that has samples of both directions.
    half_sum_mm, half_difference_mm : (m,) arrays
        (ccw + cw) / 2 and (ccw - cw) / 2.
    """

    angle_rad: FloatArray
    half_sum_mm: FloatArray
    half_difference_mm: FloatArray


def both_directions(ccw: tuple[FloatArray, FloatArray], cw: tuple[FloatArray, FloatArray]) -> BothDirections | None:
    """Return half the sum and half the difference; each direction is angle (rad) and residual (mm), shape (n,).

    Returns
    -------
    BothDirections or None
        None where no arc has samples of both.
    """
    first, second = _arc_means(*ccw), _arc_means(*cw)
    shared = np.isfinite(first) & np.isfinite(second)
    if not shared.any():
        return None
    middle_rad = np.radians((np.flatnonzero(shared) + 0.5) * ARC_DEG)
    return BothDirections(middle_rad, (first + second)[shared] / 2.0, (first - second)[shared] / 2.0)


def _arc_means(angle_rad: FloatArray, residual_mm: FloatArray) -> FloatArray:
    """Return the mean over each arc; nan where there is no sample."""
    count = 360 // ARC_DEG
    # The small summand keeps an angle that is meant to be the start of an arc out of the arc before it.
    arc = np.floor(np.degrees(angle_rad) / ARC_DEG + 1e-9).astype(np.int64) % count
    samples = np.bincount(arc, minlength=count)
    mean_mm = np.full(count, np.nan)
    np.divide(np.bincount(arc, residual_mm, count), samples, out=mean_mm, where=samples > 0)
    return mean_mm
