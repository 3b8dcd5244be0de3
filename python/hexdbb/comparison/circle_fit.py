"""Circles fitted to a nearly circular path: least squares and minimum zone.

Model: points ``P_i`` of a closed plane path whose radial deviation is small against its radius (a ball bar's path: tens
of micrometres on 100 mm). With ``rho_i(c) = |P_i - c|``:

* least squares circle: ``min over c, R of sum (rho_i(c) - R)^2`` (geometric, not algebraic), by Gauss-Newton from the
  algebraic fit of Kasa;
* minimum zone circle: ``min over c of max rho_i(c) - min rho_i(c)``, the two concentric circles of smallest radial
  separation that enclose the path.

The minimum zone is solved exactly, not by sampling centres. Linearised about a centre, with unit directions ``u_i``, it
is the linear programme ``min Ro - Ri`` subject to ``Ri <= rho_i - u_i . s <= Ro`` in the step ``s``. Its dual has four
equality constraints, so the revised simplex method on the dual keeps four contact points and exchanges one at a time
for the point that violates the zone most; this is the exchange algorithm of Remez, without its difficulty where several
points share one angle. The centre moves by ``s`` and the programme is repeated with the exact radii until it promises
less than 1e-12 of the radius. ``rho_i - rho_j`` is linear in ``c`` up to ``|s|^2/R``, so two or three repetitions are
enough and the local minimum is the global one for any path this module is meant for.

Why a solver of our own: HiGHS (``scipy.optimize.linprog``) for the programme gives the same widths to 1e-9 µm on the
paths of the tests and on noisy ones of 720 to 12,000 points, but takes 8 to 35 times as long per path, and 1.3 to 10
times as long on a working set of points that grows by the violating ones; `hexdbb compare` solves some hundred of them.
The tests hold this solver against HiGHS.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hexdbb.errors import InputError, RunError

FloatArray = npt.NDArray[np.float64]
Contacts = npt.NDArray[np.int64]
"""Numbers of the four columns of the dual that are the basis."""

_RELATIVE_TOLERANCE = 1e-12
"""Step or promised gain, as part of the radius, at which repetitions end: 0.1 pm of 100 mm, some times the rounding."""
_MAX_REPETITIONS = 50
"""Limit of repetitions; paths of a ball bar need two or three."""
_ZERO_WEIGHT = 1e-13
"""Weights and pivots of the simplex method below this are rounding of zero: its columns are of unit size."""


@dataclass(frozen=True)
class FittedCircle:
    """A circle in the path's plane: `centre_mm` (2,) and `radius_mm`."""

    centre_mm: FloatArray
    radius_mm: float


@dataclass(frozen=True)
class Zone:
    """Two concentric circles that enclose a path: `centre_mm` (2,), radii and their separation `width_mm`."""

    centre_mm: FloatArray
    inner_mm: float
    outer_mm: float

    @property
    def width_mm(self) -> float:
        """Radial separation of the two circles."""
        return self.outer_mm - self.inner_mm


def least_squares_circle(points_mm: FloatArray) -> FittedCircle:
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
    origin = points_mm.mean(axis=0)
    centred = points_mm - origin
    centre = 0.5 * _plane(centred, (centred**2).sum(axis=1))
    for _ in range(_MAX_REPETITIONS):
        rho, direction = _polar(centred, centre)
        step = _plane(direction, rho)
        centre = centre + step
        if np.hypot(*step) <= _RELATIVE_TOLERANCE * rho.mean():
            break
    rho, _ = _polar(centred, centre)
    return FittedCircle(centre_mm=centre + origin, radius_mm=float(rho.mean()))


def minimum_zone(points_mm: FloatArray, near_mm: FloatArray | None = None) -> Zone:
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
    centre = least_squares_circle(points_mm).centre_mm if near_mm is None else near_mm
    rho, direction = _polar(points_mm, centre)
    tolerance_mm = _RELATIVE_TOLERANCE * float(rho.mean())
    contacts: Contacts | None = None
    for _ in range(_MAX_REPETITIONS):
        step, promised_mm, contacts = _linear_zone(direction, rho, contacts)
        width_mm = float(np.ptp(rho))
        while True:
            candidate, candidate_direction = _polar(points_mm, centre + step)
            if np.ptp(candidate) < width_mm or width_mm - promised_mm <= tolerance_mm:
                break
            step, promised_mm = step / 2.0, (promised_mm + width_mm) / 2.0
        if width_mm - promised_mm <= tolerance_mm:
            break
        centre, rho, direction = centre + step, candidate, candidate_direction
    return Zone(centre_mm=centre, inner_mm=float(rho.min()), outer_mm=float(rho.max()))


