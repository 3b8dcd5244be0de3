"""The lowest harmonics of a sweep's angle as an orthonormal basis: the smooth part of a contour."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core

Floats = NDArray[np.float64]


def orthonormal_harmonics(angle_rad: Floats, highest: int) -> Floats:
    """Return a constant and harmonics 1 to `highest` of some angles as orthonormal columns.

    Parameters
    ----------
    angle_rad : ndarray, shape (n,)
    highest : int

    Returns
    -------
    ndarray, shape (n, 1 + 2 highest)
        Each column is orthogonal to those before it.
    """
    return _core.orthonormal_harmonics(angle_rad, highest)
