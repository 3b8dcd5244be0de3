"""The readings of a table: one row a reading, or one row a place with a column for each direction of travel."""

from __future__ import annotations

from typing import Any

import numpy as np

from hexdbb.errors import InputError
from hexdbb.importing import values as v
from hexdbb.importing.clock import started
from hexdbb.importing.columns import Column, assigned
from hexdbb.importing.grid import Grid
from hexdbb.importing.quantities import QUANTITIES
from hexdbb.importing.series import Floats, Series
from hexdbb.importing.setting import Setting
from hexdbb.importing.table import Table, find_table
from hexdbb.record import SLIDER_COLUMNS

SLIDERS = tuple(name.removesuffix("_mm") for name in SLIDER_COLUMNS)
PLAIN = ("circle", "sweep", "lap", "temperature", *SLIDERS)
"""Quantities that are taken as they are, but for their unit."""


def series_of(grid: Grid, setting: Setting) -> Series:
    """Read the table of a grid as a series of readings.

    Raises
    ------
    InputError
        One line naming file, line, column, value and what was expected.
    """
    table = find_table(grid, setting.mapping)
    found = assigned(table, setting.mapping)
    angle_deg, angle_unit = v.angle_deg(table, found["angle"])
    lines = np.array([grid.lines[row] for row in table.rows])
    others = {QUANTITIES[name].column: v.values_of(table, found[name]) for name in PLAIN if name in found}
    if "feed" in found:
        others["feed_mm_min"] = v.feed_mm_min(table, found["feed"], setting.every_feed_mm_min())
    _require_all_sliders(table, others)
    if table.part[-1] > 0 and "sweep" not in others:
        others["sweep"] = np.array(table.part, dtype=np.float64)
    began = started(table)
    metadata: dict[str, Any] = {} if began is None else {"started": began}
    notes = [f"{grid.how}; {table.how}; {_columns_words(found, angle_unit, table)}"]
    wide = [(name, sign) for name, sign in (("reading_ccw", 1), ("reading_cw", -1)) if name in found]
    if wide and "reading" in found:
        first, other = found["reading"], found[wide[0][0]]
        expected = "one reading, or one for each direction; --column reading= leaves the first out"
        raise InputError(f"{grid.name}: columns {first} and {other} both hold readings (expected {expected})")
    if wide:
        if "time" in found:
            notes.append(f"{found['time']} left out: one time for two runs")
        return _by_place(
            table, found, wide, Series(angle_deg, angle_deg, None, lines, others, notes, metadata), setting
        )
    if "time" in found:
        others["t_s"] = v.time_s(table, found["time"])
    reading_um = _reading(table, found["reading"], setting)
    direction = v.direction(table, found["direction"], setting.mapping) if "direction" in found else None
    if direction is None and setting.mapping.direction is not None:
        direction = np.full(len(lines), setting.mapping.direction, np.int8)
    return Series(angle_deg, reading_um, direction, lines, others, notes, metadata)


def _reading(table: Table, column: Column, setting: Setting) -> Floats:
    gauge = setting.plan.gauge
    return v.reading_um(table, column, gauge.range_um, gauge.bar_length_mm)


def _by_place(
    table: Table, found: dict[str, Column], wide: list[tuple[str, int]], places: Series, setting: Setting
) -> Series:
    """Return the runs of a table with a row a place: clockwise runs pass its rows from the last to the first."""
    turned = np.diff(places.angle_deg)
    rises = float(np.sum((turned + 180.0) % 360.0 - 180.0)) >= 0.0
    up, down = np.arange(len(places)), np.arange(len(places))[::-1]
    runs, readings, directions = [], [], []
    for name, sign in wide:
        order = up if (sign > 0) == rises else down
        runs.append(order)
        readings.append(_reading(table, found[name], setting)[order])
        directions.append(np.full(len(order), sign, np.int8))
    whole = places.rows(np.concatenate(runs))
    return Series(
        whole.angle_deg,
        np.concatenate(readings),
        np.concatenate(directions),
        whole.lines,
        {**whole.others, "sweep": np.repeat(np.arange(float(len(wide))), len(places))},
        whole.notes,
        whole.metadata,
    )


def _require_all_sliders(table: Table, others: dict[str, Floats]) -> None:
    there = [name for name in SLIDER_COLUMNS if name in others]
    if there and len(there) < len(SLIDER_COLUMNS):
        missing = ", ".join(name.removesuffix("_mm") for name in SLIDER_COLUMNS if name not in others)
        expected = "all six slider coordinates, or none; --column s1= leaves one out"
        raise InputError(f"{table.grid.name}: no column of {missing} (expected {expected})")


def _columns_words(found: dict[str, Column], angle_unit: str, table: Table) -> str:
    """Return which column was read as what, and which were not read."""
    words = []
    for name, column in found.items():
        unit = angle_unit if name == "angle" else column.unit
        words.append(f"{name} {column}{f' in {unit}' if unit else ''}")
    taken = {column.place for column in found.values()}
    left = [f'"{heading}"' for place, heading in enumerate(table.headings) if heading and place not in taken]
    return ", ".join(words) + (f"; not read: {', '.join(left)}" if left else "")
