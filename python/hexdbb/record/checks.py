"""Check of a record: circles fit bar and machine; samples finite, ordered, within limits, constant per sweep.

The check runs over all samples, and therefore once for each record read or written.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.record.columns import REQUIRED_COLUMNS, SLIDER_COLUMNS, RowSource
from hexdbb.record.geometry import check_geometry
from hexdbb.record.record import Record

TRAVEL_MARGIN_MM = 1.0
"""Limits how far a slider coordinate may lie beyond the machine file's travel. Targets lie inside the travel and
following errors on a circle stay well below 1 mm; more means a wrong unit, a wrong zero or another machine."""
FEED_TOLERANCE = 1e-6
"""Limits the relative difference of two feeds that count as equal inside a sweep: above the rounding of a feed written
with 7 digits, below any step of a feed that a controller offers."""

Finding = tuple[str, NDArray[np.bool_], str]
"""Column, wrong rows of shape (n,), and what was expected; `{before}` is replaced by the value one row earlier."""


def check_record(record: Record, source: RowSource) -> None:
    """Check the circles and every sample of a record.

    Parameters
    ----------
    record : Record
    source : RowSource
        Names the file, and the line of a row, in errors.

    Raises
    ------
    InputError
        There are no samples, or a circle does not fit bar, gauge and machine.
    BadRowError
        Names the first wrong row, its column, its value and what was expected.
    """
    if len(record) == 0:
        raise InputError(f"{source.name}: holds no samples (expected at least one)")
    check_geometry(record, source.name)
    failed = [(int(np.argmax(bad)), column, expected) for column, bad, expected in _findings(record) if bad.any()]
    if not failed:
        return
    row, column, expected = min(failed, key=lambda finding: finding[0])
    values = record.columns[column]
    before = values[row - 1].item() if row > 0 else None
    raise source.bad_row(row, column, values[row].item(), expected.format(before=before))


def _findings(record: Record) -> Iterator[Finding]:
    """Yield every check with the rows that fail it; a row's result depends on itself and on earlier rows only."""
    columns = record.columns
    for name, kind in REQUIRED_COLUMNS.items():
        if kind is np.float64:
            yield name, ~np.isfinite(columns[name]), "a finite number"
    yield "direction", np.abs(columns["direction"]) != 1, "1 (counter-clockwise) or -1 (clockwise)"
    ids = [circle.id for circle in record.circles]
    yield "circle", ~np.isin(columns["circle"], ids), "the id of a circle: " + ", ".join(map(str, ids))
    yield "feed_mm_min", ~(columns["feed_mm_min"] > 0.0), "a number > 0"
    range_um = record.gauge.range_um
    within = f"a reading within the gauge's range of ±{range_um:g} µm"
    yield "reading_um", np.abs(columns["reading_um"]) > range_um, within
    yield from _travel_findings(record)
    yield from _time_findings(record)
    yield from _sweep_findings(record)


def _travel_findings(record: Record) -> Iterator[Finding]:
    for name, (least, largest) in zip(SLIDER_COLUMNS, record.machine.sliders.travels_mm, strict=True):
        value = record.columns[name]
        beyond = (value < least - TRAVEL_MARGIN_MM) | (value > largest + TRAVEL_MARGIN_MM)
        yield name, beyond, f"within the travel of the machine's sliders, {least:g} to {largest:g} mm"


def _time_findings(record: Record) -> Iterator[Finding]:
    """Check that time increases inside a sweep and does not decrease from one sweep to the next."""
    time, sweep = record.columns["t_s"], record.columns["sweep"]
    step, inside = np.diff(time), np.diff(sweep) == 0
    yield "t_s", np.concatenate([[False], inside & (step <= 0.0)]), "a time after {before}, the row before"
    yield "t_s", np.concatenate([[False], ~inside & (step < 0.0)]), "a time not before {before}, the row before"


def _sweep_findings(record: Record) -> Iterator[Finding]:
    """Check that a sweep has one circle, one direction and one feed: those of its first sample."""
    columns = record.columns
    _, first, member = np.unique(columns["sweep"], return_index=True, return_inverse=True)
    for name in ("circle", "direction", "feed_mm_min"):
        values = columns[name].astype(np.float64)
        of_sweep = values[first][member]
        differs = np.abs(values - of_sweep) > FEED_TOLERANCE * np.abs(of_sweep)
        yield name, differs, "one value throughout its sweep; another begins with another sweep number"
