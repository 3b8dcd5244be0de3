"""How noisy the readings are: from repeated laps, else as the gauge states it, else from the readings' own roughness.

Repeated laps: the slider positions of two laps at one angle differ by micrometres only, so the difference of their
readings is noise, whatever the machine's errors are (pure error, in the words of regression). The sweep's lowest
harmonics are taken out of both, lest the contour's curvature between two readings counts; with the earlier lap then
interpolated linearly between two readings at part f, white noise s makes differences of variance
s^2 (1 + f^2 + (1 - f)^2). Stated: the gauge's standard deviation with its rounding, which is evenly spread:
step / sqrt(12). Roughness: second differences of neighbouring readings, harmonics taken out as well, remove what
changes smoothly; of white noise s they have the standard deviation sqrt(6) s. Differences beyond `CLIP` standard
deviations are jumps and do not count in either; what that takes from normal noise is given back. A median would be
robust too, but the readings are rounded, so that it could only be one of few values.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from hexdbb.plan import LEAST_NOISE_MM
from hexdbb.record import Record

Floats = NDArray[np.float64]

LEAST_REPEATS = 100
"""So many repeated readings are needed to estimate noise from them to about a tenth."""
HARMONICS = 8
READINGS_PER_VALUE = 5
CLIP = 3.0
KEPT_VARIANCE = 1.0 - 2.0 * CLIP * float(stats.norm.pdf(CLIP)) / (2.0 * float(stats.norm.cdf(CLIP)) - 1.0)
"""Variance of a standard normal value of which is known that it is within `CLIP`."""
MOST_JUMPS = 0.1
"""Of all differences."""
ROUNDS = 20


@dataclass(frozen=True)
class Noise:
    """Standard deviation of one reading, and where it comes from."""

    sigma_mm: float
    source: Literal["repeated laps", "stated", "roughness"]


def noise_of(records: Sequence[Record]) -> Noise:
    """Find the noise of some records' readings; of several gauges the noisiest counts."""
    repeated = [difference for record in records for difference in lap_differences(record)]
    if sum(map(len, repeated)) >= LEAST_REPEATS:
        return Noise(_robust_sigma(np.concatenate(repeated)), "repeated laps")
    stated = stated_noise(records)
    if stated is not None:
        return stated
    rough = [
        np.diff(_without_contour(record.columns["angle_deg"][rows], record.reading_mm[rows]), n=2) / np.sqrt(6.0)
        for record in records
        for rows in record.sweeps()
    ]
    return Noise(_robust_sigma(np.concatenate(rough)), "roughness")


def stated_noise(records: Sequence[Record]) -> Noise | None:
    """Give the noise as the gauges state it, the noisiest; None where one of them states none."""
    stated = [record.gauge.stated_noise_mm for record in records]
    known = [each for each in stated if each is not None]
    return Noise(max(known), "stated") if len(known) == len(stated) else None


def _robust_sigma(values: Floats) -> float:
    if not len(values):
        return LEAST_NOISE_MM
    size = np.abs(values)
    sigma = float(np.quantile(size, 1.0 - MOST_JUMPS)) / float(stats.norm.ppf(1.0 - MOST_JUMPS / 2.0))
    if sigma == 0.0:  # coarsely rounded readings are mostly alike
        sigma = float(np.sqrt(np.mean(values**2)))
    for _ in range(ROUNDS):
        kept = size[size <= CLIP * sigma]
        sigma = float(np.sqrt(np.mean(kept**2) / KEPT_VARIANCE)) if len(kept) else 0.0
    return max(sigma, LEAST_NOISE_MM)


def lap_differences(record: Record) -> Iterator[Floats]:
    """Differences of consecutive laps at one angle, in units of one reading's noise."""
    for rows in record.sweeps():
        lap, angle = record.columns["lap"][rows], record.columns["angle_deg"][rows]
        numbers = np.unique(lap)
        reading_mm = _without_contour(angle, record.reading_mm[rows]) if len(numbers) > 1 else record.reading_mm[rows]
        for earlier, later in pairwise(numbers):
            first, second = lap == earlier, lap == later
            if first.sum() > 2 and second.sum() > 2:
                yield _difference(angle[first], reading_mm[first], angle[second], reading_mm[second])


def _without_contour(angle_deg: Floats, reading_mm: Floats) -> Floats:
    """Take the lowest harmonics out of a sweep's readings, as many as their number allows."""
    highest = min(HARMONICS, len(angle_deg) // READINGS_PER_VALUE // 2)
    turns = np.outer(np.radians(angle_deg), np.arange(highest + 1))
    basis = np.hstack([np.cos(turns), np.sin(turns[:, 1:])])
    left: Floats = reading_mm - basis @ np.linalg.lstsq(basis, reading_mm, rcond=None)[0]
    return left


def _difference(first_deg: Floats, first_mm: Floats, second_deg: Floats, second_mm: Floats) -> Floats:
    order = np.argsort(first_deg % 360.0)
    at, value = (first_deg % 360.0)[order], first_mm[order]
    wanted = second_deg % 360.0
    right = np.searchsorted(at, wanted)
    inside = (right > 0) & (right < len(at))
    right, wanted, measured = right[inside], wanted[inside], second_mm[inside]
    gap = at[right] - at[right - 1]
    part = np.divide(wanted - at[right - 1], gap, out=np.zeros_like(gap), where=gap > 0.0)
    between = (1.0 - part) * value[right - 1] + part * value[right]
    difference: Floats = (measured - between) / np.sqrt(1.0 + part**2 + (1.0 - part) ** 2)
    return difference
