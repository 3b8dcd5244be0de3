"""Is anything missing? What a model leaves unexplained, tested against noise.

Two questions, because either alone can be deceived:
level      Is the residual larger than the noise? The noise is that of repeated laps, else as stated; its own
uncertainty counts.
           A fault that is as fast as the sampling shows here only.
shape      Is the residual smooth? On every sweep the residual is split into what a Fourier series of `HARMONICS`
harmonics of the angle
           takes and the rest; were the residual white, both would have the same variance: an F-test that needs no
           stated noise. A gauge noisier or quieter than stated does not deceive it. Noise that changes slowly is smooth
           as well, but differs from lap to lap: where laps are repeated, what they share must exceed what they do not.
           Where none are, noise that lasts for some readings is known by its spectrum (`lasting_noise.py`): the
           harmonics must exceed what it has there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis.lasting_noise import LastingNoise, LowestPower
from hexdbb.diagnosis.noise import Noise
from hexdbb.samples import Samples
from hexdbb.samples.distinct import distinct_rows, rows_by_number

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]

HARMONICS = 8
LEAST_ROWS = 40
"""A sweep needs this many samples for its harmonics and a rest to compare them with."""
WHOLE_LAP = 0.95
"""Part of the longest lap's samples that a lap must have: harmonics of an arc are no harmonics of the circle."""
NOISE_DOUBT = {"repeated laps": 0.01, "stated": 0.03, "repeated circles": 0.03, "roughness": 0.03}
"""Relative uncertainty of the noise by where it comes from, beside that of its tails (`Noise.tail`)."""
MAX_PREPARED = 400_000
"""Rows up to which the harmonics are kept: 17 columns of them take 54 MB. Of more readings they are made anew for each
test, sweep by sweep, so that memory does not grow by them."""
LEVEL_SIGMAS = 4.0
SHAPE_P = 1e-4


@dataclass(frozen=True)
class LackOfFit:
    """Outcome of the two tests.

    Attributes
    ----------
    rms_um, noise_um : float
        RMS residual, and standard deviation of one reading.
    level : float
        The residual's excess over the noise in standard deviations of that excess.
    shape_p : float
        Probability of so smooth a residual by chance; where laps are repeated, of one that they share so far.
    smooth_um : float
        RMS of the smooth part beyond what the rest of the residual leads one to expect there.
    """

    rms_um: float
    noise_um: float
    level: float
    shape_p: float
    smooth_um: float

    @property
    def is_significant(self) -> bool:
        """Whether something is missing."""
        return self.level > LEVEL_SIGMAS or self.shape_p < SHAPE_P

    @property
    def unexplained_um(self) -> float:
        """RMS beyond the noise: the level's where it is larger than the noise's own uncertainty, else the shape's."""
        beyond = float(np.sqrt(max(self.rms_um**2 - self.noise_um**2, 0.0))) if self.level > LEVEL_SIGMAS else 0.0
        return max(beyond, self.smooth_um)


@dataclass(frozen=True)
class Part:
    """Sum of squares of a part of a residual, mm², and its degrees of freedom."""

    square: float
    freedom: int

    @property
    def variance(self) -> float:
        """Mean square of one degree of freedom."""
        return self.square / self.freedom


