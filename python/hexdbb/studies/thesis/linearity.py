"""The size of errors up to which the thesis' linear estimator holds, compared with the exact diagnosis.

Setting, the same for both: the seven errors of Table 5.5, one level circle, ball in the joint plane, cup known, one lap
with the gauge's noise. In every draw each error has a random sign and a size between half the stated one and all of it;
rotations count as lengths at `ARM_MM`. The error of the linear estimate grows with the square of the size, because
contours add to first order only; that of the exact estimate stays that of the noise.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.studies.thesis.circular_test import CircularTest, joint_plane_test
from hexdbb.studies.thesis.estimator import rms, thesis_estimate
from hexdbb.studies.thesis.simulated import GAUGE_NOISE_UM
from hexdbb.studies.thesis.tables import SEVEN, all_values
from hexdbb.studies.thesis.unknowns import UNKNOWNS

Floats = NDArray[np.float64]

ARM_MM = 400.0
"""Lever arm by which a rotation counts as a length, of the size of a leg: 2 mm correspond to 5 mrad."""
SIZES_MM = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0)
"""From where the noise dominates to where readings leave the range of a gauge."""
RANGE_MM = 1.0
"""Largest reading of a common ball bar, to either side."""
DRAWS = 12
"""Draws per size: 12 times 7 values determine an RMS to 8 %."""
SEED = 54
UNITS = np.array([ARM_MM if UNKNOWNS[name].unit == "rad" else 1.0 for name in SEVEN])


@dataclass(frozen=True)
class LinearityRow:
    """Errors of both estimates for given errors of one size, over draws and the seven errors, rotations at `ARM_MM`."""

    size_mm: float
    linear_rms_mm: float
    exact_rms_mm: float
    linear_largest_mm: float
    exact_largest_mm: float
    peak_reading_mm: float
    """Largest reading of any draw."""


@dataclass(frozen=True)
class LinearityStudy:
    """Rows of growing size, and where the curves cross."""

    rows: tuple[LinearityRow, ...]
    noise_rms_mm: float
    """Standard deviation of a linear estimate due to the gauge noise alone, root mean square of the seven errors."""
    curvature_per_mm: float
    """c in: noise-free error of the linear estimate = c size², root mean square of the seven, at the smallest size."""
    curvature_of_lengths_per_mm: float
    """The same where the five lengths alone are given, and the rotations are zero."""
    curvature_of_rotations_per_mm: float
    """The same where the two rotations alone are given; size is that of their lengths at `ARM_MM`."""

    @property
    def break_mm(self) -> float:
        """Size of the given errors at which the neglected terms cause as large an error as the noise, mm."""
        return self.break_at_mm(self.curvature_per_mm)

    def break_at_mm(self, curvature_per_mm: float) -> float:
        """Return the size, mm, at which the neglected terms of this curvature cause as large an error as the noise."""
        return float(np.sqrt(self.noise_rms_mm / curvature_per_mm))

    @property
    def range_mm(self) -> float:
        """Size at which the largest reading reaches `RANGE_MM`, interpolated between rows, mm."""
        peaks, sizes = ([getattr(row, name) for row in self.rows] for name in ("peak_reading_mm", "size_mm"))
        return float(np.interp(RANGE_MM, peaks, sizes))


@cache
def linearity_study() -> LinearityStudy:
    """Return the errors of both estimators for growing given errors."""
    test, rng = joint_plane_test(), np.random.default_rng(SEED)
    patterns = rng.uniform(0.5, 1.0, (DRAWS, len(SEVEN))) * rng.choice([-1.0, 1.0], (DRAWS, len(SEVEN)))
    noise = rng.normal(0.0, GAUGE_NOISE_UM / 1e3, (DRAWS, test.samples.size))
    rows = tuple(_row(test, size_mm, patterns, noise) for size_mm in SIZES_MM)
    columns = [UNKNOWNS[name].column for name in SEVEN]
    scaled = test.first_order[:, columns] / UNITS
    variances = np.diag(np.linalg.inv(scaled.T @ scaled)) * (GAUGE_NOISE_UM / 1e3) ** 2
    is_rotation = UNITS != 1.0
    return LinearityStudy(
        rows=rows,
        noise_rms_mm=float(np.sqrt(variances.mean())),
        curvature_per_mm=_curvature_per_mm(test, patterns),
        curvature_of_lengths_per_mm=_curvature_per_mm(test, patterns * ~is_rotation),
        curvature_of_rotations_per_mm=_curvature_per_mm(test, patterns * is_rotation),
    )


def _curvature_per_mm(test: CircularTest, patterns: Floats) -> float:
    """Return c of error = c size² of the linear estimate without noise, root mean square over draws and errors."""
    size_mm, no_noise = SIZES_MM[0], np.zeros(test.samples.size)
    errors_mm = [_linear(test, size_mm * each, no_noise)[0] for each in patterns]
    return rms(np.array(errors_mm)) / size_mm**2


def _row(test: CircularTest, size_mm: float, patterns: Floats, noise: Floats) -> LinearityRow:
    linear, exact, peaks = [], [], []
    for pattern, added in zip(patterns, noise, strict=True):
        given = size_mm * pattern
        error_mm, contour_mm = _linear(test, given, added)
        linear.append(error_mm)
        exact.append(_exact(test, contour_mm) - given)
        peaks.append(np.abs(contour_mm).max())
    return LinearityRow(
        size_mm=size_mm,
        linear_rms_mm=rms(np.array(linear)),
        exact_rms_mm=rms(np.array(exact)),
        linear_largest_mm=float(np.abs(linear).max()),
        exact_largest_mm=float(np.abs(exact).max()),
        peak_reading_mm=float(max(peaks)),
    )


def _linear(test: CircularTest, given_mm: Floats, noise_mm: Floats) -> tuple[Floats, Floats]:
    """Return the error of the linear estimate (rotations at the arm), and the contour it was made from."""
    contour_mm = test.contour_mm(all_values(SEVEN, given_mm / UNITS)) + noise_mm
    return thesis_estimate(test, contour_mm, SEVEN).values * UNITS - given_mm, contour_mm


def _exact(test: CircularTest, contour_mm: Floats) -> Floats:
    """Return the estimate of the engine's diagnosis with the same seven errors free, rotations at the arm."""
    free = [name in SEVEN for name in UNKNOWNS]
    model = test.model(np.zeros(len(UNKNOWNS))).engine()
    result = _core.fit(model, test.samples, test.nominal_mm + contour_mm, noise_mm=GAUGE_NOISE_UM / 1e3, free=free)
    return np.asarray(result.values[[UNKNOWNS[name].column for name in SEVEN]] * UNITS)
