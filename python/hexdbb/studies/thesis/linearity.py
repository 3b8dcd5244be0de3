"""Up to which size of errors the thesis' linear estimator holds, beside the exact diagnosis on the same readings.

Setting: the seven errors of Table 5.5, one level circle, ball in the joint plane, cup known, one lap with the gauge's
noise. Every draw gives each error a size of its own between half and all of the stated one, with a random sign; turns
count as lengths at `ARM_MM`. The linear estimator's error grows with the square of the size, because contours add to
first order only; the exact one's stays that of the noise.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.studies.thesis.circular_test import CircularTest, joint_plane_test
from hexdbb.studies.thesis.estimator import thesis_estimate
from hexdbb.studies.thesis.simulated import GAUGE_NOISE_UM
from hexdbb.studies.thesis.tables import SEVEN, all_values
from hexdbb.studies.thesis.unknowns import UNKNOWNS

Floats = NDArray[np.float64]

ARM_MM = 400.0
"""Arm at which a turn counts as a length: 2 mm go with 5 mrad."""
SIZES_MM = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0)
RANGE_MM = 1.0
"""Largest reading of a ball bar's gauge, to either side."""
DRAWS = 12
SEED = 54
UNITS = np.array([ARM_MM if UNKNOWNS[name].unit == "rad" else 1.0 for name in SEVEN])


@dataclass(frozen=True)
class LinearityRow:
    """Errors of both estimators for given errors of one size."""

    size_mm: float
    linear_rms_mm: float
    exact_rms_mm: float
    """Over draws and the seven errors, turns at `ARM_MM`."""
    linear_largest_mm: float
    exact_largest_mm: float
    peak_reading_mm: float
    """Largest reading of any draw."""


@dataclass(frozen=True)
class LinearityStudy:
    """Rows of growing size, and where the curves cross."""

    rows: tuple[LinearityRow, ...]
    noise_rms_mm: float
    """What the gauge's noise alone does to a linear estimate (standard deviation, root mean square of the seven)."""
    curvature_per_mm: float
    """c in: noise-free error of the linear estimate = c size², root mean square of the seven, at the smallest size."""
    curvature_of_lengths_per_mm: float
    """The same where the five lengths alone are given, and the turns are zero."""
    curvature_of_turns_per_mm: float
    """The same where the two turns alone are given; size is that of their lengths at `ARM_MM`."""

    @property
    def break_mm(self) -> float:
        """Size of the given errors at which the neglected terms do as much as the noise."""
        return self.break_at_mm(self.curvature_per_mm)

    def break_at_mm(self, curvature_per_mm: float) -> float:
        """Size at which the neglected terms of this curvature do as much as the noise."""
        return float(np.sqrt(self.noise_rms_mm / curvature_per_mm))

    @property
    def range_mm(self) -> float:
        """Size at which the largest reading leaves a gauge's `RANGE_MM`, between the rows on either side of it."""
        peaks, sizes = ([getattr(row, name) for row in self.rows] for name in ("peak_reading_mm", "size_mm"))
        return float(np.interp(RANGE_MM, peaks, sizes))


@cache
def linearity_study() -> LinearityStudy:
    """Run both estimators on growing errors."""
    test, rng = joint_plane_test(), np.random.default_rng(SEED)
    patterns = rng.uniform(0.5, 1.0, (DRAWS, len(SEVEN))) * rng.choice([-1.0, 1.0], (DRAWS, len(SEVEN)))
    noise = rng.normal(0.0, GAUGE_NOISE_UM / 1e3, (DRAWS, test.samples.size))
    rows = tuple(_row(test, size_mm, patterns, noise) for size_mm in SIZES_MM)
    columns = [UNKNOWNS[name].column for name in SEVEN]
    scaled = test.first_order[:, columns] / UNITS
    variances = np.diag(np.linalg.inv(scaled.T @ scaled)) * (GAUGE_NOISE_UM / 1e3) ** 2
    is_turn = UNITS != 1.0
    return LinearityStudy(
        rows=rows,
        noise_rms_mm=float(np.sqrt(variances.mean())),
        curvature_per_mm=_curvature_per_mm(test, patterns),
        curvature_of_lengths_per_mm=_curvature_per_mm(test, patterns * ~is_turn),
        curvature_of_turns_per_mm=_curvature_per_mm(test, patterns * is_turn),
    )


def _curvature_per_mm(test: CircularTest, patterns: Floats) -> float:
    """Fit error = c size² of the linear estimate without noise, root mean square over draws and errors: c."""
    size_mm, silent = SIZES_MM[0], np.zeros(test.samples.size)
    misses = [_linear(test, size_mm * each, silent)[0] for each in patterns]
    return _rms(np.array(misses)) / size_mm**2


def _row(test: CircularTest, size_mm: float, patterns: Floats, noise: Floats) -> LinearityRow:
    linear, exact, peaks = [], [], []
    for pattern, added in zip(patterns, noise, strict=True):
        given = size_mm * pattern
        miss, contour_mm = _linear(test, given, added)
        linear.append(miss)
        exact.append(_exact(test, contour_mm) - given)
        peaks.append(np.abs(contour_mm).max())
    return LinearityRow(
        size_mm=size_mm,
        linear_rms_mm=_rms(np.array(linear)),
        exact_rms_mm=_rms(np.array(exact)),
        linear_largest_mm=float(np.abs(linear).max()),
        exact_largest_mm=float(np.abs(exact).max()),
        peak_reading_mm=float(max(peaks)),
    )


def _linear(test: CircularTest, given_mm: Floats, noise_mm: Floats) -> tuple[Floats, Floats]:
    """Miss of the linear estimate (turns at the arm), and the contour it was made from."""
    contour_mm = test.contour_mm(all_values(SEVEN, given_mm / UNITS)) + noise_mm
    return thesis_estimate(test, contour_mm, SEVEN).values * UNITS - given_mm, contour_mm


def _exact(test: CircularTest, contour_mm: Floats) -> Floats:
    """Estimate of the engine's diagnosis with the same seven errors free, turns at the arm."""
    free = [name in SEVEN for name in UNKNOWNS]
    model = test.model(np.zeros(len(UNKNOWNS))).engine()
    result = _core.fit(model, test.samples, test.nominal_mm + contour_mm, noise_mm=GAUGE_NOISE_UM / 1e3, free=free)
    return np.asarray(result.values[[UNKNOWNS[name].column for name in SEVEN]] * UNITS)


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
