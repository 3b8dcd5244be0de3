"""Criteria that compare choices of circles, given their information matrix M (mount unknowns eliminated).

`D`: Bayesian D_s-optimality (Chaloner, Verdinelli, Statistical Science 10(3), 1995; Atkinson, Donev, Optimum
Experimental Designs, 1992): the logarithm of the factor by which the volume of uncertainty of the values of interest
shrinks,
    log det(M + I) - log det(M_oo + I),   o: all other values.
`minmax`: the smallest singular value of the Jacobian of the values of interest, all others eliminated, over the
directions that any circle of the grid can determine: the largest uncertainty is made smallest.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.planning.schur import schur_complement

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Criterion = Callable[[Floats], Floats]
"""From information matrices, shape (n, m, m), to scores, shape (n,); the larger the better."""
CriterionMaker = Callable[[Bools, Floats], Criterion]
"""Makes a criterion from which values are of interest, shape (m,), and the information of the whole grid, (m, m)."""

RELATIVE_RANK = 1e-10
"""Eigenvalues of an information matrix below this share of the largest count as zero: the information squares singular
values, and 1e-10 is where rounding of J'J in double precision ends (singular values below 1e-5 of the largest)."""


def _volume_reduction(of_interest: Bools, whole: Floats) -> Criterion:
    others = ~of_interest
    prior = np.eye(len(of_interest))

    def score(information: Floats) -> Floats:
        posterior = information + prior
        volume: Floats = np.linalg.slogdet(posterior)[1] - np.linalg.slogdet(posterior[:, others][:, :, others])[1]
        return volume

    return score


def _smallest_singular_value(of_interest: Bools, whole: Floats) -> Criterion:
    others = ~of_interest
    prior = np.eye(int(others.sum()))
    # Without a prior, so that directions that no circle determines stay exactly zero.
    determined = schur_complement(
        whole[np.ix_(of_interest, of_interest)],
        whole[np.ix_(of_interest, others)],
        whole[np.ix_(others, others)],
        pseudo_inverse_below=RELATIVE_RANK,
    )
    values, vectors = np.linalg.eigh(determined)
    basis = vectors[:, values > RELATIVE_RANK * values[-1]]

    def score(information: Floats) -> Floats:
        left = schur_complement(
            information[:, of_interest][:, :, of_interest],
            information[:, of_interest][:, :, others],
            information[:, others][:, :, others] + prior,
        )
        smallest = np.linalg.eigvalsh(basis.T @ left @ basis)[:, 0]
        return np.sqrt(np.maximum(smallest, 0.0))

    return score


CRITERIA: Mapping[str, CriterionMaker] = {"D": _volume_reduction, "minmax": _smallest_singular_value}


def make_criterion(name: str, of_interest: Bools, whole: Floats) -> Criterion:
    """Return a criterion.

    Parameters
    ----------
    name : str
        A key of `CRITERIA`.
    of_interest : ndarray of bool, shape (m,)
        Values for which the plan is chosen.
    whole : ndarray, shape (m, m)
        Information of all candidates together.

    Raises
    ------
    InputError
        The name is not known.
    """
    if name not in CRITERIA:
        raise InputError(f"criterion {name}: not known (expected one of {', '.join(CRITERIA)})")
    return CRITERIA[name](of_interest, whole)
