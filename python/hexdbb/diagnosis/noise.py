"""Noise of the readings: from repeated laps, else the gauge specification, else repeated circles or roughness.

Repeated laps: the slider positions of two laps at one angle differ by micrometres only, so the difference of their
readings is noise, whatever the machine's errors are (pure error, in the terms of regression). What a machine without
errors reads at the measured slider positions is subtracted first: axes that oscillate by a micrometre, which their
encoders measure, are not noise; rounding of the encoders is. The sweep's lowest harmonics are removed from both, so
that the contour's curvature between two readings does not count; with the earlier lap then interpolated linearly
between two readings at part f, white noise s makes differences of variance s^2 (1 + f^2 + (1 - f)^2). Stated: the
gauge's standard deviation with its rounding (`hexdbb.plan.Gauge`). Roughness: second differences of neighbouring
readings, harmonics removed as well, cancel what changes smoothly; of white noise s they have the standard deviation
sqrt(6) s. Where a circle that was driven again, of one lap each time, repeats much better than that
(`repeated_circles.py`), what is rough is no noise. Differences beyond `CLIP` standard deviations are jumps and do not
count in either; the variance that this removes from normal noise is restored. Noise may have longer tails than normal
noise, and laps sampled at different angles about a jump appear to have them: the relative excess of the standard
deviation within `TAIL` is an uncertainty of the estimate. Nor do the first parts of laps count where their differences
are far larger than the usual: what settles after a start is in the first lap alone, and is no noise. A median would be
robust too, but the readings are rounded, so that it could only be one of few values. What rounding is the same in all
laps is added (`rounding.py`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis.repeated_circles import circle_differences
from hexdbb.diagnosis.rounding import with_rounding
from hexdbb.model import new_model
from hexdbb.plan import LEAST_NOISE_MM
from hexdbb.samples import Samples, predict

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]
Source = Literal["repeated laps", "stated", "repeated circles", "roughness"]

MIN_REPEATS = 100
"""Repeated readings below which laps are not used: a standard deviation from n differences scatters by 1 / sqrt(2 n),
7 % here."""
HARMONICS = 8
"""Harmonics removed from a sweep: what geometry, play and screw errors put into a contour lies below, nearly all."""
READINGS_PER_VALUE = 5
"""Readings for each harmonic's coefficient at least: fewer harmonics are removed from a shorter sweep."""
CLIP = 3.0
"""Standard deviations beyond which a difference is a jump: one in 370 of normal noise."""
TAIL = 6.0
"""Standard deviations within which the tail of noise lies, the same from which a reading stands alone (`glitches.py`).
Of Student's t with five degrees of freedom three say 7 % too little, 4.5 say 3 %, six say 2 %."""
MAX_JUMPS = 0.1
"""Share of jumps that the start of the iteration stands: more than any gauge seen, far below one half."""
ROUNDS = 20
"""Iterations of clipping: the clipped variance settles within a few."""
PARTS = 8
"""Parts of a lap whose differences are compared: what settles after a start does so within a few of them."""
REPEATS = 0.7
"""Noise of repeated circles over that of neighbouring readings, below which it counts: half the variance of these was
then no noise. Of white noise both say the same; of two blind records with 0.39 and 0.79 µm they said 0.40 and 0.82."""
SETTLES = 1.5
"""Times the usual difference from which the first parts of laps hold something that settles, no noise: parts of one
noise scatter by a tenth, differ by a third where a screw turns by much between two readings; gauges that stick and
brakes that are released late made it two to five."""


@dataclass(frozen=True)
class Noise:
    """Standard deviation of one reading, and its source.

    Attributes
    ----------
    sigma_mm : float
    source : str
    tail : float
        Relative excess of the standard deviation if longer tails than those of normal noise are included.
    rough_mm : float
        Noise between neighbouring readings, from second differences of the laps' differences: equal to `sigma_mm` if
        the noise is white, lower if it is correlated. Infinite if not estimated, as for gauges with a stated noise.
    """

    sigma_mm: float
    source: Source
    tail: float = 0.0
    rough_mm: float = float("inf")


def noise_of(samples: Samples) -> Noise:
    """Estimate the noise of the readings of some samples; of several gauges the noisiest counts."""
    repeated = list(lap_differences(samples))
    if sum(map(len, repeated)) >= MIN_REPEATS:
        found = _estimate_from(_steady(repeated), "repeated laps")
        found = replace(found, sigma_mm=with_rounding(samples, found.sigma_mm))
        if stated_noise(samples) is not None:
            return found
        return replace(found, rough_mm=with_rounding(samples, _roughness(repeated)))
    stated = stated_noise(samples)
    if stated is not None:
        return stated
    residual_mm = less_nominal_mm(samples)
    rough = [
        np.diff(_without_contour(samples["angle_rad"][rows], residual_mm[rows]), n=2) / np.sqrt(6.0)
        for rows in samples.sweeps()
    ]
    found = _estimate_from(np.concatenate(rough), "roughness")
    again = list(circle_differences(samples, residual_mm, _without_harmonics))
    if sum(map(len, again)) < MIN_REPEATS:
        return found
    repeated_circles = _estimate_from(_steady(again), "repeated circles")
    repeated_circles = replace(repeated_circles, sigma_mm=with_rounding(samples, repeated_circles.sigma_mm))
    return repeated_circles if repeated_circles.sigma_mm < REPEATS * found.sigma_mm else found


