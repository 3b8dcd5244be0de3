"""Radial error of commanded circles, record by record: what a machine does, independent of any model.

Definition: `DirectionComparison.radial_mm`, over every sample; peak to valley is that of one circle at one feed, both
directions, the largest. In a record driven with compensation the sliders stand where the controller has put them, so
a model's residual is no measure of the compensation: this is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hexdbb.comparison.circles import CircleComparison, root_mean_square


@dataclass(frozen=True)
class RadialError:
    """Radial error of the full circles of one record.

    Attributes
    ----------
    record_name : str
    compensation : str or None
        The compensation file it was driven with.
    rms_mm, peak_to_valley_mm : float or None
        Over every sample; of the worst circle. None where no circle is full.
    worst_circle : int or None
        Id of the circle with the largest peak to valley.
    """

    record_name: str
    compensation: str | None
    rms_mm: float | None
    peak_to_valley_mm: float | None
    worst_circle: int | None


def radial_errors(circles: Sequence[CircleComparison]) -> tuple[RadialError, ...]:
    """Return the radial error of each record, in their order."""
    names = dict.fromkeys(circle.record_name for circle in circles)
    return tuple(_of_record([circle for circle in circles if circle.record_name == name]) for name in names)


def _of_record(circles: Sequence[CircleComparison]) -> RadialError:
    first = circles[0]
    full = [(circle.circle.id, radial) for circle in circles if (radial := circle.radial_mm) is not None]
    if not full:
        return RadialError(first.record_name, first.compensation, None, None, None)
    worst, largest = max(((identity, float(np.ptp(radial))) for identity, radial in full), key=lambda each: each[1])
    rms_mm = root_mean_square(np.concatenate([radial for _, radial in full]))
    return RadialError(first.record_name, first.compensation, rms_mm, largest, worst)
