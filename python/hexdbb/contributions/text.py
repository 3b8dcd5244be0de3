"""Contributions to the circular deviation as text, for a terminal or a notebook."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table

if TYPE_CHECKING:
    from hexdbb.contributions.result import Contribution, Contributions, RecordContributions

HEADS = ("", "contribution", "alone, µm", "±", "% of G(b)", "G(b) without it, µm")


def contributions_text(found: Contributions) -> RenderableType:
    """Lay the contributions out for a terminal."""
    return Group(*_parts(found))


def cells(table: RecordContributions) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Return the heads and the rows of one record's table; what is known only together follows on rows of its own."""
    rows: list[tuple[str, ...]] = []
    for rank, each in enumerate(table.rows, start=1):
        rows.append(_row(str(rank), each))
        if len(each.parts) > 1:
            rows += [
                ("", f"  {part.label}", f"{part.circular_deviation_um:.2f}", f"{part.sigma_um:.2f}", "", "")
                for part in each.parts
            ]
    if table.not_explained is not None:
        rows.append(_row("", table.not_explained))
    return HEADS, rows


def _row(rank: str, each: Contribution) -> tuple[str, ...]:
    label = each.label if len(each.parts) < 2 else "known only together:"
    known = f"{each.sigma_um:.2f}" if each.parts else ""
    return rank, label, f"{each.circular_deviation_um:.2f}", known, f"{each.percent:.0f}", f"{each.without_um:.2f}"


def _parts(found: Contributions) -> Iterator[RenderableType]:
    for record in found.records:
        if record.note:
            yield f"{record.record_name}: {record.note}"
            continue
        yield (
            f"{record.record_name}: circular deviation {record.measured_um:.1f} µm"
            f" (both directions, mean of {len(record.circles)} circles and feeds)"
        )
        heads, rows = cells(record)
        table = Table(box=None, header_style="bold", pad_edge=False)
        for number, head in enumerate(heads):
            table.add_column(head, justify="left" if number == 1 else "right")
        for row in rows:
            table.add_row(*row)
        yield table
    yield "alone: circular deviation of a machine with this error only; curves add like vectors: % do not sum to 100"