class FitTest:
    """Tests residuals of some records, again and again: up to `MAX_PREPARED` rows, harmonics are prepared once.

    Parameters
    ----------
    samples : Samples
    noise : Noise
        Of one reading.
    """

    def __init__(self, samples: Samples, noise: Noise) -> None:
        self._noise = noise
        self._angle_rad, self._time_s = samples["angle_rad"], samples["time_s"]
        self._sweeps = [rows for rows in samples.sweeps() if len(rows) >= LEAST_ROWS]
        self._laps = list(_repeated_laps(samples["sweep"], samples["lap"]))
        self._prepared = self._harmonics(self._sweeps) if len(samples) <= MAX_PREPARED else None

    def of(self, residual_mm: Floats, fitted_values: int) -> LackOfFit:
        """Test a residual for anything but noise.

        Parameters
        ----------
        residual_mm : ndarray, shape (n,)
            Of all samples.
        fitted_values : int
            Number of values the fit has adjusted: so much smooth residual it may have taken away.
        """
        count = len(residual_mm)
        rms_mm = float(np.sqrt(residual_mm @ residual_mm / max(count - fitted_values, 1)))
        doubt = np.linalg.norm([NOISE_DOUBT[self._noise.source], self._noise.tail, np.sqrt(0.5 / count)])
        level = (rms_mm / self._noise.sigma_mm - 1.0) / doubt
        shape_p, smooth_mm = self._shape(residual_mm, fitted_values)
        return LackOfFit(rms_mm * 1e3, self._noise.sigma_mm * 1e3, float(level), shape_p, smooth_mm * 1e3)

    def _harmonics(self, captures: Sequence[Rows]) -> _core.CaptureHarmonics:
        return _core.CaptureHarmonics(self._angle_rad, captures, HARMONICS)

    def _split(self, residual_mm: Floats) -> tuple[Floats, Floats]:
        """Return the components of every sweep along its harmonics, shape (k, 17), and what is left, shape (n,)."""
        if self._prepared is not None:
            return self._prepared.split(residual_mm)
        taken, left = np.zeros((len(self._sweeps), 1 + 2 * HARMONICS)), np.zeros_like(residual_mm)
        for place, rows in enumerate(self._sweeps):
            own = _core.CaptureHarmonics(self._angle_rad[rows], [np.arange(len(rows))], HARMONICS)
            taken[place : place + 1], left[rows] = own.split(residual_mm[rows])
        return taken, left

    def _shape(self, residual_mm: Floats, fitted_values: int) -> tuple[float, float]:
        taken, left = self._split(residual_mm)
        smooth = Part(float(np.sum(taken**2)), taken.size - fitted_values)
        rest = Part(float(left @ left), sum(map(len, self._sweeps)) - taken.size)
        if smooth.freedom <= 0 or rest.freedom <= 0:
            return 1.0, 0.0
        noise = LowestPower(rest.variance, rest.freedom, 1.0)
        if not self._laps and rest.square > 0.0:
            noise = self._lasting(left).lowest_power()
        chance = _core.f_tail(smooth.freedom * noise.alike, noise.freedom, smooth.variance / noise.variance)
        if chance < SHAPE_P:
            chance = max(chance, self._shared_by_laps(residual_mm, fitted_values))
        beyond = max(smooth.square - smooth.freedom * noise.variance, 0.0) / len(residual_mm)
        return chance, float(np.sqrt(beyond)) if chance < SHAPE_P else 0.0

    def _lasting(self, left_mm: Floats) -> LastingNoise:
        lasting = LastingNoise(HARMONICS)
        for rows in self._sweeps:
            lasting.add(left_mm[rows], _step_s(self._time_s[rows]))
        return lasting

    def _shared_by_laps(self, residual_mm: Floats, fitted_values: int) -> float:
        """Return the probability of laps so alike by chance; 0 where too few are repeated.

        An analysis of variance of the harmonics of single laps: their mean in a sweep against their scatter about it.
        """
        shared, scatter, shared_freedom, scatter_freedom = 0.0, 0.0, -fitted_values, 0
        for laps in self._laps:
            together = np.concatenate(laps)
            ends = np.cumsum([0, *map(len, laps)])
            own = [np.arange(*each) for each in pairwise(ends)]
            parts, _ = _core.CaptureHarmonics(self._angle_rad[together], own, HARMONICS).split(residual_mm[together])
            mean = parts.mean(axis=0)
            shared += len(laps) * float(mean @ mean)
            scatter += float(np.sum((parts - mean) ** 2))
            shared_freedom += len(mean)
            scatter_freedom += (len(laps) - 1) * len(mean)
        if shared_freedom <= 0 or scatter_freedom <= 0 or scatter <= 0.0:
            return 0.0
        return _core.f_tail(shared_freedom, scatter_freedom, shared / shared_freedom * scatter_freedom / scatter)


def _step_s(time_s: Floats) -> float:
    """Return the mean time between a sweep's readings; one second where times were not measured."""
    span_s = float(time_s[-1] - time_s[0])
    return span_s / (len(time_s) - 1) if span_s > 0.0 else 1.0


def _repeated_laps(sweep: Rows, lap: Rows) -> Iterator[list[Rows]]:
    """Yield the rows of every whole lap, sweep by sweep, where there are two or more of enough rows."""
    first, member = distinct_rows(sweep, lap)
    of_sweep: dict[int, list[Rows]] = {}
    for row, rows in zip(first, rows_by_number(member), strict=True):
        of_sweep.setdefault(int(sweep[row]), []).append(rows)
    for laps in of_sweep.values():
        least = max(LEAST_ROWS, WHOLE_LAP * max(map(len, laps)))
        whole = [each for each in laps if len(each) >= least]
        if len(whole) > 1:
            yield whole
