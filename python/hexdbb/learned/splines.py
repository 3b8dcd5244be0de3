"""Penalised splines as Gaussian priors on functions (P-splines; Eilers and Marx 1996).

A function of one variable is B c with cubic B-splines on equal knots. Its prior is c ~ N(0, size^2 T T'),

    (T T')^-1 = roughness D'D + I,

D second differences of neighbouring coefficients, around the circle where the variable is periodic. `roughness` states
how smooth the function is; it is chosen by marginal likelihood, which is REML smoothing (Wood 2011).
"""

from __future__ import annotations

from functools import lru_cache

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
        Rows of values that are nan are zero; those beyond the range are taken at its end.
    low, high : float
        Range; the ends of one period where periodic.
    count : int
        Number of columns.
    periodic : bool
        Whether the function has the same value, slope and curvature at both ends.

    Returns
    -------
    ndarray, shape (n, count)
    """
    known = ~np.isnan(values)
    filled = np.where(known, values, low)
    if periodic:
        turned = low + np.mod(filled - low, high - low)
        wide = BSpline.design_matrix(turned, knots(low, high, count + DEGREE), DEGREE).toarray()
        wide[:, :DEGREE] += wide[:, count:]
        found: Floats = wide[:, :count]
    else:
        own = knots(low, high, count)
        found = BSpline.design_matrix(np.clip(filled, own[DEGREE], own[count]), own, DEGREE).toarray()
    found[~known] = 0.0
    return found


@lru_cache(maxsize=512)
def prior_factor(count: int, roughness: float, *, periodic: bool = False) -> Floats:
    """Return T of the prior covariance T T' of a spline's coefficients, shape (count, count)."""
    if count < DEGREE:
        return np.eye(count)
    second = np.roll(np.eye(count), 1, axis=1) - 2.0 * np.eye(count) + np.roll(np.eye(count), -1, axis=1)
    if not periodic:
        second = second[1:-1]
    covariance = np.linalg.inv(roughness * second.T @ second + np.eye(count))
    factor: Floats = np.linalg.cholesky(covariance)
    return factor
