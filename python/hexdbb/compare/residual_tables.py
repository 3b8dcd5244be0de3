"""The residual as text: what the worst samples share, what is common to both directions, harmonics, state variables."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich import box
from rich.console import RenderableType
from rich.table import Table

from hexdbb.compare.circles import SHORT_DIRECTION_NAMES, CircleComparison, root_mean_square
from hexdbb.compare.quantities import UM_PER_MM
from hexdbb.predictors import sentence, telling

if TYPE_CHECKING:
    from hexdbb.compare.comparison import Comparison

MOST_HARMONICS = 8
MOST_VARIABLES = 8


def residual_text(comparison: Comparison) -> Iterator[RenderableType]:
    """Yield the parts, an empty line between them."""
    first, *common = comparison.failures.sentences
    yield f"What fails: {first}"
    yield from (f"  {each}" for each in common)
    yield ""
    if any(circle.both_ways is not None for circle in comparison.circles):
        yield _both_ways_table(comparison)
        yield ""
    if any(part.harmonics for circle in comparison.circles for part in circle.directions):
        yield _harmonics_table(comparison)
        yield ""
    yield from _variables(comparison)


def _both_ways_table(comparison: Comparison) -> Table:
    table = _table("Residual of both directions together, µm rms of arcs")
    for heading in ("circle", "feed\nmm/min", "same both ways\n(ccw+cw)/2", "turns with direction\n(ccw-cw)/2"):
        table.add_column(heading, justify="right")
    for circle in comparison.circles:
        both = circle.both_ways
        if both is not None:
            parts = (f"{UM_PER_MM * root_mean_square(each):.2f}" for each in (both.sum_mm, both.difference_mm))
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


def _variables(comparison: Comparison) -> Iterator[str]:
    shown = telling(list(comparison.dependences), MOST_VARIABLES)
    if not shown:
        yield "No variable carries any of the residual: what is fitted to half of the laps does not predict the others."
        return
    yield "What carries the residual (share of its mean square, on laps not used to find it):"
    yield from (f"  {each.share:6.1%}  {sentence(each)}" for each in shown)


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
