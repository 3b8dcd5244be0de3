"""A comparison as `hexdbb compare --json` prints it, declared: lengths in micrometres, angles in degrees."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field

from hexdbb.comparison import iso230
from hexdbb.comparison.circles import CircleComparison, DirectionComparison, root_mean_square
from hexdbb.comparison.harmonics import Harmonic
from hexdbb.comparison.iso230 import FloatArray
from hexdbb.comparison.quantities import QUANTITIES, UM_PER_MM, Quantities
from hexdbb.comparison.radial import RadialError
from hexdbb.comparison.worst_samples import Circumstance, WorstSamples
from hexdbb.files.results import JsonPart, JsonResult, NotNegative, Share
from hexdbb.predictors import Predictor, sentence
from hexdbb.samples.unmeasured import not_measured_sentences

if TYPE_CHECKING:
    from hexdbb.comparison.comparison import Comparison

AtLeastOne = Annotated[int, Field(ge=1)]
Degrees = Annotated[float, Field(ge=-180.0, le=180.0)]
_BY_KEY = {quantity.key: quantity for quantity in QUANTITIES}


def _iso(key: str) -> Any:
    quantity = _BY_KEY[key]
    return Field(description=f"{quantity.symbol} of ISO 230-4, {quantity.name}; null where it cannot be evaluated.")


@dataclass(frozen=True, kw_only=True)
class QuantitiesJson(JsonPart):
    """The quantities of ISO 230-4 of one path; names as in `QUANTITIES`."""

    circular_deviation_um: Annotated[float | None, _iso("circular_deviation")]
    bidirectional_circular_deviation_um: Annotated[float | None, _iso("bidirectional_circular_deviation")]
    circular_hysteresis_um: Annotated[float | None, _iso("circular_hysteresis")]
    mean_bidirectional_radial_deviation_um: Annotated[float | None, _iso("mean_bidirectional_radial_deviation")]
    radial_deviation_max_um: Annotated[float | None, _iso("radial_deviation_max")]
    radial_deviation_min_um: Annotated[float | None, _iso("radial_deviation_min")]
    radial_deviation_max_with_offset_um: Annotated[float | None, _iso("radial_deviation_max_with_offset")]
    radial_deviation_min_with_offset_um: Annotated[float | None, _iso("radial_deviation_min_with_offset")]


@dataclass(frozen=True)
class HarmonicJson(JsonPart):
    """One harmonic of the residual."""

    order: AtLeastOne
    """Periods per turn."""
    amplitude_um: NotNegative
    """Amplitude."""
    phase_deg: Degrees
    """p in A cos(n a - p), a the commanded polar angle."""

    @classmethod
    def of(cls, each: Harmonic) -> HarmonicJson:
        """Convert one harmonic."""
        return cls(each.order, UM_PER_MM * each.amplitude_mm, math.degrees(each.phase_rad))


@dataclass(frozen=True, kw_only=True)
class DirectionJson(QuantitiesJson):
    """One circle at one feed in one direction; measured quantities under their own names."""

    record: str
    """Name of the record."""
    circle: int
    """Id of the circle."""
    direction: Literal[1, -1]
    """+1 counter-clockwise seen from above the circle's plane, -1 clockwise."""
    feed_mm_min: float
    """Commanded feed."""
    samples: AtLeastOne
    """Number of samples compared."""
    rms_um: NotNegative
    """Root mean square residual."""
    peak_to_valley_um: NotNegative
    """Largest minus smallest residual."""
    predicted: QuantitiesJson
    """The same quantities of the predicted path."""
    harmonics: tuple[HarmonicJson, ...]
    """Harmonics of the residual, in order; empty where the capture is not a full circle."""

    @classmethod
    def of(cls, circle: CircleComparison, part: DirectionComparison) -> DirectionJson:
        """Convert one direction of a circle."""
        return cls(
            record=circle.record_name,
            circle=circle.circle.id,
            direction=1 if part.direction > 0 else -1,
            feed_mm_min=circle.feed_mm_min,
            samples=len(part.rows),
            rms_um=UM_PER_MM * part.rms_mm,
            peak_to_valley_um=UM_PER_MM * part.peak_to_valley_mm,
            predicted=QuantitiesJson(**_in_um(part.predicted_quantities)),
            harmonics=tuple(HarmonicJson.of(each) for each in part.harmonics),
            **_in_um(part.measured_quantities),
        )


