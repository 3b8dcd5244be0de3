"""Values of a table's columns, in the units of a record; whether they can be of the unit that is stated.

A unit that no heading states is taken from the mapping, or asked for; angles alone are recognised by their range. What
is stated is doubted by its magnitude: readings that span less than any ball bar shows, or exceed any gauge, and angles
of a circle that spans 6.28 degrees. Nothing is converted on such a doubt: the error says what the values look like, and
a unit that the mapping states is taken as it is.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import timedelta

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.importing.clock import clock_times
from hexdbb.importing.columns import Column
from hexdbb.importing.grid import shown
from hexdbb.importing.mapping import Mapping
from hexdbb.importing.numbers import MINUS
from hexdbb.importing.quantities import CCW, CW, NEVER_STATED, QUANTITIES, UNITS_OF
from hexdbb.importing.table import Table, described

Floats = NDArray[np.float64]

LEAST_SPAN_UM = 1.0
"""Smallest span of the readings of a circle, µm: noise of 0.2 µm, that of the best bars, makes as much of a few hundred
readings."""
WHOLE_DEG, WHOLE_RAD = 90.0, (6.0, 6.6)
"""Angles that span 90 or more are degrees where nothing is stated: ninety radians are fourteen turns without a wrap.
Angles stated as degrees that span one turn of radians are doubted."""
LEAST_ARC_DEG, LARGEST_STEP_DEG = 10.0, 60.0
"""Shortest arc that is a test, and largest step between readings of one, deg: six readings a turn show no circle.
Angles in turns span one, thousandths of a degree step by hundreds."""
FEED_OFF = 0.05
"""Part by which a feed may differ from the plan's: programs round feeds, while units differ by 25 or more."""
SIGNS = {"+": 1, "-": -1}
"""Directions of travel as signs without a number."""


def numbers_of(table: Table, column: Column) -> Floats:
    """Return the numbers of a column, shape (n,), in the file's own unit.

    Raises
    ------
    InputError
        A cell is no number; names line, column, cell and what was expected.
    """
    grid, rows = table.grid, table.rows
    values = [grid.number(grid.cell(row, column.place)) for row in rows]
    for row, value in zip(rows, values, strict=True):
        if value is None or not np.isfinite(value):
            raise InputError(f"{grid.name}: {grid.at(row)}: column {column}: {described(grid, row, column.place)}")
    return np.array(values, dtype=np.float64)


def values_of(table: Table, column: Column, unit: str | None = None) -> Floats:
    """Return the values of a column in the unit of a record, shape (n,)."""
    values = numbers_of(table, column)
    if column.quantity in NEVER_STATED:
        return values
    chosen = unit or column.unit
    if chosen is None:
        units = ", ".join(UNITS_OF[column.quantity])
        asked = "reading" if column.quantity.startswith("reading") else column.quantity
        seen = f"values up to {np.abs(values).max():.6g}"
        expected = f"--unit {asked}=UNIT, one of {units}"
        raise InputError(f"{table.grid.name}: column {column}: no unit is stated; {seen} (expected {expected})")
    return values * QUANTITIES[column.quantity].units[chosen]


def reading_um(table: Table, column: Column, range_um: float, bar_mm: float) -> Floats:
    """Return readings, µm; doubt a unit that gives more than the gauge's range, or less than a circle shows."""
    values = values_of(table, column)
    doubt = doubt_of(values, str(column.unit), range_um, bar_mm)
    if doubt and not column.is_stated:
        raise InputError(f"{table.grid.name}: column {column}, in {column.unit} by its name: {doubt}")
    return values


def doubt_of(reading_um: Floats, unit: str, range_um: float, bar_mm: float) -> str:
    """Return why readings cannot be of the unit that a file states, and what to do; empty where they can be."""
    largest, span = float(np.abs(reading_um).max()), float(np.ptp(reading_um))
    own = f"--unit reading={unit} if they are {unit} all the same"
    if np.abs(reading_um - 1e3 * bar_mm).max() <= 10.0 * range_um:
        return f"values near {bar_mm:g} mm, the bar's own length (expected its deviation from it); {own}"
    if largest > range_um:
        like = "they look like µm: --unit reading=um; " if unit == "mm" and largest <= 1e3 * range_um else ""
        return f"readings up to {largest:.6g} µm (expected ±{range_um:g} µm at most, the gauge's range); {like}{own}"
    if span < LEAST_SPAN_UM:
        like = "they look like mm: --unit reading=mm; " if unit == "um" else ""
        return f"readings span {span:.3g} µm only (expected {LEAST_SPAN_UM:g} at least, of a circle); {like}{own}"
    return ""