def residual_repeats_to(samples: Samples, residual_mm: Floats) -> float:
    """Return the noise (mm) of what a model leaves, from repeated laps; infinite where none are repeated."""
    repeated = list(lap_differences(samples, residual_mm))
    return with_rounding(samples, _robust_sigma(_steady(repeated))) if repeated else float("inf")


def repeats_but_for_shifts(samples: Samples) -> float:
    """Return the noise (mm) of repeated laps less by how much each lies above the next; infinite without such laps."""
    repeated = [each - each.mean() for each in lap_differences(samples) if len(each)]
    return with_rounding(samples, _robust_sigma(_steady(repeated))) if repeated else float("inf")


def stated_noise(samples: Samples) -> Noise | None:
    """Return the noise as the gauges' specifications state it, the noisiest; None where one of them states none."""
    stated = [samples.records[each].gauge.stated_noise_mm for each in np.unique(samples["record"])]
    known = [each for each in stated if each is not None]
    return Noise(max(known), "stated") if known and len(known) == len(stated) else None


def _roughness(repeated: Sequence[Floats]) -> float:
    return _robust_sigma(np.concatenate([np.diff(each, n=2) / np.sqrt(6.0) for each in repeated]))


def _estimate_from(values: Floats, source: Source) -> Noise:
    """Estimate the noise from differences scaled to the standard deviation of one reading."""
    sigma = _robust_sigma(values)
    return Noise(sigma, source, max(_within(np.abs(values), TAIL, sigma) / sigma - 1.0, 0.0))


def _steady(repeated: Sequence[Floats]) -> Floats:
    """Return laps' differences, less those of the first parts of laps where something settles."""
    whole = np.concatenate(repeated)
    part = np.concatenate([np.arange(len(each)) * PARTS // len(each) for each in repeated])
    parts = [whole[part == number] for number in range(PARTS)]
    if min(map(len, parts)) < MIN_REPEATS:
        return whole
    largest = [_quantile(np.abs(each), 1.0 - MAX_JUMPS) for each in parts]
    usual = SETTLES * float(np.median(largest))
    first = next(place for place, each in enumerate(largest) if each <= usual)
    return np.concatenate(parts[first:]) if first else whole


def _quantile(values: Floats, share: float) -> float:
    """Return a quantile of finite values: `numpy.quantile` takes five times longer for some thousands of them."""
    place = share * (len(values) - 1)
    low = int(place)
    high = min(low + 1, len(values) - 1)
    ordered = np.partition(values, (low, high))
    return float(ordered[low] + (place - low) * (ordered[high] - ordered[low]))


def _robust_sigma(values: Floats) -> float:
    if not len(values):
        return LEAST_NOISE_MM
    size = np.abs(values)
    sigma = _quantile(size, 1.0 - MAX_JUMPS) / NormalDist().inv_cdf(1.0 - MAX_JUMPS / 2.0)
    if sigma == 0.0:  # coarsely rounded readings are mostly alike
        sigma = float(np.sqrt(np.mean(values**2)))
    for _ in range(ROUNDS):
        before, sigma = sigma, _within(size, CLIP, sigma)
        if sigma == before:
            break
    return max(sigma, LEAST_NOISE_MM)


def _within(size: Floats, most: float, sigma: float) -> float:
    """Estimate the standard deviation of normal noise from its values up to `most * sigma`."""
    kept = size[size <= most * sigma]
    variance = 1.0 - 2.0 * most * NormalDist().pdf(most) / math.erf(most / math.sqrt(2.0))
    return float(np.sqrt(np.mean(kept**2) / variance)) if len(kept) else 0.0


def lap_differences(
    samples: Samples, residual_mm: Floats | None = None, sweeps: Sequence[Rows] | None = None
) -> Iterator[Floats]:
    """Yield the differences of consecutive laps at one angle, in units of one reading's noise.

    Parameters
    ----------
    samples : Samples
    residual_mm : ndarray, shape (n,), optional
        What a model leaves of their readings; what a machine without errors leaves where not given.
    sweeps : sequence of ndarray of int, optional
        Rows of the sweeps that are asked for; all where not given.
    """
    whole_mm = less_nominal_mm(samples) if residual_mm is None else residual_mm
    angle_rad, lap = samples["angle_rad"], samples["lap"]
    sweeps = samples.sweeps() if sweeps is None else sweeps
    yield from _core.lap_differences(angle_rad, lap, whole_mm, sweeps, [_highest(len(rows)) for rows in sweeps])


def less_nominal_mm(samples: Samples) -> Floats:
    """Return the readings minus those of the nominal machine at the measured slider positions: shape (n,), mm."""
    return predict(samples, new_model(samples.machine)).residual_mm


def _highest(count: int) -> int:
    """Return the harmonics that are removed from so many readings."""
    return min(HARMONICS, count // READINGS_PER_VALUE // 2)


def _without_harmonics(angle_rad: Floats, reading_mm: Floats) -> tuple[Floats, int]:
    """Remove the lowest harmonics from a sweep's readings; return how many coefficients these have, too."""
    return _without_contour(angle_rad, reading_mm), 1 + 2 * _highest(len(angle_rad))


def _without_contour(angle_rad: Floats, reading_mm: Floats) -> Floats:
    """Remove the lowest harmonics from a sweep's readings, as many as their number allows."""
    return _core.without_harmonics(angle_rad, reading_mm, _highest(len(angle_rad)))
