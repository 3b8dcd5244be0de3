"""Readings against the commanded circle: ISO 230-4 quantities, harmonics and pictures need no model.

What takes the place of a prediction is the reading of a machine that drives the commanded circle exactly, about a cup
that is off in the circle's plane by what the readings say (`hexdbb.comparison.set_up`); about the cup as planned where
no direction is a full circle. The residual is then the radial error.
"""

from __future__ import annotations

import numpy as np

from hexdbb.comparison.circles import compare_circles
from hexdbb.comparison.comparison import Comparison, compare_readings
from hexdbb.comparison.iso230 import FloatArray
from hexdbb.samples import Samples
from hexdbb.threads import one_thread


@one_thread
def compare_commanded(samples: Samples) -> Comparison:
    """Compare the readings of samples with those of the commanded circles; `Comparison.is_commanded` is set.

    Parameters
    ----------
    samples : Samples
        At least one.

    Raises
    ------
    InputError
        No samples in a record.
    """
    return compare_readings(samples, _commanded_mm(samples), is_commanded=True)


def _commanded_mm(samples: Samples) -> FloatArray:
    """Return the reading of each sample on its commanded circle, mm."""
    commanded_mm = np.zeros(len(samples))
    for place, record in enumerate(samples.records):
        for circle in record.circles:
            here = (samples["record"] == place) & (samples["circle"] == circle.id)
            commanded_mm[here] = circle.radius_mm - record.gauge.bar_length_mm
    for compared in compare_circles(samples, commanded_mm):
        for part in compared.directions:
            if part.radial_mm is not None:
                commanded_mm[part.rows] = samples.reading_mm[part.rows] - part.radial_mm
    return commanded_mm
