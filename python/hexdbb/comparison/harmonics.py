"""Harmonics of the residual around one circle: r(a) = c + sum over n of A_n cos(n a - p_n), least squares.

Order 1 is what a shifted cup leaves, order 2 an ellipse (squareness), order 3 what the threefold symmetry of the
guideways makes; orders far above are slides, screws and noise. Assumption: the capture is a full circle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hexdbb.comparison.iso230 import FloatArray

HIGHEST_ORDER = 12
"""Highest order fitted; what is above depends on sliders' positions (screws) or on time, not on the angle."""


@dataclass(frozen=True)
class Harmonic:
    """One harmonic: amplitude (mm), and phase p (rad, from -pi to pi), the angle of its first crest times the order."""

    order: int
    amplitude_mm: float
    phase_rad: float


def harmonics(angle_rad: FloatArray, residual_mm: FloatArray, highest: int = HIGHEST_ORDER) -> tuple[Harmonic, ...]:
    """Fit harmonics 1 to `highest`, with a constant, to the residual of a full circle.

    Parameters
    ----------
    angle_rad, residual_mm : (n,) arrays
        More samples than 2 `highest` + 1; with fewer the highest orders are left out.
    highest : int

    Returns
    -------
    tuple of Harmonic
        In order.
    """
    orders = np.arange(1, min(highest, (len(angle_rad) - 2) // 2) + 1)
    turned = np.outer(angle_rad, orders)
    basis = np.column_stack([np.cos(turned), np.sin(turned), np.ones(len(angle_rad))])
    values = np.linalg.lstsq(basis, residual_mm, rcond=None)[0]
    cosine, sine = values[: len(orders)], values[len(orders) : 2 * len(orders)]
    return tuple(
        Harmonic(int(order), float(np.hypot(c, s)), float(np.arctan2(s, c)))
        for order, c, s in zip(orders, cosine, sine, strict=True)
    )
