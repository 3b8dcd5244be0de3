"""A comparison as JSON, for programs, and as small tables, for notebooks. Lengths in micrometres, angles in degrees."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from hexdbb.compare import iso230
from hexdbb.compare.circles import SHORT_DIRECTION_NAMES, CircleComparison, DirectionComparison
from hexdbb.compare.failures import Failures
from hexdbb.compare.quantities import QUANTITIES, UM_PER_MM, Quantities
from hexdbb.compare.radial import RadialError
from hexdbb.files.frames import html_table
from hexdbb.predictors import sentence

if TYPE_CHECKING:
    from hexdbb.compare.comparison import Comparison

MOST_SHOWN = 8


def comparison_json(comparison: Comparison) -> dict[str, Any]:
    """Give the object `hexdbb compare --json` prints; null where a quantity cannot be evaluated."""
    return {
        "rms_um": UM_PER_MM * comparison.rms_mm,
        "peak_to_valley_um": UM_PER_MM * comparison.peak_to_valley_mm,
        "radial": [_radial(each) for each in comparison.radial],
        "edition": iso230.EDITION,
        "circles": [_direction(circle, part) for circle in comparison.circles for part in circle.directions],
        "worst": [{"where": place.where, "rms_um": UM_PER_MM * place.rms_mm} for place in comparison.worst],
        "failures": _failures(comparison.failures),
        "both_directions": [each for circle in comparison.circles if (each := _both_ways(circle)) is not None],
        "state": [
            {"variable": each.variable, "unit": each.unit, "share": each.share, "sentence": sentence(each)}
            for each in comparison.dependences
        ],
    }


def _radial(each: RadialError) -> dict[str, Any]:
    return {
        "record": each.record_name,
        "compensation": each.compensation,
        "rms_um": None if each.rms_mm is None else UM_PER_MM * each.rms_mm,
        "peak_to_valley_um": None if each.peak_to_valley_mm is None else UM_PER_MM * each.peak_to_valley_mm,
        "worst_circle": each.worst_circle,
    }


def comparison_html(comparison: Comparison) -> str:
    """Give the residual circle by circle, and what it depends on, as two tables."""
    rms_um, peak_um = UM_PER_MM * comparison.rms_mm, UM_PER_MM * comparison.peak_to_valley_mm
    circles = [
        (
            circle.record_name,
            str(circle.circle.id),
            SHORT_DIRECTION_NAMES[part.direction],
            f"{circle.feed_mm_min:g}",
            f"{UM_PER_MM * part.rms_mm:.2f}",
            f"{UM_PER_MM * part.peak_to_valley_mm:.1f}",
        )
        for circle in comparison.circles
        for part in circle.directions
    ]
    shares = [(sentence(each), f"{100.0 * each.share:.0f} %") for each in comparison.dependences[:MOST_SHOWN]]
    return (
        f"<p>residual (measured - predicted): {rms_um:.2f} µm rms, {peak_um:.1f} µm peak to valley</p>"
        + html_table(("record", "circle", "direction", "feed, mm/min", "rms, µm", "p-v, µm"), circles)
        + html_table(("what carries the residual", "share"), shares)
    )


def _direction(circle: CircleComparison, part: DirectionComparison) -> dict[str, Any]:
    """One entry of `circles`: measured quantities under their own names, predicted ones under `predicted`."""
    return {
        "record": circle.record_name,
        "circle": circle.circle.id,
        "direction": part.direction,
        "feed_mm_min": circle.feed_mm_min,
        "samples": len(part.rows),
        "rms_um": UM_PER_MM * part.rms_mm,
        "peak_to_valley_um": UM_PER_MM * part.peak_to_valley_mm,
        **_quantities(part.measured_quantities),
        "predicted": _quantities(part.predicted_quantities),
        "harmonics": [
            {
                "order": each.order,
                "amplitude_um": UM_PER_MM * each.amplitude_mm,
                "phase_deg": math.degrees(each.phase_rad),
            }
            for each in part.harmonics
        ],
    }


def _quantities(quantities: Quantities) -> dict[str, float | None]:
    values = {quantity.key: quantities[quantity.key] for quantity in QUANTITIES}
    return {f"{key}_um": None if value is None else UM_PER_MM * value for key, value in values.items()}


def _failures(found: Failures) -> dict[str, Any]:
    return {
        "samples": found.samples,
        "rms_um": found.rms_um,
        "rms_elsewhere_um": _number(found.rms_elsewhere_um),
        "common": [
            {
                "what": trait.what,
                "in_worst": trait.in_worst,
                "in_all": trait.in_all,
                "rms_with_um": _number(trait.rms_with_um),
                "rms_without_um": _number(trait.rms_without_um),
            }
            for trait in found.common
        ],
        "sentences": found.sentences,
    }


def _both_ways(circle: CircleComparison) -> dict[str, Any] | None:
    both = circle.both_ways
    if both is None:
        return None
    return {
        "record": circle.record_name,
        "circle": circle.circle.id,
        "feed_mm_min": circle.feed_mm_min,
        "half_sum_rms_um": UM_PER_MM * float(np.sqrt(np.mean(both.sum_mm**2))),
        "half_difference_rms_um": UM_PER_MM * float(np.sqrt(np.mean(both.difference_mm**2))),
        "angle_deg": np.degrees(both.angle_rad).tolist(),
        "half_sum_um": (UM_PER_MM * both.sum_mm).tolist(),
        "half_difference_um": (UM_PER_MM * both.difference_mm).tolist(),
    }


def _number(value: float) -> float | None:
    return None if math.isnan(value) else value
