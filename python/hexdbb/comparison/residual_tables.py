"""The residual as text: worst samples, part common to both directions, harmonics, predictors."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich import box
from rich.console import RenderableType
from rich.table import Table

from hexdbb.comparison.circles import SHORT_DIRECTION_NAMES, CircleComparison, root_mean_square
from hexdbb.comparison.quantities import UM_PER_MM
from hexdbb.predictors import main_predictors, sentence

if TYPE_CHECKING:
    from hexdbb.comparison.comparison import Comparison

MOST_HARMONICS = 8
"""Number of harmonics printed, of all circles: a screen with the tables above."""
MOST_PREDICTORS = 8
"""Number of predictors printed."""


def residual_text(comparison: Comparison) -> Iterator[RenderableType]:
    """Yield the parts, an empty line between them."""
    first, *common = comparison.worst_samples.sentences
    yield f"Worst samples: {first}"
    yield from (f"  {each}" for each in common)
    yield ""
    if any(circle.both_directions is not None for circle in comparison.circles):
        yield _both_directions_table(comparison)
        yield ""
    if any(part.harmonics for circle in comparison.circles for part in circle.directions):
        yield _harmonics_table(comparison)
        yield ""
    yield from _predictors(comparison)


def _both_directions_table(comparison: Comparison) -> Table:
    table = _table("Residual of both directions combined, µm RMS of arcs")
    for heading in ("circle", "feed\nmm/min", "common part\n(ccw+cw)/2", "reversing part\n(ccw-cw)/2"):
        table.add_column(heading, justify="right")
    for circle in comparison.circles:
        both = circle.both_directions
        if both is not None:
            halves_mm = (both.half_sum_mm, both.half_difference_mm)
            parts = (f"{UM_PER_MM * root_mean_square(each):.2f}" for each in halves_mm)
            table.add_row(_name(circle, comparison), f"{circle.feed_mm_min:g}", *parts)
    return table


def _harmonics_table(comparison: Comparison) -> Table:
    table = _table("Largest harmonics of the residual")
    for heading in ("circle", "feed\nmm/min", "direction", "order", "amplitude\nµm", "phase\ndeg"):
        table.add_column(heading, justify="right")
    every = [
        (circle, part.direction, harmonic)
        for circle in comparison.circles
        for part in circle.directions
        for harmonic in part.harmonics
    ]
    for circle, direction, harmonic in sorted(every, key=lambda each: -each[2].amplitude_mm)[:MOST_HARMONICS]:
        table.add_row(
            _name(circle, comparison),
            f"{circle.feed_mm_min:g}",
            SHORT_DIRECTION_NAMES[direction],
            str(harmonic.order),
            f"{UM_PER_MM * harmonic.amplitude_mm:.2f}",
            f"{math.degrees(harmonic.phase_rad):.0f}",
        )
    return table


def _predictors(comparison: Comparison) -> Iterator[str]:
    shown = main_predictors([each for each in comparison.predictors if not each.is_bystander], MOST_PREDICTORS)
    beside = main_predictors([each for each in comparison.predictors if each.is_bystander], MOST_PREDICTORS)
    if not shown and not beside:
        yield "No predictor of the residual: no variable fitted to half of the laps explains any of the other half."
        return
    yield "Predictors of the residual (explained variance, cross-validated):"
    yield from (f"  {each.share:6.1%}  {sentence(each)}" for each in shown)
    if beside:
        bystanders = ", ".join(f"{each.variable} ({each.share:.0%})" for each in beside)
        yield f"Going with the likely cause, and explaining nothing beside it: {bystanders}"


def _table(title: str) -> Table:
    return Table(
        title=title,
        title_justify="left",
        title_style="bold",
        box=box.SIMPLE_HEAD,
        padding=(0, 1),
        show_edge=False,
        min_width=len(title) + 1,
    )


def _name(circle: CircleComparison, comparison: Comparison) -> str:
    several = len({each.record_name for each in comparison.circles}) > 1
    return f"{circle.record_name} {circle.circle.id}" if several else str(circle.circle.id)
