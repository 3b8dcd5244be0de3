"""One circle at one feed: its samples, its mean paths measured and predicted, its residual in each direction.

Convention: residual = measured - predicted. Radial deviation of a path = reading + bar length - nominal radius.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hexdbb.comparison import iso230
from hexdbb.comparison.both_directions import BothDirections, both_directions
from hexdbb.comparison.harmonics import Harmonic, harmonics
from hexdbb.comparison.iso230 import FloatArray, Path
from hexdbb.comparison.quantities import Quantities, evaluate_quantities
from hexdbb.comparison.reversals import Reversal, reversals
from hexdbb.comparison.set_up import without_set_up_mm
from hexdbb.plan import Circle
from hexdbb.predictors import record_names
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb.samples.distinct import distinct_rows

IndexArray = npt.NDArray[np.intp]

SECONDS_PER_MINUTE = 60.0

DIRECTION_NAMES: Mapping[int, str] = {1: "counter-clockwise", -1: "clockwise"}
SHORT_DIRECTION_NAMES: Mapping[int, str] = {1: "ccw", -1: "cw"}


@dataclass(frozen=True)
class DirectionComparison:
    """One direction of one circle at one feed.

    Attributes
    ----------
    direction : int
        +1 counter-clockwise, -1 clockwise, seen from above the circle's plane.
    rows : (n,) int array
        Its samples in the table, so that any column can be plotted against the residual.
    angle_rad : (n,) array
        Commanded polar angle.
    residual_mm : (n,) array
        Measured minus predicted reading.
    radial_mm : (n,) array or None
        Radial error of each sample: reading less what the commanded circle would read about a cup that is off in its
        plane, the offset found by least squares over both directions (`hexdbb.comparison.set_up`). No model is in
        it: it
        is what the machine, compensated or not, makes of a commanded circle. None where no direction is a full circle.
    measured, predicted : Path
        Mean path over the laps.
    measured_quantities, predicted_quantities : Quantities
        ISO 230-4, in mm.
    harmonics : tuple of Harmonic
        Of the residual; empty where the capture is not a full circle.
    """

    direction: int
    rows: IndexArray
    angle_rad: FloatArray
    residual_mm: FloatArray
    radial_mm: FloatArray | None
    measured: Path
    predicted: Path
    measured_quantities: Quantities
    predicted_quantities: Quantities
    harmonics: tuple[Harmonic, ...]

    @property
    def rms_mm(self) -> float:
        """Root mean square of the residual."""
        return root_mean_square(self.residual_mm)

    @property
    def peak_to_valley_mm(self) -> float:
        """Largest minus smallest residual."""
        return float(np.ptp(self.residual_mm))


@dataclass(frozen=True)
class CircleComparison:
    """One circle of one record at one feed: `directions` holds counter-clockwise first, then clockwise.

    `compensation` names the compensation file the record was driven with, None where it was not; `reversals` is where
    sliders reverse, by angle.
    """

    record_name: str
    compensation: str | None
    circle: Circle
    feed_mm_min: float
    directions: tuple[DirectionComparison, ...]
    reversals: tuple[Reversal, ...] = ()

    @property
    def rms_mm(self) -> float:
        """Root mean square of the residual of all its samples."""
        return root_mean_square(np.concatenate([part.residual_mm for part in self.directions]))

    @cached_property
    def both_directions(self) -> BothDirections | None:
        """Residuals of both directions combined; None where one is missing."""
        if len(self.directions) < 2:
            return None
        ccw, cw = ((part.angle_rad, part.residual_mm) for part in self.directions)
        return both_directions(ccw, cw)

    @cached_property
    def set_up_centre_mm(self) -> FloatArray | None:
        """Centre offset (2,) of the measured paths, least squares; None where no direction is a full circle."""
        full = [part.measured for part in self.directions if part.measured.is_full_circle]
        return iso230.set_up_centre_mm(*full) if full else None

    @property
    def radial_mm(self) -> FloatArray | None:
        """Radial error of every sample of both directions; see `DirectionComparison.radial_mm`."""
        parts = [part.radial_mm for part in self.directions if part.radial_mm is not None]
        return np.concatenate(parts) if parts else None


def root_mean_square(values: FloatArray) -> float:
    """Return the root mean square, not corrected for degrees of freedom."""
    return float(np.sqrt(np.mean(np.square(values))))


def compare_circles(samples: Samples, predicted_mm: FloatArray) -> list[CircleComparison]:
    """Compare measured with predicted readings, circle by circle and feed by feed, in the order of the records.

    Parameters
    ----------
    samples : Samples
        At least one.
    predicted_mm : (n,) array
        Predicted reading of each sample.
    """
    names = record_names(samples.records)
    first, member = distinct_rows(samples["record"], samples["circle"], samples["feed_mm_s"])
    return [
        _compare_circle(samples, predicted_mm, np.flatnonzero(member == number), names[int(record)])
        for number, record in enumerate(samples["record"][first])
    ]


def _compare_circle(samples: Samples, predicted_mm: FloatArray, here: IndexArray, name: str) -> CircleComparison:
    """Compare the samples of one circle of one record at one feed, rows `here` of the table."""
    part, predicted_here_mm = samples.part(here), predicted_mm[here]
    record = samples.records[int(part["record"][0])]
    circle = record.circle(int(part["circle"][0]))
    bar_mm, angle_rad, reading_mm = record.gauge.bar_length_mm, part["angle_rad"], part.reading_mm
    rows = {
        direction: found
        for direction in DIRECTION_NAMES
        if len(found := np.flatnonzero(part["direction"] == direction))
    }
    measured = {d: lap_mean_path(part.part(found), circle, bar_mm, reading_mm[found]) for d, found in rows.items()}
    predicted = {
        d: lap_mean_path(part.part(found), circle, bar_mm, predicted_here_mm[found]) for d, found in rows.items()
    }
    measured_quantities, predicted_quantities = evaluate_quantities(measured), evaluate_quantities(predicted)
    residual_mm = reading_mm - predicted_here_mm
    is_full = any(path.is_full_circle for path in measured.values())
    radial_mm = _radial_mm(angle_rad, reading_mm + bar_mm, circle, rows) if is_full else {}
    directions = tuple(
        DirectionComparison(
            direction=direction,
            rows=here[found],
            angle_rad=angle_rad[found],
            residual_mm=residual_mm[found],
            radial_mm=radial_mm.get(direction),
            measured=measured[direction],
            predicted=predicted[direction],
            measured_quantities=measured_quantities[direction],
            predicted_quantities=predicted_quantities[direction],
            harmonics=harmonics(angle_rad[found], residual_mm[found]) if measured[direction].is_full_circle else (),
        )
        for direction, found in rows.items()
    )
    # Nine decimals undo the rounding of mm/min to mm/s and back.
    feed_mm_min = round(SECONDS_PER_MINUTE * float(part["feed_mm_s"][0]), 9)
    return CircleComparison(name, compensation_of(record), circle, feed_mm_min, directions, reversals(part))


def compensation_of(record: Record) -> str | None:
    """Return the name of the compensation file a record was driven with; None where it was not."""
    driven = record.metadata.get("compensation")
    return str(driven.get("file", "a compensation")) if isinstance(driven, dict) else None


def lap_mean_path(part: Samples, circle: Circle, bar_mm: float, reading_mm: FloatArray) -> Path:
    """Return the mean path over the laps (and repeated sweeps) of some samples of one direction.

    Parameters
    ----------
    part : Samples
    circle : Circle
    bar_mm : float
        Nominal length of the ball bar.
    reading_mm : (n,) array
        Readings that the path is made of: measured ones, or predicted by any model.
    """
    turn = numbered_turns(part["sweep"], part["lap"])
    return iso230.lap_mean_path(part["angle_rad"], reading_mm + (bar_mm - circle.radius_mm), circle.radius_mm, turn)


def numbered_turns(sweep: npt.NDArray[np.int32], lap: npt.NDArray[np.int32]) -> npt.NDArray[np.int64]:
    """Return one number (n,) for each lap of each sweep, in the order of sweeps and laps."""
    first = int(lap.min())
    return sweep.astype(np.int64) * (int(lap.max()) - first + 1) + (lap - first)


def _radial_mm(
    angle_rad: FloatArray, distance_mm: FloatArray, circle: Circle, rows: Mapping[int, IndexArray]
) -> dict[int, FloatArray]:
    """Return the radial error by direction, the cup's offset found from both together."""
    joined = np.concatenate(list(rows.values()))
    left_mm = without_set_up_mm(angle_rad[joined], distance_mm[joined], circle.radius_mm)
    ends = np.cumsum([len(found) for found in rows.values()])[:-1]
    return dict(zip(rows, np.split(left_mm, ends), strict=True))
