"""How noisy the readings are: from repeated laps, else as the gauge states it, else from the readings' own roughness.

Repeated laps: the slider positions of two laps at one angle differ by micrometres only, so the difference of their
readings is noise, whatever the machine's errors are (pure error, in the words of regression). With the earlier lap
interpolated linearly between two readings at part f, white noise s makes differences of variance s^2 (1 + f^2 + (1 -
f)^2). Stated: the gauge's standard deviation with its rounding, which is evenly spread: step / sqrt(12).
Roughness: second differences of neighbouring readings remove what changes smoothly; of white noise s they have the
standard deviation sqrt(6) s. The median absolute value (0.6745 of a standard deviation) keeps jumps out of both
estimates.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hexdbb.circle import LEAST_NOISE_MM
from hexdbb.record import Record

Floats = NDArray[np.float64]

LEAST_REPEATS = 100
"""So many repeated readings are needed to estimate noise from them to about a tenth."""
MEDIAN_OF_NORMAL = 0.6745


@dataclass(frozen=True)
class Noise:
    """Standard deviation of one reading, and where it comes from."""

    sigma_mm: float
    source: Literal["repeated laps", "stated", "roughness"]


def noise_of(records: Sequence[Record]) -> Noise:
    """Find the noise of some records' readings; of several gauges the noisiest counts."""
    repeated = [difference for record in records for difference in _lap_differences(record)]
    if sum(map(len, repeated)) >= LEAST_REPEATS:
        return Noise(_robust_sigma(np.concatenate(repeated)), "repeated laps")
    stated = stated_noise(records)
    if stated is not None:
        return stated
    rough = [np.diff(record.reading_mm[rows], n=2) / np.sqrt(6.0) for record in records for rows in record.sweeps()]
    return Noise(_robust_sigma(np.concatenate(rough)), "roughness")


def stated_noise(records: Sequence[Record]) -> Noise | None:
    """Give the noise as the gauges state it, the noisiest; None where one of them states none."""
    stated = [record.gauge.stated_noise_mm for record in records]
    known = [each for each in stated if each is not None]
    return Noise(max(known), "stated") if len(known) == len(stated) else None


def _robust_sigma(values: Floats) -> float:
    if not len(values):
        return LEAST_NOISE_MM
    return max(float(np.median(np.abs(values))) / MEDIAN_OF_NORMAL, LEAST_NOISE_MM)


def _lap_differences(record: Record) -> Iterator[Floats]:
    """Differences of consecutive laps at one angle, in units of one reading's noise."""
    lap, angle = record.columns["lap"], record.columns["angle_deg"]
    for rows in record.sweeps():
        numbers = np.unique(lap[rows])
        for earlier, later in pairwise(numbers):
            first, second = rows[lap[rows] == earlier], rows[lap[rows] == later]
            if len(first) > 2 and len(second) > 2:
                yield _difference(angle[first], record.reading_mm[first], angle[second], record.reading_mm[second])


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
