"""What makes one choice of circles better than another, given the information M it tells (mount unknowns taken out).

`D`: Bayesian D_s-optimality (Chaloner, Verdinelli, Statistical Science 10(3), 1995; Atkinson, Donev, Optimum
Experimental Designs, 1992): the logarithm by which the volume of uncertainty of the wanted values shrinks,
    log det(M + I) - log det(M_oo + I),   o: all values that are not wanted.
`minmax`: the largest uncertainty made smallest: the smallest singular value of the wanted values' Jacobian, all others
taken out, over the directions that any circle of the grid can tell.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Criterion = Callable[[Floats], Floats]
"""Information (n, m, m) to scores (n,), the larger the better."""
Maker = Callable[[Bools, Floats], Criterion]
"""Makes a criterion of the wanted values, shape (m,), and the information of the whole grid, shape (m, m)."""

RELATIVE_RANK = 1e-10
"""Eigenvalues of information below this part of the largest are rounding: singular values below 1e-5."""


def _shrinkage(wanted: Bools, whole: Floats) -> Criterion:
    others = ~wanted
    prior = np.eye(len(wanted))

    def score(told: Floats) -> Floats:
        with_prior = told + prior
        volume: Floats = np.linalg.slogdet(with_prior)[1] - np.linalg.slogdet(with_prior[:, others][:, :, others])[1]
        return volume

    return score


def _smallest(wanted: Bools, whole: Floats) -> Criterion:
    others = ~wanted

    def left(told: Floats) -> Floats:
        """Information of the wanted values once all others are taken out."""
        cross = told[:, wanted][:, :, others]
        own = told[:, others][:, :, others] + np.eye(int(others.sum()))
        rest: Floats = told[:, wanted][:, :, wanted] - cross @ np.linalg.solve(own, np.swapaxes(cross, 1, 2))
        return rest

    values, vectors = np.linalg.eigh(_without(whole, wanted))
    basis = vectors[:, values > RELATIVE_RANK * values[-1]]

    def score(told: Floats) -> Floats:
        smallest = np.linalg.eigvalsh(basis.T @ left(told) @ basis)[:, 0]
        return np.sqrt(np.maximum(smallest, 0.0))

    return score


CRITERIA: Mapping[str, Maker] = {"D": _shrinkage, "minmax": _smallest}


def criterion(name: str, wanted: Bools, whole: Floats) -> Criterion:
    """Give a criterion by its name.

    Parameters
    ----------
    name : str
        A key of `CRITERIA`.
    wanted : ndarray of bool, shape (m,)
    whole : ndarray, shape (m, m)
        Information of all candidates together.

    Raises
    ------
    InputError
        Where there is none of that name.
    """
    if name not in CRITERIA:
        raise InputError(f"criterion {name}: not known (expected one of {', '.join(CRITERIA)})")
    return CRITERIA[name](wanted, whole)


def _without(whole: Floats, wanted: Bools) -> Floats:
    """Schur complement without any prior, so that what is not told stays exactly zero."""
    others = ~wanted
    cross = whole[np.ix_(wanted, others)]
    own = np.linalg.pinv(whole[np.ix_(others, others)], rcond=RELATIVE_RANK, hermitian=True)
    left: Floats = whole[np.ix_(wanted, wanted)] - cross @ own @ cross.T
    return left
