"""A comparison as small tables, for notebooks."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from hexdbb.comparison.circles import SHORT_DIRECTION_NAMES
from hexdbb.comparison.quantities import UM_PER_MM
from hexdbb.files.frames import html_table
from hexdbb.files.plain_text import capital
from hexdbb.predictors import sentence

if TYPE_CHECKING:
    from hexdbb.comparison.comparison import Comparison

MOST_SHOWN = 8
"""Number of predictors shown: a screen."""


def comparison_html(comparison: Comparison) -> str:
    """Return the residual circle by circle, and its predictors, as two tables."""
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
    shares = [(sentence(each), f"{100.0 * each.share:.0f} %") for each in comparison.predictors[:MOST_SHOWN]]
    cause = "" if comparison.cause is None else f"<p><b>{escape(capital(comparison.cause.sentence))}</b></p>"
    return (
        f"{cause}<p>residual (measured - predicted): {rms_um:.2f} µm RMS, {peak_um:.1f} µm peak to valley</p>"
        + html_table(("record", "circle", "direction", "feed, mm/min", "RMS, µm", "p-v, µm"), circles)
        + html_table(("predictor of the residual", "explained variance"), shares)
    )
