"""A comparison as text: one table per direction, one for both, the worst arcs, the residual."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich import box
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from hexdbb.comparison import iso230
from hexdbb.comparison.circles import SHORT_DIRECTION_NAMES, CircleComparison, DirectionComparison
from hexdbb.comparison.quantities import QUANTITIES, UM_PER_MM, Quantity
from hexdbb.comparison.residual_tables import residual_text
from hexdbb.files.plain_text import capital
from hexdbb.samples.unmeasured import not_measured_sentences

if TYPE_CHECKING:
    from hexdbb.comparison.comparison import Comparison

COMMANDED = "the commanded circle about the cup as it stands in the circle's plane"
"""What readings are compared with where there is no model."""


def comparison_text(comparison: Comparison) -> RenderableType:
    """Return a comparison laid out for a terminal, all lengths in micrometres."""
    rms_um, peak_um = UM_PER_MM * comparison.rms_mm, UM_PER_MM * comparison.peak_to_valley_mm
    parts: list[RenderableType] = [
        *cause_lines(comparison),
        *origin_lines(comparison),
        *comparison.fitted_mounts,
        *_radial_lines(comparison),
        f"Residual (measured - predicted): {rms_um:.2f} µm RMS, {peak_um:.1f} µm peak to valley",
        *_compensated_note(comparison),
        "",
        _directions_table(comparison),
        "",
        _both_table(comparison),
        "",
        *_notes(comparison),
        "",
        "Largest residuals (arcs of ten degrees):",
        *(f"  {UM_PER_MM * arc.rms_mm:8.2f} µm RMS  {arc.where}" for arc in comparison.worst),
        "",
        *residual_text(comparison),
    ]
    return Group(*parts)


def cause_lines(comparison: Comparison) -> Iterator[Text]:
    """Yield the likely cause of the residual in one sentence, where there is one."""
    if comparison.cause is not None:
        yield Text(capital(comparison.cause.sentence), style="bold")


def origin_lines(comparison: Comparison) -> Iterator[str]:
    """Yield what takes the place of a model where there is none, and what the records compute instead of measure."""
    if comparison.is_commanded:
        yield f"No model: predicted is {COMMANDED}."
        return  # quantities of paths depend on nothing that is computed
    yield from (f"{capital(each)}." for each in not_measured_sentences(comparison.samples.records))


def _radial_lines(comparison: Comparison) -> Iterator[str]:
    """Yield the radial error of each record's commanded circles, one line for each."""
    for each in comparison.radial:
        of = f" of {each.record_name}" if _several_records(comparison) else " of the commanded circles"
        driven = f", compensated by {each.compensation}" if each.compensation else ""
        if each.rms_mm is None or each.peak_to_valley_mm is None:
            yield f"Radial error{of}{driven}: - (no full circle)"
            continue
        yield (
            f"Radial error{of}{driven}: {UM_PER_MM * each.rms_mm:.2f} µm RMS,"
            f" {UM_PER_MM * each.peak_to_valley_mm:.1f} µm peak to valley (circle {each.worst_circle})"
        )


def _compensated_note(comparison: Comparison) -> list[str]:
    if not any(each.compensation for each in comparison.radial):
        return []
    return [
        "The residual tests the model at the actual slider positions; the radial error tests machine and compensation."
    ]


def _directions_table(comparison: Comparison) -> Table:
    """Return two lines per direction: measured with the residual, and predicted."""
    own = [quantity for quantity in QUANTITIES if not quantity.of_both]
    table = _table("Each direction (ccw counter-clockwise, cw clockwise), µm", comparison)
    table.add_column("direction", no_wrap=True, min_width=13)
    for heading in (*(quantity.symbol for quantity in own), "resid.\nRMS", "resid.\np-v"):
        table.add_column(heading, justify="right", min_width=6)
    for circle in comparison.circles:
        for part in circle.directions:
            direction = SHORT_DIRECTION_NAMES[part.direction]
            residual = (f"{UM_PER_MM * part.rms_mm:.2f}", f"{UM_PER_MM * part.peak_to_valley_mm:.1f}")
            measured = (_number(part.measured_quantities[quantity.key]) for quantity in own)
            predicted = (_number(part.predicted_quantities[quantity.key]) for quantity in own)
            set_up = _set_up(circle, comparison)
            table.add_row(*set_up, f"{direction} measured", *measured, *residual)
            table.add_row(*("" for _ in set_up), f"{direction} predicted", *predicted)
    return table


def _both_table(comparison: Comparison) -> Table:
    both = [quantity for quantity in QUANTITIES if quantity.of_both]
    table = _table("Both directions, µm (measured / predicted)", comparison)
    for quantity in both:
        table.add_column(quantity.symbol, justify="right")
    for circle in comparison.circles:
        cells = (_pair(circle.directions[0], quantity) for quantity in both)
        table.add_row(*_set_up(circle, comparison), *cells)
    return table


def _notes(comparison: Comparison) -> Iterator[str]:
    yield f"Quantities of {iso230.EDITION}:"
    yield from (f"  {quantity.symbol}: {quantity.name}" for quantity in QUANTITIES)
    yield "Radial error: of every sample, the cup's offset in the plane removed; peak to valley of the worst circle."
    yield "Measured quantities are of the mean of the laps and contain the gauge's noise; predicted ones contain none."
    quantities = (part.measured_quantities for circle in comparison.circles for part in circle.directions)
    if any(None in values.values() for values in quantities):
        yield "-: cannot be evaluated, because a direction is missing or its capture is not a full circle."


def _table(title: str, comparison: Comparison) -> Table:
    table = Table(
        title=title, title_justify="left", title_style="bold", box=box.SIMPLE_HEAD, padding=0, show_edge=False
    )
    if _several_records(comparison):
        table.add_column("record")
    table.add_column("circle", justify="right", min_width=6)
    table.add_column("feed\nmm/min", justify="right", min_width=6)
    return table


def _set_up(circle: CircleComparison, comparison: Comparison) -> list[str]:
    record = [circle.record_name] if _several_records(comparison) else []
    return [*record, str(circle.circle.id), f"{circle.feed_mm_min:g}"]


def _several_records(comparison: Comparison) -> bool:
    return len({circle.record_name for circle in comparison.circles}) > 1


def _pair(part: DirectionComparison, quantity: Quantity) -> str:
    return f"{_number(part.measured_quantities[quantity.key])} / {_number(part.predicted_quantities[quantity.key])}"


def _number(value_mm: float | None) -> str:
    # Rounding and adding zero keeps "-0.0" out of the table.
    return "-" if value_mm is None else f"{round(UM_PER_MM * value_mm, 1) + 0.0:.1f}"