def angle_deg(table: Table, column: Column) -> tuple[Floats, str]:
    """Return angles, degrees, wrapped or not as the file has them, and their unit; doubt one that cannot be."""
    numbers = numbers_of(table, column)
    span = float(np.ptp(numbers))
    if column.unit is None:
        if span < WHOLE_DEG:
            like = " as radians of a whole turn would" if WHOLE_RAD[0] <= span <= WHOLE_RAD[1] else ""
            expected = "--unit angle=deg or rad"
            seen = f"angles from {numbers.min():.6g} to {numbers.max():.6g}{like}"
            raise InputError(f"{table.grid.name}: column {column}: no unit is stated; {seen} (expected {expected})")
        _require_a_circle(table, column, numbers, "no unit is stated")
        return numbers, "deg"
    if column.unit == "deg" and not column.is_stated and WHOLE_RAD[0] <= span <= WHOLE_RAD[1]:
        expected = "a whole turn; --unit angle=rad, or =deg if it is such an arc"
        seen = f"angles span {span:.4g}°, as radians of a whole turn would"
        raise InputError(f"{table.grid.name}: column {column}, in deg by its name: {seen} (expected {expected})")
    values = numbers * QUANTITIES["angle"].units[column.unit]
    if not column.is_stated:
        _require_a_circle(table, column, values, f"in {column.unit} by its name")
    return values, column.unit


def _require_a_circle(table: Table, column: Column, angle: Floats, unit: str) -> None:
    """Check that angles, degrees, span an arc and are dense enough on it; `InputError` where the unit must be wrong."""
    span, step = float(np.ptp(angle)), float(np.median(np.abs(np.diff(angle))))
    if span < LEAST_ARC_DEG or step > LARGEST_STEP_DEG:
        seen = f"angles span {span:.4g}° in steps of {step:.3g}°"
        expected = f"{LEAST_ARC_DEG:g}° or more in steps of {LARGEST_STEP_DEG:g}° at most; --unit angle=UNIT, one of"
        units = ", ".join(UNITS_OF["angle"])
        raise InputError(f"{table.grid.name}: column {column}, {unit}: {seen} (expected {expected} {units})")


def feed_mm_min(table: Table, column: Column, planned_mm_min: Sequence[float]) -> Floats:
    """Return feeds, mm/min; doubt those that are none of the plan's."""
    values = values_of(table, column)
    for value in np.unique(values):
        if column.is_stated or any(abs(value / each - 1.0) <= FEED_OFF for each in planned_mm_min):
            continue
        names = ", ".join(f"{each:g}" for each in planned_mm_min)
        like = "; they look like mm/s: --unit feed=mm/s" if column.unit == "mm/min" and value < 100.0 else ""
        own = f"--unit feed={column.unit} if it was driven all the same, --column feed= leaves the column out"
        seen = f"column {column}, in {column.unit} by its name: {value:.6g} mm/min"
        raise InputError(f"{table.grid.name}: {seen} (expected a feed of the plan, {names} mm/min{like}; {own})")
    return values


def time_s(table: Table, column: Column) -> Floats:
    """Return times, s, shape (n,): a column of numbers with a unit, or clock times, counted from the first."""
    grid, rows = table.grid, table.rows
    if grid.number(grid.cell(table.rows[0], column.place)) is not None:
        return values_of(table, column)
    found = clock_times(table, column.place)
    if None in found:
        row = rows[found.index(None)]
        cell = shown(grid.cell(row, column.place))
        expected = "a number, or a time as 2026-03-01 10:22:03.250; --column time= leaves the column out"
        raise InputError(f"{grid.name}: {grid.at(row)}: column {column}: {cell} (expected {expected})")
    times = [each for each in found if each is not None]
    values: Floats = np.array([(each - times[0]) / timedelta(seconds=1) for each in times], dtype=np.float64)
    return values


def direction(table: Table, column: Column, mapping: Mapping) -> NDArray[np.int8]:
    """Return directions, +1 counter-clockwise, -1 clockwise, shape (n,), of words or numbers.

    Raises
    ------
    InputError
        A word that is not known; names it and what was expected.
    """
    grid = table.grid
    known: dict[str, int] = {word.casefold(): value for word, value in mapping.directions.items()}
    found = []
    for row in table.rows:
        cell = grid.cell(row, column.place)
        word = shown(cell).strip('"').casefold()
        if word not in known:
            number = grid.number(cell)
            if number in (1.0, -1.0):
                known[word] = int(number or 0)
            elif word.translate(MINUS) in SIGNS:
                known[word] = SIGNS[word.translate(MINUS)]
            elif isinstance(cell, str) and re.search(CCW, word):
                known[word] = 1
            elif isinstance(cell, str) and re.search(CW, word):
                known[word] = -1
            else:
                expected = "1 or CCW, -1 or CW; words of your own in [directions] of a mapping file"
                raise InputError(f"{grid.name}: {grid.at(row)}: column {column}: {shown(cell)} (expected {expected})")
        found.append(known[word])
    return np.array(found, dtype=np.int8)
