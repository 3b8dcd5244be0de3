"""Offset of a circle's cup in the circle's plane, found from the readings, and the radial error without it.

Model: the ball runs on its commanded circle R u(a), u = (cos a, sin a); the bar reads its distance from a cup at c in
the plane, d = |R u - c|, exactly. Least squares over c and a constant (the circle may be too large), by Gauss-Newton.
The centre of a least squares circle through the points d u is the same to first order in c / R; of second order it
leaves an ellipse of c^2 / R, 1 um for 0.3 mm and a bar of 90 mm, this leaves nothing.
Assumption: a cup out of the plane by z makes the circle larger by z^2 / 2 R, which one circle's readings do not
determine; it stays.
"""

from __future__ import annotations

import numpy as np

from hexdbb.comparison.iso230 import FloatArray

STEPS = 5
"""Gauss-Newton steps: each reduces the error by c / R, 0.01 at most, so that 5 reach rounding."""


def without_set_up_mm(angle_rad: FloatArray, distance_mm: FloatArray, radius_mm: float) -> FloatArray:
    """Return the radial error of each sample without the cup's offset.

    Parameters
    ----------
    angle_rad, distance_mm : (n,) arrays
        Commanded polar angle, and distance of ball and cup as read, of all samples of one set-up.
    radius_mm : float
        Of the commanded circle.

    Returns
    -------
    (n,) array
        Distance as read less that of the commanded ball from the cup where it is found.
    """
    ball_mm = radius_mm * np.column_stack([np.cos(angle_rad), np.sin(angle_rad)])
    cup_mm = np.zeros(2)
    for _ in range(STEPS):
        bar_mm = ball_mm - cup_mm
        length_mm = np.hypot(*bar_mm.T)
        design = np.vstack([-bar_mm.T / length_mm, np.ones(len(bar_mm))])
        # By normal equations: columns are nearly orthogonal on a full circle; on an arc the next step repairs rounding.
        cup_mm = cup_mm + np.linalg.solve(design @ design.T, design @ (distance_mm - length_mm))[:2]
    left_mm: FloatArray = distance_mm - np.hypot(*(ball_mm - cup_mm).T)
    return left_mm
