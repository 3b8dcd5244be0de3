"""The lowest harmonics of a sweep's angle as an orthonormal basis: the smooth part of a contour."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

RIDGE = 1e-9
"""Added to the mean square of a column: the harmonics of a short arc depend on each other to rounding."""


def orthonormal_harmonics(angle_rad: Floats, highest: int) -> Floats:
    """Return a constant and harmonics 1 to `highest` of some angles as orthonormal columns.

    Parameters
    ----------
    angle_rad : ndarray, shape (n,)
    highest : int

    Returns
    -------
    ndarray, shape (n, 1 + 2 highest)
        Nearly orthogonal already over whole turns, so that a Cholesky factor suffices.
    """
    turn = np.exp(1j * angle_rad)
    powers = np.cumprod(np.broadcast_to(turn, (highest, len(turn))), axis=0)  # one exponential instead of `highest`
    basis = np.vstack([np.ones((1, len(turn))), powers.real, powers.imag])
    factor = np.linalg.cholesky(basis @ basis.T + RIDGE * len(turn) * np.eye(len(basis)))
    orthonormal: Floats = np.linalg.solve(factor, basis).T
    return orthonormal
