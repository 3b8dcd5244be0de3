"""Penalised splines as Gaussian priors on functions (P-splines; Eilers and Marx 1996).

A function of one variable is B c with cubic B-splines on equal knots. Its prior is c ~ N(0, tau^2 Q) with

    Q^-1 proportional to roughness D'D + I,

D second differences of neighbouring coefficients (around the circle where the variable is periodic), scaled so that the
function's mean variance over the samples is tau^2: tau is the size of the function in mm, `roughness` says how smooth
it is. Both are chosen or averaged over by marginal likelihood, which is REML smoothing (Wood 2011).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline

Floats = NDArray[np.float64]

DEGREE = 3


def knots(low: float, high: float, count: int) -> Floats:
    """Return equal knots, shape (count + 4,), whose `count` cubic B-splines sum to one from `low` to `high`."""
    step = (high - low) / (count - DEGREE)
    found: Floats = low + step * np.arange(-DEGREE, count + 1, dtype=np.float64)
    return found


def design(values: Floats, low: float, high: float, count: int, *, periodic: bool = False) -> Floats:
    """Return the design matrix of a spline.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Rows of values that are not known are zero; those beyond the range are taken at its end.
    low, high : float
        Range; the period's ends where periodic.
    count : int
        Number of columns.
    periodic : bool
        Whether the function is the same at both ends, with its slope and curvature.

    Returns
    -------
    ndarray, shape (n, count)
    """
    known = ~np.isnan(values)
    own = knots(low, high, count)
    inside = np.clip(np.where(known, values, low), own[DEGREE], own[count])
    if periodic:
        turns = low + np.mod(np.where(known, values, low) - low, high - low)
        wide = BSpline.design_matrix(turns, knots(low, high, count + DEGREE), DEGREE).toarray()
        wide[:, :DEGREE] += wide[:, count:]
        found: Floats = wide[:, :count]
    else:
        found = BSpline.design_matrix(inside, own, DEGREE).toarray()
    found[~known] = 0.0
    return found


def prior_factor(count: int, roughness: float, *, periodic: bool = False) -> Floats:
    """Return T with Q = T T' for coefficients of a spline, not scaled yet; shape (count, count)."""
    if count < DEGREE:
        return np.eye(count)
    second = np.roll(np.eye(count), 1, axis=1) - 2.0 * np.eye(count) + np.roll(np.eye(count), -1, axis=1)
    if not periodic:
        second = second[1:-1]
    covariance = np.linalg.inv(roughness * second.T @ second + np.eye(count))
    factor: Floats = np.linalg.cholesky(covariance)
    return factor
