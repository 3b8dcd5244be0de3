"""Are the samples of a record what they claim to be? Every check gives the first row that fails it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.record.columns import REQUIRED_COLUMNS, SLIDER_COLUMNS, Origin
from hexdbb.record.record import Record

TRAVEL_MARGIN_MM = 1.0
"""How far a slider may stand beyond its travel before its unit, its zero or its machine must be wrong."""
FEED_TOLERANCE = 1e-6
"""Relative difference of two feeds taken as one."""

Bad = NDArray[np.bool_]
Finding = tuple[str, Bad, str]
"""Column, rows that are wrong, and what was expected; `{before}` stands for the value one row up."""


def check_record(record: Record, origin: Origin) -> None:
    """Check every sample.

    Raises
    ------
    InputError
        There are no samples.
    BadRowError
        Naming the first row that is wrong, its column, its value and what was expected.
    """
    if len(record) == 0:
        raise InputError(f"{origin.name}: holds no samples (expected at least one)")
    failed = [(int(np.argmax(bad)), column, expected) for column, bad, expected in _findings(record) if bad.any()]
    if not failed:
        return
    row, column, expected = min(failed, key=lambda finding: finding[0])
    values = record.columns[column]
    before = values[row - 1].item() if row > 0 else None
    raise origin.bad(row, column, values[row].item(), expected.format(before=before))


def _findings(record: Record) -> Iterator[Finding]:
    columns = record.columns
    for name, kind in REQUIRED_COLUMNS.items():
        if kind is np.float64:
            yield name, ~np.isfinite(columns[name]), "a finite number"
    yield "direction", np.abs(columns["direction"]) != 1, "1 (counter-clockwise) or -1 (clockwise)"
    ids = [circle.id for circle in record.circles]
    yield "circle", ~np.isin(columns["circle"], ids), "the id of a circle: " + ", ".join(map(str, ids))
    yield "feed_mm_min", ~(columns["feed_mm_min"] > 0.0), "a number > 0"
    range_um = record.gauge.range_um
    within = f"a reading within the gauge's range of +-{range_um:g} um"
    yield "reading_um", np.abs(columns["reading_um"]) > range_um, within
    yield from _travel_findings(record)
    yield from _time_findings(record)
    yield from _sweep_findings(record)


def _travel_findings(record: Record) -> Iterator[Finding]:
    least, largest = record.machine.sliders.travel_mm
    for name in SLIDER_COLUMNS:
        value = record.columns[name]
        beyond = (value < least - TRAVEL_MARGIN_MM) | (value > largest + TRAVEL_MARGIN_MM)
        yield name, beyond, f"within the travel of the machine's sliders, {least:g} to {largest:g} mm"


def _time_findings(record: Record) -> Iterator[Finding]:
    """Time runs forward inside a sweep, and does not go back from one sweep to the next."""
    time, sweep = record.columns["t_s"], record.columns["sweep"]
    step, inside = np.diff(time), np.diff(sweep) == 0
    yield "t_s", np.concatenate([[False], inside & (step <= 0.0)]), "a time after {before}, the row before"
    yield "t_s", np.concatenate([[False], ~inside & (step < 0.0)]), "a time not before {before}, the row before"


def _sweep_findings(record: Record) -> Iterator[Finding]:
    """Keep a sweep to one circle in one direction at one feed."""
    columns = record.columns
    _, first, member = np.unique(columns["sweep"], return_index=True, return_inverse=True)
    for name in ("circle", "direction", "feed_mm_min"):
        values = columns[name].astype(np.float64)
        begun_with = values[first][member]
        differs = np.abs(values - begun_with) > FEED_TOLERANCE * np.abs(begun_with)
        yield name, differs, "one value throughout its sweep; another begins with another sweep number"
