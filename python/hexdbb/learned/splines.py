"""Penalised splines as Gaussian priors on functions (P-splines; Eilers and Marx 1996).

A function of one variable is B c with cubic B-splines on equal knots. Its prior is c ~ N(0, size^2 T T'),

    (T T')^-1 = roughness D'D + steepness E'E + I,

D second and E first differences of neighbouring coefficients, around the circle where the variable is periodic.
`roughness` states how smooth the function is, `steepness` how nearly constant; they are chosen by marginal likelihood,
which is REML smoothing (Wood 2011).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

DEGREE = 3


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
        wide = _cubics((np.mod(filled - low, high - low)) / (high - low) * count, count)
        wide[:, :DEGREE] += wide[:, count:]
        found: Floats = wide[:, :count]
    else:
        intervals = count - DEGREE
        found = _cubics(np.clip((filled - low) / (high - low), 0.0, 1.0) * intervals, intervals)
    found[~known] = 0.0
    return found


def _cubics(place: Floats, intervals: int) -> Floats:
    """Return the cubic B-splines of equal knots at places counted in intervals, shape (n, intervals + 3).

    The four that are not zero in an interval are cubics of the part t of it that is passed (de Boor 1978, chapter IX).
    """
    interval = np.minimum(place.astype(np.intp), intervals - 1)
    t = place - interval
    left = 1.0 - t
    square, left_square = t * t, left * left
    cube, left_cube = square * t, left_square * left  # a power of an array takes twenty times as long
    parts = (left_cube, 3.0 * cube - 6.0 * square + 4.0, 3.0 * left_cube - 6.0 * left_square + 4.0, cube)
    width = intervals + DEGREE
    found = np.zeros(len(place) * width)
    first = width * np.arange(len(place)) + interval
    for later, part in enumerate(parts):
        found[first + later] = part / 6.0
    return found.reshape(-1, width)


@lru_cache(maxsize=512)
def prior_factor(count: int, roughness: float, steepness: float = 0.0, *, periodic: bool = False) -> Floats:
    """Return T of the prior covariance T T' of a spline's coefficients, shape (count, count)."""
    if count < DEGREE:
        return np.eye(count)
    first = np.roll(np.eye(count), 1, axis=1) - np.eye(count)
    second = np.roll(np.eye(count), 1, axis=1) - 2.0 * np.eye(count) + np.roll(np.eye(count), -1, axis=1)
    if not periodic:
        first, second = first[:-1], second[1:-1]
    covariance = np.linalg.inv(roughness * second.T @ second + steepness * first.T @ first + np.eye(count))
    factor: Floats = np.linalg.cholesky(covariance)
    return factor