def _require_plane_points(points_mm: FloatArray) -> None:
    if points_mm.ndim != 2 or points_mm.shape[1] != 2 or len(points_mm) < 3:
        raise InputError(f"a circle needs at least 3 points as an (n, 2) array, got shape {points_mm.shape}")
    spread = np.linalg.svd(points_mm - points_mm.mean(axis=0), compute_uv=False)
    if spread[1] <= 1e-9 * spread[0]:
        raise InputError("a circle cannot be fitted: all points lie on one line")


def _plane(places: FloatArray, values: FloatArray) -> FloatArray:
    """Return the slopes (2,) of the plane through values (n,) at places (n, 2), least squares.

    By normal equations: a circle's places are nearly orthogonal columns, and on a short arc what they round is repaired
    by the next repetition.
    """
    centred = places - places.mean(axis=0)
    slopes: FloatArray = np.linalg.solve(centred.T @ centred, centred.T @ (values - values.mean()))
    return slopes


def _polar(points_mm: FloatArray, centre_mm: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return distances (n,) from the centre and unit directions (n, 2)."""
    offset = points_mm - centre_mm
    rho = np.hypot(offset[:, 0], offset[:, 1])
    return rho, offset / rho[:, None]


def _linear_zone(
    direction: FloatArray, rho_mm: FloatArray, near: Contacts | None
) -> tuple[FloatArray, float, Contacts]:
    """Solve ``min Ro - Ri, Ri <= rho_i - u_i . s <= Ro``: the step ``s`` (2,), the separation it promises, contacts.

    The search begins at the contacts of a centre `near` this one, where they still touch from both sides.

    Dual: ``max sum l_i rho_i - sum m_i rho_i`` with ``sum l = sum m = 1``, ``sum l_i u_i = sum m_i u_i``, all >= 0.
    Column ``i`` is point i touching the outer circle, column ``n + i`` point i touching the inner one.
    """
    n = len(rho_mm)
    rho = rho_mm - rho_mm.mean()
    columns = np.zeros((2 * n, 4))
    columns[:n, 0] = columns[n:, 1] = 1.0
    columns[:n, 2:], columns[n:, 2:] = direction, -direction
    gain = np.concatenate([rho, -rho])
    tolerance = 1e-12 * float(np.ptp(rho)) + 1e-15 * float(rho_mm.max())
    basis = near if near is not None and _is_balanced(columns[near]) else _first_basis(direction)
    for _ in range(100 + 2 * n):
        inverse: FloatArray = np.linalg.inv(columns[basis].T).astype(np.float64)
        multipliers = gain[basis] @ inverse
        violation = gain - columns @ multipliers
        entering = int(np.argmax(violation))
        if violation[entering] <= tolerance:
            return multipliers[2:], float(multipliers[0] + multipliers[1]), basis
        basis[_leaving_row(inverse, inverse @ columns[entering])] = entering
    raise RunError(f"the minimum zone of {n} points was not found within the iteration limit")


def _is_balanced(contacts: FloatArray) -> bool:
    """Check whether four contacts, columns of the dual (4, 4), have weights above zero: a basis to begin from."""
    try:
        weights = np.linalg.solve(contacts.T, np.array([1.0, 1.0, 0.0, 0.0]))
    except np.linalg.LinAlgError:
        return False
    return bool((weights > _ZERO_WEIGHT).all())


def _leaving_row(inverse: FloatArray, change: FloatArray) -> int:
    """Return the row of the basis that reaches zero first; ties (two points at one angle) go by the lexicographic rule.

    `inverse` (4, 4) of the basis and `change` (4,) of the basic weights per unit of the entering one.
    """
    weights = inverse[:, 0] + inverse[:, 1]
    weights[np.abs(weights) < _ZERO_WEIGHT] = 0.0
    falling = np.flatnonzero(change > _ZERO_WEIGHT)
    ratios = np.column_stack([weights, inverse])[falling] / change[falling, None]
    return int(falling[np.lexsort(ratios.T[::-1])[0]])


def _first_basis(direction: FloatArray) -> Contacts:
    """Return four contacts a quarter of the points apart, outer and inner in turn, so that the two chords cross."""
    angle = np.arctan2(direction[:, 1], direction[:, 0])
    _, distinct = np.unique(np.round(angle, 9), return_index=True)
    if len(distinct) < 4:
        raise InputError(f"a minimum zone needs points at 4 angles or more, got {len(distinct)}")
    basis: Contacts = distinct[(np.arange(4) * len(distinct)) // 4]
    basis[1::2] += len(direction)
    return basis
