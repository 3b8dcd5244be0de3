"""The comparison of records with their prediction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hexdbb.compare.circles import CircleComparison, compare_circles, root_mean_square
from hexdbb.compare.failures import Failures, failures
from hexdbb.compare.iso230 import FloatArray
from hexdbb.compare.json_form import comparison_html, comparison_json
from hexdbb.compare.radial import RadialError, radial_errors
from hexdbb.compare.worst import WorstPlace, worst_places
from hexdbb.errors import InputError
from hexdbb.files.frames import to_frame
from hexdbb.predictors import Carrier, Columns, Pushes, State, carriers, sample_columns
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
    radial : tuple of RadialError
        Radial error of the commanded circles, one a record; no model is in it.
    worst : tuple of WorstPlace
        Arcs with the largest residual, largest first.
    failures : Failures
        What the samples with the largest residuals have in common.
    dependences : tuple of Carrier
        How much of the residual each variable of the samples' state carries, the most telling first.
    columns : dict of str to (n,) arrays
        Every sample: where and when it was taken, measured, predicted and residual in um.
    """

    rms_mm: float
    peak_to_valley_mm: float
    circles: tuple[CircleComparison, ...]
    radial: tuple[RadialError, ...]
    worst: tuple[WorstPlace, ...]
    failures: Failures
    dependences: tuple[Carrier, ...]
    columns: Columns = field(repr=False, compare=False)

    def to_json(self) -> dict[str, Any]:
        """Give the object `hexdbb compare --json` prints: micrometres, null where a quantity cannot be evaluated."""
        return comparison_json(self)

    def to_frame(self) -> Any:
        """Give `columns` as a ``pandas.DataFrame``, a row a sample; `InputError` where pandas is not installed."""
        return to_frame(self.columns)

    def _repr_html_(self) -> str:
        return comparison_html(self)


def compare(
    records: Sequence[Record],
    predicted_mm: Sequence[FloatArray],
    states: Sequence[State] | None = None,
    pushes: Sequence[Pushes] | None = None,
    noise_mm: float = 0.0,
) -> Comparison:
    """Compare records with predicted readings.

    Parameters
    ----------
    records : sequence of Record
        At least one, each with at least one sample.
    predicted_mm : sequence of (n,) arrays
        For each record, the predicted reading of each of its samples, in mm.
    states : sequence of mappings, optional
        For each record, columns of the machine's state that are not in it: velocities and reversals of the sliders, as
        `hexdbb.samples.samples_of(...).state` gives them. Without them nothing is said of these.
    pushes : sequence of Pushes, optional
        For each record, how its readings answer to pushes on the machine. Without them what depends on a slider is
        sought in the reading as it stands, and nothing is said of guideways and legs.
    noise_mm : float
        Of one reading, where it is known.

    Raises
    ------
    InputError
        No record, an empty one, or a prediction that does not belong to its record.
    """
    if not records or len(records) != len(predicted_mm):
        raise InputError(f"comparing needs one prediction per record, got {len(predicted_mm)} for {len(records)}")
    circles: list[CircleComparison] = []
    names = _names(records)
    for record, name, predicted in zip(records, names, predicted_mm, strict=True):
        _check_prediction(record, name, predicted)
        circles += compare_circles(record, name, predicted)
    residual_mm = np.concatenate([part.residual_mm for circle in circles for part in circle.directions])
    columns = sample_columns(records, names, predicted_mm, states or [{} for _ in records])
    return Comparison(
        rms_mm=root_mean_square(residual_mm),
        peak_to_valley_mm=float(np.ptp(residual_mm)),
        circles=tuple(circles),
        radial=radial_errors(circles),
        worst=tuple(worst_places(circles, WORST_COUNT)),
        failures=failures(columns),
        dependences=tuple(carriers(columns, None if pushes is None else Pushes.joined(list(pushes)), noise_mm)),
        columns=columns,
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
