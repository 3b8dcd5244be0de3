"""Elimination of nuisance values from information matrices: the Schur complement."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def schur_complement(
    kept: Floats, cross: Floats, eliminated: Floats, *, pseudo_inverse_below: float | None = None
) -> Floats:
    """Return the information on the kept values once the others are eliminated: A - B C^-1 B'.

    Parameters
    ----------
    kept, cross, eliminated : ndarray, shapes (..., m, m), (..., m, k), (..., k, k)
        A, B, C: blocks of symmetric information matrices.
    pseudo_inverse_below : float, optional
        Where given, C may be singular: its eigenvalues below this share of the largest count as zero.

    Returns
    -------
    ndarray, shape (..., m, m)
    """
    transposed = np.swapaxes(cross, -1, -2)
    if pseudo_inverse_below is None:
        left: Floats = kept - cross @ np.linalg.solve(eliminated, transposed)
    else:
        left = kept - cross @ np.linalg.pinv(eliminated, rcond=pseudo_inverse_below, hermitian=True) @ transposed
    return left
