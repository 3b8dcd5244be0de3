"""How noisy a gauge is: as stated by every record's gauge, else estimated from the readings themselves.

Estimate: second differences of neighbouring readings in a sweep remove what changes smoothly; of white noise s they
have the standard deviation sqrt(6) s. The median absolute value keeps jumps out of it (0.6745 of a standard deviation).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from hexdbb.record import Record

LEAST_NOISE_MM = 1e-6
"""A gauge is not taken to be better than a nanometre."""


def stated_noise_mm(records: Sequence[Record]) -> float | None:
    """Give the largest stated standard deviation, with the gauge's rounding; None where a record states none."""
    stated = [(record.gauge.noise_um, record.gauge.resolution_um) for record in records]
    if any(noise is None for noise, _ in stated):
        return None
    # A rounded reading is off by up to half a step either way, evenly: standard deviation step / sqrt(12).
    noise_mm = [np.hypot(noise or 0.0, step / np.sqrt(12.0)) / 1000.0 for noise, step in stated]
    return max(float(max(noise_mm)), LEAST_NOISE_MM)


def estimated_noise_mm(records: Sequence[Record]) -> float:
    """Estimate the standard deviation of one reading from second differences within each sweep."""
    differences = [
        np.abs(np.diff(record.reading_mm[rows], n=2)) for record in records for rows in record.sweeps() if len(rows) > 2
    ]
    if not differences:
        return LEAST_NOISE_MM
    median = float(np.median(np.concatenate(differences)))
    return max(median / 0.6745 / math.sqrt(6.0), LEAST_NOISE_MM)
