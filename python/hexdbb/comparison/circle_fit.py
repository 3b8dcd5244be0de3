"""Circles fitted to a nearly circular path: least squares and minimum zone, by the engine (`circle_fit.hpp`).

Why a solver of our own: HiGHS (``scipy.optimize.linprog``) for the minimum zone's linear programme gives the same
widths to 1e-9 µm on the paths of the tests and on noisy ones of 720 to 12,000 points, but takes far longer; `hexdbb
compare` solves some hundred of them. The tests hold the engine's solver against HiGHS.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hexdbb import _core
from hexdbb.errors import InputError, RunError

FloatArray = npt.NDArray[np.float64]


def least_squares_circle(points_mm: FloatArray) -> _core.FittedCircle:
    """Fit the circle with the smallest sum of squared radial distances to the points.

    Parameters
    ----------
    points_mm : (n, 2) array
        At least three points that do not lie on one line.

    Raises
    ------
    InputError
        Fewer than three points, or all on one line.
    """
    _require_plane_points(points_mm)
    try:
        return _core.least_squares_circle(points_mm)
    except ValueError as error:
        raise InputError(str(error)) from None


def minimum_zone(points_mm: FloatArray) -> _core.Zone:
    """Find the two concentric circles of smallest radial separation that enclose the points.

    Parameters
    ----------
    points_mm : (n, 2) array
        At least four points, seen from their centre at different angles.
    near_mm : (2,) array, optional
        Centre of their least squares circle, where it is known: there the search begins.

    Raises
    ------
    InputError
        Fewer than four points at different angles, or all on one line.
    """
    _require_plane_points(points_mm)
    try:
        return _core.minimum_zone(points_mm)
    except ValueError as error:
        raise InputError(str(error)) from None
    except RuntimeError as error:
        raise RunError(str(error)) from None


def _require_plane_points(points_mm: FloatArray) -> None:
    if points_mm.ndim != 2 or points_mm.shape[1] != 2 or len(points_mm) < 3:
        raise InputError(f"a circle needs at least 3 points as an (n, 2) array, got shape {points_mm.shape}")
