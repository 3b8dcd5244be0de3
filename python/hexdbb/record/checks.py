"""Check of a record: circles fit bar and machine; samples finite, ordered, within limits, constant per sweep.

The check runs over all samples, and therefore once for each record read or written.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

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

LARGEST = float(np.finfo(np.float64).max)
"""Largest number that is finite."""

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
    """Yield checks that may have failed, with the rows that fail them; each depends on its own and on earlier rows.

    Nearly every record is right: what a look at extremes, or at places where a value changes, shows to be right is not
    compared row by row.
    """
    columns = record.columns
    for name, kind in REQUIRED_COLUMNS.items():
        if kind is np.float64 and not _within(columns[name], -LARGEST, LARGEST):
            yield name, ~np.isfinite(columns[name]), "a finite number"
    yield "direction", np.abs(columns["direction"]) != 1, "1 (counter-clockwise) or -1 (clockwise)"
    circle, ids = columns["circle"], [circle.id for circle in record.circles]
    if not np.isin(circle[_changes(circle)], ids).all():
        yield "circle", ~np.isin(circle, ids), "the id of a circle: " + ", ".join(map(str, ids))
    if not _within(columns["feed_mm_min"], np.nextafter(0.0, 1.0), np.inf):
        yield "feed_mm_min", ~(columns["feed_mm_min"] > 0.0), "a number > 0"
    range_um = record.gauge.range_um
    if not _within(columns["reading_um"], -range_um, range_um):
        within = f"a reading within the gauge's range of ±{range_um:g} µm"
        yield "reading_um", np.abs(columns["reading_um"]) > range_um, within
    yield from _travel_findings(record)
    yield from _time_findings(record)
    yield from _sweep_findings(record)


def _within(values: NDArray[np.float64], least: float, largest: float) -> bool:
    """Return whether all values lie between two limits; false where any is not a number."""
    return bool(least <= values.min() and values.max() <= largest)


def _changes(values: NDArray[np.integer[Any]]) -> NDArray[np.intp]:
    """Return the first row, and those with another value than the row before."""
    return np.concatenate([np.zeros(1, np.intp), np.flatnonzero(values[1:] != values[:-1]) + 1])


def _travel_findings(record: Record) -> Iterator[Finding]:
    for name, (least, largest) in zip(SLIDER_COLUMNS, record.machine.sliders.travels_mm, strict=True):
        value = record.columns[name]
        if not _within(value, least - TRAVEL_MARGIN_MM, largest + TRAVEL_MARGIN_MM):
            beyond = (value < least - TRAVEL_MARGIN_MM) | (value > largest + TRAVEL_MARGIN_MM)
            yield name, beyond, f"within the travel of the machine's sliders, {least:g} to {largest:g} mm"


def _time_findings(record: Record) -> Iterator[Finding]:
    """Check that time increases inside a sweep and does not decrease from one sweep to the next."""
    step = np.diff(record.columns["t_s"])
    if (step > 0.0).all():
        return
    inside = np.diff(record.columns["sweep"]) == 0
    yield "t_s", np.concatenate([[False], inside & (step <= 0.0)]), "a time after {before}, the row before"
    yield "t_s", np.concatenate([[False], ~inside & (step < 0.0)]), "a time not before {before}, the row before"


def _sweep_findings(record: Record) -> Iterator[Finding]:
    """Check that a sweep has one circle, one direction and one feed: those of its first sample."""
    columns = record.columns
    begins = _changes(columns["sweep"])
    is_whole = len(np.unique(columns["sweep"][begins])) == len(begins)
    for name in ("circle", "direction", "feed_mm_min"):
        if is_whole and np.isin(_changes(columns[name]), begins).all():
            continue
        values = columns[name].astype(np.float64)
        _, first, member = np.unique(columns["sweep"], return_index=True, return_inverse=True)
        of_sweep = values[first][member]
        differs = np.abs(values - of_sweep) > FEED_TOLERANCE * np.abs(of_sweep)
        yield name, differs, "one value throughout its sweep; another begins with another sweep number"
