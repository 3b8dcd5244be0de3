"""Summary of a record for people: one line, and a table of its sweeps for notebooks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from hexdbb.files.frames import html_table

if TYPE_CHECKING:
    from hexdbb.record.record import Record

SWEEPS_SHOWN_MAX = 60
"""Limits the rows of the table: every sweep of a usual plan (`standard` has 28), and still one screen or two."""
SWEEP_HEADS = (
    *("sweep", "circle", "mount", "direction", "feed, mm/min", "laps", "samples"),
    *("begin, s", "duration, s", "reading, µm"),
)


def summary_line(record: Record) -> str:
    """Return one line: name, samples, sweeps, circles, feeds, range of readings, completeness."""
    columns = record.columns
    if not len(record):
        return f"<Record {record.name}: no samples>"
    feeds = ", ".join(f"{feed:g}" for feed in np.unique(columns["feed_mm_min"]))
    parts = (
        f"{len(record):,} samples",
        _counted(len(np.unique(columns["sweep"])), "sweep"),
        _counted(len(np.unique(columns["circle"])), "circle"),
        f"feed {feeds} mm/min",
        f"readings {_reading_range(columns['reading_um'])} µm",
        "complete" if record.complete else "incomplete",
    )
    return f"<Record {record.name}: {', '.join(parts)}>"


def summary_html(record: Record) -> str:
    """Return the summary line and one row per sweep, at most `SWEEPS_SHOWN_MAX`, as an HTML table."""
    caption = html_table((summary_line(record).strip("<>"),), ())
    rows = list(_sweep_rows(record))
    more = len(rows) - SWEEPS_SHOWN_MAX
    if more > 0:
        rows = [*rows[:SWEEPS_SHOWN_MAX], (f"{more} more", *[""] * (len(SWEEP_HEADS) - 1))]
    return caption + html_table(SWEEP_HEADS, rows)


def _sweep_rows(record: Record) -> Iterator[tuple[str, ...]]:
    mounts = {circle.id: str(circle.mount) for circle in record.circles}
    for rows in record.sweeps():
        own = {name: values[rows] for name, values in record.columns.items()}
        circle, time = int(own["circle"][0]), own["t_s"]
        yield (
            *(str(own["sweep"][0]), str(circle), mounts.get(circle, "unknown"), f"{own['direction'][0]:+d}"),
            *(f"{own['feed_mm_min'][0]:g}", str(len(np.unique(own["lap"]))), f"{len(rows):,}"),
            *(f"{time[0]:.3f}", f"{time[-1] - time[0]:.3f}", _reading_range(own["reading_um"])),
        )


def _reading_range(reading_um: np.ndarray) -> str:
    return f"{reading_um.min():.1f} to {reading_um.max():.1f}"


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"