@dataclass(frozen=True)
class RadialJson(JsonPart):
    """Radial error of the commanded circles of one record."""

    record: str
    """Name of the record."""
    compensation: str | None
    """Compensation file it was driven with."""
    rms_um: NotNegative | None
    """Root mean square over every sample; null where no circle is full."""
    peak_to_valley_um: NotNegative | None
    """Largest minus smallest on the worst circle at one feed, both directions."""
    worst_circle: int | None
    """Its id."""

    @classmethod
    def of(cls, each: RadialError) -> RadialJson:
        """Convert the radial error of one record."""
        rms_um, peak_um = (
            None if value is None else UM_PER_MM * value for value in (each.rms_mm, each.peak_to_valley_mm)
        )
        return cls(each.record_name, each.compensation, rms_um, peak_um, each.worst_circle)


@dataclass(frozen=True)
class LikelyCauseJson(JsonPart):
    """The likely cause of the residual."""

    sentence: str
    """It, and how much it explains."""
    choices: tuple[str, ...]
    """The effect, or two together, as hexdbb add takes them; empty where it is the model's own values."""
    subjects: tuple[str, ...]
    """Elements that it acts at; empty where it belongs to the whole machine or the gauge."""


@dataclass(frozen=True)
class WorstArcJson(JsonPart):
    """One arc of ten degrees."""

    where: str
    """Circle, direction, feed and arc in words."""
    rms_um: NotNegative
    """Root mean square residual there."""


@dataclass(frozen=True)
class WorstSamplesJson(JsonPart):
    """The samples with the largest residuals, and what is over-represented among them."""

    samples: AtLeastOne
    """Number of the worst samples, at most about a tenth of all."""
    rms_um: NotNegative
    """Their root mean square residual."""
    rms_elsewhere_um: NotNegative | None
    """That of the others; null where there are none."""
    common: tuple[Circumstance, ...]
    """Circumstances over-represented among them, most first; not necessarily causes."""
    bystanders: tuple[str, ...]
    """Elements left out of common, because what they have in common among the worst only goes with the likely cause."""
    sentences: tuple[str, ...]
    """The same in words."""

    @classmethod
    def of(cls, found: WorstSamples) -> WorstSamplesJson:
        """Convert the worst samples."""
        return cls(
            found.samples, found.rms_um, found.rms_elsewhere_um, found.common, found.bystanders, tuple(found.sentences)
        )


@dataclass(frozen=True)
class BothDirectionsJson(JsonPart):
    """Residuals of both directions of one circle at one feed, combined."""

    record: str
    """Name of the record."""
    circle: int
    """Id of the circle."""
    feed_mm_min: float
    """Commanded feed."""
    half_sum_rms_um: NotNegative
    """Root mean square of half the sum: the part common to both directions."""
    half_difference_rms_um: NotNegative
    """Root mean square of half the difference, counter-clockwise minus clockwise: the part that reverses."""
    angle_deg: tuple[float, ...]
    """Middles of the arcs with samples of both directions."""
    half_sum_um: tuple[float, ...]
    """Half the sum of the residuals in each arc."""
    half_difference_um: tuple[float, ...]
    """Half the difference in each arc."""

    @classmethod
    def of(cls, circle: CircleComparison) -> BothDirectionsJson | None:
        """Convert one circle; None where a direction is missing."""
        both = circle.both_directions
        if both is None:
            return None
        return cls(
            record=circle.record_name,
            circle=circle.circle.id,
            feed_mm_min=circle.feed_mm_min,
            half_sum_rms_um=UM_PER_MM * root_mean_square(both.half_sum_mm),
            half_difference_rms_um=UM_PER_MM * root_mean_square(both.half_difference_mm),
            angle_deg=_numbers(np.degrees(both.angle_rad)),
            half_sum_um=_numbers(UM_PER_MM * both.half_sum_mm),
            half_difference_um=_numbers(UM_PER_MM * both.half_difference_mm),
        )


