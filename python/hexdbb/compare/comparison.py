"""The comparison of records with their prediction, and its form as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from hexdbb import iso230
from hexdbb.compare.circles import CircleComparison, DirectionComparison, compare_circles, root_mean_square
from hexdbb.compare.quantities import QUANTITIES, UM_PER_MM, Quantities
from hexdbb.compare.worst import WorstPlace, worst_places
from hexdbb.errors import InputError
from hexdbb.iso230 import FloatArray
from hexdbb.record import Record

WORST_COUNT = 5


@dataclass(frozen=True)
class Comparison:
    """Measured against predicted over all samples of all records.

    Attributes
    ----------
    rms_mm, peak_to_valley_mm : float
        Of the residual, measured minus predicted, over every sample.
    circles : tuple of CircleComparison
        In the order of the records, then circle, then feed.
    worst : tuple of WorstPlace
        Arcs with the largest residual, largest first.
    """

    rms_mm: float
    peak_to_valley_mm: float
    circles: tuple[CircleComparison, ...]
    worst: tuple[WorstPlace, ...]

    def to_json(self) -> dict[str, Any]:
        """Give the object `hexdbb compare --json` prints: micrometres, null where a quantity cannot be evaluated."""
        return {
            "rms_um": UM_PER_MM * self.rms_mm,
            "peak_to_valley_um": UM_PER_MM * self.peak_to_valley_mm,
            "edition": iso230.EDITION,
            "circles": [_direction_json(circle, part) for circle in self.circles for part in circle.directions],
            "worst": [{"where": place.where, "rms_um": UM_PER_MM * place.rms_mm} for place in self.worst],
        }


def compare(records: Sequence[Record], predicted_mm: Sequence[FloatArray]) -> Comparison:
    """Compare records with predicted readings.

    Parameters
    ----------
    records : sequence of Record
        At least one, each with at least one sample.
    predicted_mm : sequence of (n,) arrays
        For each record, the predicted reading of each of its samples, in mm.

    Raises
    ------
    InputError
        No record, an empty one, or a prediction that does not belong to its record.
    """
    if not records or len(records) != len(predicted_mm):
        raise InputError(f"comparing needs one prediction per record, got {len(predicted_mm)} for {len(records)}")
    circles: list[CircleComparison] = []
    for record, name, predicted in zip(records, _names(records), predicted_mm, strict=True):
        _check_prediction(record, name, predicted)
        circles += compare_circles(record, name, predicted)
    residual_mm = np.concatenate([part.residual_mm for circle in circles for part in circle.directions])
    return Comparison(
        rms_mm=root_mean_square(residual_mm),
        peak_to_valley_mm=float(np.ptp(residual_mm)),
        circles=tuple(circles),
        worst=tuple(worst_places(circles, WORST_COUNT)),
    )


def _names(records: Sequence[Record]) -> list[str]:
    """Call each record by its file's name, or by the whole path where two names are the same."""
    paths = [record.path for record in records]
    short = ["record" if path is None else path.name for path in paths]
    if len(set(short)) == len(short):
        return short
    return [f"record {number}" if path is None else str(path) for number, path in enumerate(paths, start=1)]


def _check_prediction(record: Record, name: str, predicted_mm: FloatArray) -> None:
    expected = record.reading_mm.shape
    if expected == (0,):
        raise InputError(f"{name}: holds no samples, so there is nothing to compare")
    if predicted_mm.shape != expected:
        raise InputError(f"{name}: prediction of shape {predicted_mm.shape}, expected one per sample, {expected}")
    if not np.isfinite(predicted_mm).all():
        row = int(np.flatnonzero(~np.isfinite(predicted_mm))[0])
        raise InputError(f"{name}: predicted reading of sample {row} is {predicted_mm[row]}, expected a finite length")


def _direction_json(circle: CircleComparison, part: DirectionComparison) -> dict[str, Any]:
    """One entry of `circles`: measured quantities under their own names, predicted ones under `predicted`."""
    return {
        "record": circle.record_name,
        "circle": circle.circle.id,
        "direction": part.direction,
        "feed_mm_min": circle.feed_mm_min,
        "samples": len(part.rows),
        "rms_um": UM_PER_MM * part.rms_mm,
        "peak_to_valley_um": UM_PER_MM * part.peak_to_valley_mm,
        **_quantities_json(part.measured_quantities),
        "predicted": _quantities_json(part.predicted_quantities),
    }


def _quantities_json(quantities: Quantities) -> dict[str, float | None]:
    values = {quantity.key: quantities[quantity.key] for quantity in QUANTITIES}
    return {f"{key}_um": None if value is None else UM_PER_MM * value for key, value in values.items()}
