"""Reference contours: the radial deviation that a unit error alone causes along the circle (thesis Figures 3.16-3.20).

Two forms: `exact`, the reading with the unit error minus that of the nominal machine by exact kinematics, as in the
thesis; and `first_order`, the derivative times the unit error. The harmonics of a contour,
    contour(angle) = sum over h of amplitude_h cos(h angle - phase_h),
determine which errors one circle can separate: see docs/thesis-tables.md.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.studies.thesis.circular_test import CircularTest
from hexdbb.studies.thesis.unknowns import GEOMETRIC_ERRORS, UNKNOWNS, Unknown, find_unknowns
from hexdbb.units import shown_factor, shown_unit

Floats = NDArray[np.float64]

COLUMNS = ("error", "effect", "element", "parameter", "size", "unit", "angle_deg", "exact_um", "first_order_um")


@dataclass(frozen=True)
class ReferenceContours:
    """Contours of unit errors, one column per error."""

    test: CircularTest
    unknowns: tuple[Unknown, ...]
    exact_mm: Floats
    """Contour of each unit error by exact kinematics, shape (n, errors), mm."""
    first_order_mm: Floats
    """Derivative times unit error, shape (n, errors), mm."""

    @property
    def sizes(self) -> Floats:
        """Unit errors, mm or rad, shape (errors,)."""
        return np.array([each.unit_size for each in self.unknowns])

    def to_csv(self) -> str:
        """Return the contours as CSV text with one row per error and angle; the columns are `COLUMNS`."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(COLUMNS)
        angle_deg = np.degrees(self.test.angle_rad)
        for index, each in enumerate(self.unknowns):
            parameter, factor = each.parameter, shown_factor(each.unit)
            size = f"{each.unit_size * factor:.6g}"
            head = (each.name, parameter.effect, parameter.element, parameter.name, size, shown_unit(each.unit))
            for angle, exact, linear in zip(
                angle_deg, self.exact_mm[:, index], self.first_order_mm[:, index], strict=True
            ):
                writer.writerow((*head, f"{angle:.6g}", _micrometres(exact), _micrometres(linear)))
        return text.getvalue()


def reference_contours(test: CircularTest, errors: Sequence[str] = GEOMETRIC_ERRORS) -> ReferenceContours:
    """Return the reference contours of errors.

    Parameters
    ----------
    test : CircularTest
    errors : sequence of str
        Short names; by default the thesis' 33.

    Raises
    ------
    InputError
        An error is unknown or named twice, or the machine has no pose with one of the unit errors.
    """
    chosen = find_unknowns(errors)
    columns = [each.column for each in chosen]
    sizes = np.array([each.unit_size for each in chosen])
    exact = [test.contour_mm(_alone(each)) for each in chosen]
    return ReferenceContours(test, tuple(chosen), np.column_stack(exact), test.first_order[:, columns] * sizes)


def harmonic_amplitudes(contours: Floats, highest: int) -> Floats:
    """Return the amplitudes of harmonics 0 to `highest` of contours sampled evenly over one turn.

    Parameters
    ----------
    contours : ndarray, shape (n, k)
    highest : int
        At most half the number of samples, exclusive.

    Returns
    -------
    ndarray, shape (highest + 1, k)
        Unit of the contours; harmonic 0 is the mean's absolute value.
    """
    spectrum = np.abs(np.fft.rfft(contours, axis=0))[: highest + 1] / len(contours)
    spectrum[1:] *= 2.0
    return np.asarray(spectrum, dtype=np.float64)


def without_harmonics(contours: Floats, up_to: int) -> Floats:
    """Return contours (n, k), sampled evenly over one turn, with their harmonics 0 to `up_to` removed."""
    spectrum = np.fft.rfft(contours, axis=0)
    spectrum[: up_to + 1] = 0.0
    return np.asarray(np.fft.irfft(spectrum, n=len(contours), axis=0), dtype=np.float64)


def _alone(unknown: Unknown) -> Floats:
    values = np.zeros(len(UNKNOWNS))
    values[unknown.column] = unknown.unit_size
    return values


def _micrometres(value_mm: float) -> str:
    return f"{round(float(value_mm) * 1e3, 6) + 0.0:.6f}"
