"""The thesis' estimator: linear least squares on reference contours, equations (5.4)-(5.10).

Model: the measured contour is a sum of reference contours, b = A x + r, column k of A being the contour of error k.
Formula: A'A x = A'b, equation (5.4), written out in (5.10); x is in multiples of the unit errors.
Assumptions users get wrong: errors are so small that contours add (docs/thesis-tables.md shows up to where), no error
beside the chosen ones exists, the cup is where planned, and A'A is not singular. It yields no uncertainties.
`hexdbb.diagnosis` assumes none of these.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.identifiability.redundancy import echelon
from hexdbb.record import Record
from hexdbb.studies.thesis.circular_test import CircularTest, record_test
from hexdbb.studies.thesis.unknowns import Unknown, find_unknowns

Floats = NDArray[np.float64]

SINGULAR = 1e-7
"""Ratio of A's smallest to its largest singular value below which A'A counts as singular: A'A squares the ratio, and
1e-14 is where double precision ends. A is that of the derivatives: contours of finite unit errors are never exactly
dependent, because their second-order difference passes for information."""
SMALL = 1e-3
"""Coefficients below this share of the largest are omitted from a sentence, which prints three decimals."""


@dataclass(frozen=True)
class ThesisEstimate:
    """Result of the thesis' estimator."""

    unknowns: tuple[Unknown, ...]
    """The errors assumed to exist."""
    values: Floats
    """Values in mm and rad, shape (errors,); of the smallest norm (in unit errors) where A'A is singular."""
    determined: NDArray[np.bool_]
    """Which values the contour determines, shape (errors,); all unless A'A is singular."""
    rank: int
    """Rank of A."""
    condition: float
    """Condition of A over its rank; that of A'A is the square."""
    dependent: tuple[str, ...]
    """Contours that are combinations of others, one sentence each."""
    rms_before_mm: float
    """RMS of the contour, mm."""
    rms_after_mm: float
    """RMS of the residual, mm."""


def thesis_estimate(
    test: CircularTest, contour_mm: Floats, errors: Sequence[str], *, minimum_norm: bool = False
) -> ThesisEstimate:
    """Estimate errors from a contour by the thesis' equations (5.4)-(5.10).

    Parameters
    ----------
    test : CircularTest
        The circle on which the contour was taken.
    contour_mm : ndarray, shape (n,)
        Radial deviation, mm: reading minus that of the nominal machine.
    errors : sequence of str
        Short names of the errors assumed to exist.
    minimum_norm : bool
        Where A'A is singular, return the solution of smallest norm instead of raising.

    Returns
    -------
    ThesisEstimate

    Raises
    ------
    InputError
        An unknown name, a contour of another length, fewer samples than errors, or a singular A'A, naming the columns
        that coincide.
    """
    chosen = find_unknowns(errors)
    if np.shape(contour_mm) != (test.samples.size,):
        raise InputError(
            f"{test.origin}: contour of shape {np.shape(contour_mm)} (expected ({test.samples.size},), one per sample)"
        )
    if test.samples.size < len(chosen):
        raise InputError(
            f"{test.origin}: {test.samples.size} samples for {len(chosen)} errors (expected at least as many)"
        )
    sizes = np.array([each.unit_size for each in chosen])
    matrix = test.first_order[:, [each.column for each in chosen]] * sizes
    known = _core.identifiability(matrix, relative=SINGULAR)
    dependent = tuple(coinciding(known.unidentifiable, chosen))
    if dependent and not minimum_norm:
        raise InputError(
            f"{test.origin}: A'A of equation (5.4) is singular, rank {known.rank} of {len(chosen)}: "
            + "; ".join(dependent)
            + " (expected errors whose contours are independent: leave these out)"
        )
    amounts = _minimum_norm(matrix, contour_mm, known) if dependent else _normal_equations(matrix, contour_mm)
    return ThesisEstimate(
        unknowns=tuple(chosen),
        values=amounts * sizes,
        determined=np.asarray((np.abs(known.unidentifiable) <= SINGULAR).all(axis=1)),
        rank=known.rank,
        condition=known.condition,
        dependent=dependent,
        rms_before_mm=rms(contour_mm),
        rms_after_mm=rms(contour_mm - matrix @ amounts),
    )


def thesis_estimate_record(record: Record, errors: Sequence[str], *, minimum_norm: bool = False) -> ThesisEstimate:
    """Estimate errors from all samples of a record with one mount by the thesis' equations (5.4)-(5.10).

    Raises
    ------
    InputError
        As `thesis_estimate` and `record_test`.
    """
    test = record_test(record)
    return thesis_estimate(test, record.reading_mm - test.nominal_mm, errors, minimum_norm=minimum_norm)


def coinciding(null_space: Floats, chosen: Sequence[Unknown]) -> list[str]:
    """Return sentences that name reference contours which are combinations of others.

    Parameters
    ----------
    null_space : ndarray, shape (errors, k)
        Directions that change no contour, in unit errors, as columns.
    chosen : sequence of Unknown
    """
    if not null_space.shape[1]:
        return []
    rows, pivots = echelon(null_space)
    sentences = []
    for row, pivot in sorted(zip(rows, pivots, strict=True), key=lambda each: each[1]):
        terms = [
            (float(-amount), chosen[k].name)
            for k, amount in enumerate(row)
            if k != pivot and abs(amount) > SMALL * np.abs(row).max()
        ]
        name = chosen[pivot].name
        sentences.append(f"{name} = {_combination(terms)}" if terms else f"{name} has no contour")
    return sentences


def _combination(terms: Sequence[tuple[float, str]]) -> str:
    (first, name), *others = terms
    more = (f" {'-' if amount < 0 else '+'} {abs(amount):.3f} {other}" for amount, other in others)
    return f"{first:.3f} {name}{''.join(more)}"


def _normal_equations(matrix: Floats, contour_mm: Floats) -> Floats:
    # Equation (5.10)
    return np.asarray(np.linalg.solve(matrix.T @ matrix, matrix.T @ contour_mm))


def _minimum_norm(matrix: Floats, contour_mm: Floats, known: _core.Identifiability) -> Floats:
    seen = known.identifiable
    return np.asarray(seen @ _normal_equations(matrix @ seen, contour_mm))


def rms(values: Floats) -> float:
    """Return the root mean square of all values."""
    return float(np.sqrt(np.mean(np.square(values))))