@dataclass(frozen=True)
class PredictorJson(JsonPart):
    """A variable of the samples that explains the residual."""

    variable: str
    """Variable of the samples' state, in words."""
    unit: str
    """Its unit; empty where it is a class."""
    share: Share
    """Explained share of the mean square residual: fitted to one half of the laps, tested on the other."""
    bystander: bool
    """Whether it only goes with the likely cause, at another element, and predicts nothing of what that leaves."""
    sentence: str
    """The variable with its period or place and the size of the push, in words."""

    @classmethod
    def of(cls, each: Predictor) -> PredictorJson:
        """Convert one predictor."""
        return cls(each.variable, each.unit, float(each.share), each.is_bystander, sentence(each))


@dataclass(frozen=True, kw_only=True)
class ComparisonJson(JsonResult):
    """Predicted against measured readings. Residual = measured - predicted."""

    SCHEMA = "hexdbb.compare/1"

    cause: LikelyCauseJson | None
    """Likely cause of the residual; null where it is noise, was not looked for, or the readings are too few."""
    predicted_by: Literal["model", "commanded circle"]
    """What predicts; without a model, the commanded circle about a cup that is fitted in its plane."""
    not_measured: tuple[str, ...]
    """One sentence for what the records compute instead of measure: slider positions, times."""
    rms_um: NotNegative
    """Root mean square residual of all samples."""
    peak_to_valley_um: NotNegative
    """Largest minus smallest residual of all samples."""
    radial: tuple[RadialJson, ...]
    """Radial error of each record's commanded circles: the cup's offset in the plane removed, no model in it."""
    edition: str
    """Edition of ISO 230-4 that the quantities follow."""
    circles: tuple[DirectionJson, ...]
    """One entry for each circle, feed and direction."""
    worst: tuple[WorstArcJson, ...]
    """Arcs of ten degrees with the largest residual, largest first."""
    failures: WorstSamplesJson
    """The samples with the largest residuals, and what is over-represented among them."""
    both_directions: tuple[BothDirectionsJson, ...]
    """One entry for each circle and feed that was driven in both directions."""
    state: tuple[PredictorJson, ...]
    """Predictors of the residual, most worth (share less the cost of the number of values) first, bystanders last;
    shares overlap."""
    fitted_mounts: tuple[str, ...]
    """One sentence for each set-up that the model did not know, so that its cup was fitted first."""

    @classmethod
    def of(cls, comparison: Comparison) -> ComparisonJson:
        """Convert a comparison."""
        circles = comparison.circles
        both = (BothDirectionsJson.of(circle) for circle in circles)
        cause = comparison.cause
        return cls(
            cause=None if cause is None else LikelyCauseJson(cause.sentence, cause.choices, cause.subjects),
            predicted_by="commanded circle" if comparison.is_commanded else "model",
            not_measured=tuple(not_measured_sentences(comparison.samples.records)),
            rms_um=UM_PER_MM * comparison.rms_mm,
            peak_to_valley_um=UM_PER_MM * comparison.peak_to_valley_mm,
            radial=tuple(RadialJson.of(each) for each in comparison.radial),
            edition=iso230.EDITION,
            circles=tuple(DirectionJson.of(circle, part) for circle in circles for part in circle.directions),
            worst=tuple(WorstArcJson(arc.where, UM_PER_MM * arc.rms_mm) for arc in comparison.worst),
            failures=WorstSamplesJson.of(comparison.worst_samples),
            both_directions=tuple(each for each in both if each is not None),
            state=tuple(PredictorJson.of(each) for each in comparison.predictors),
            fitted_mounts=comparison.fitted_mounts,
        )


def _in_um(quantities: Quantities) -> dict[str, float | None]:
    values = {quantity.key: quantities[quantity.key] for quantity in QUANTITIES}
    return {f"{key}_um": None if value is None else UM_PER_MM * value for key, value in values.items()}


def _numbers(values: FloatArray) -> tuple[float, ...]:
    return tuple(values.tolist())
