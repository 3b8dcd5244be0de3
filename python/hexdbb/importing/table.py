"""The table of readings among the cells of a file: where it begins and ends, and what its columns are called.

A table is a run of rows with two numbers each. Above it stand its headings (up to three rows: names, merged names,
units) and whatever else (a preamble); below it a footer may stand. Two such runs are two tables, of which one must be
chosen; a run that one bad cell interrupts is a table with a bad cell.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from hexdbb.errors import InputError
from hexdbb.importing.grid import Grid, shown
from hexdbb.importing.mapping import Mapping
from hexdbb.importing.quantities import known_unit, recognised

LEAST_ROWS = 8
"""Rows of a table: fewer readings are no circle, and a preamble or footer seldom has as many rows of two numbers."""
MOST_HEADINGS = 3
"""Rows of headings: a group's name, the name, the unit."""
MOSTLY = 0.8
"""Part of a column's cells that are numbers, from which it is a column of numbers with bad cells in it."""
WITH_UNIT = re.compile(r"[+-]?\d[\d.,']*\s*([^\d\s].*)")
"""A number and what may be its unit."""


@dataclass(frozen=True, eq=False)
class Table:
    """A table found.

    Attributes
    ----------
    grid : Grid
    rows : tuple of int
        Its rows in the grid.
    part : tuple of int
        Number of the table of each row, from 0, where several were chosen.
    headings : tuple of str
        Of each column; empty where it has none.
    how : str
        What was found, in words.
    """

    grid: Grid
    rows: tuple[int, ...]
    part: tuple[int, ...]
    headings: tuple[str, ...]
    how: str


def find_table(grid: Grid, mapping: Mapping) -> Table:
    """Find the table of readings.

    Raises
    ------
    InputError
        There is none, there are several, or a cell in it is no number; names file, line and what was expected.
    """
    counts = [sum(grid.number(cell) is not None for cell in cells) for cells in grid.rows]
    if mapping.rows is not None:
        ranges = [(_place(grid, first), _place(grid, last)) for first, last in mapping.rows]
        for first, last in ranges:
            _require_numbers(grid, counts, first, last)
    else:
        ranges = [_found(grid, counts)]
    first, last = ranges[0][0], ranges[-1][1]
    heads, chosen = _headings(grid, counts, first, mapping)
    after = sum(any(cell != "" for cell in cells) for cells in grid.rows[last + 1 :])
    left = f", {after} {grid.unit}{'s' * (after != 1)} after them left out" if after else ""
    rows = tuple(row for a, b in ranges for row in range(a, b + 1))
    where = " and ".join(f"{grid.lines[a]}-{grid.lines[b]}" for a, b in ranges)
    if chosen and not any(isinstance(column, int) for column in mapping.columns.values()):
        _require_names(grid, first, chosen)
    how = f"{len(rows)} rows ({grid.unit}s {where}{left})"
    named = f"names in {_where(grid, chosen)}" if chosen else "no names"
    part = tuple(number for number, (a, b) in enumerate(ranges) for _ in range(a, b + 1))
    return Table(grid, rows, part, heads, f"{named}, {how}")


def _place(grid: Grid, line: int) -> int:
    """Return the row of the grid that stands in a line."""
    found = [place for place, each in enumerate(grid.lines) if each == line]
    if not found:
        last = grid.lines[-1] if len(grid.lines) else 0
        raise InputError(f"{grid.name}: {grid.unit} {line} is not there (expected one up to {last}, the last)")
    return found[0]


def _require_numbers(grid: Grid, counts: Sequence[int], first: int, last: int) -> None:
    for row in range(first, last + 1):
        if counts[row] < 1:
            raise InputError(f"{grid.name}: {grid.at(row)}: holds no number (expected readings, as --rows states)")


def _found(grid: Grid, counts: Sequence[int]) -> tuple[int, int]:
    runs = _runs(counts)
    tables = [(first, last) for first, last in runs if last - first + 1 >= LEAST_ROWS]
    if not tables:
        expected = f"{LEAST_ROWS} rows at least of two numbers each: angle and reading{_unit_note(grid)}"
        raise InputError(f"{grid.name}: no table of readings (expected {expected})")
    first, last = tables[0]
    _require_no_bad_cell(grid, counts, first, last)
    if len(tables) > 1:
        which = " and ".join(f"{grid.lines[a]}-{grid.lines[b]}" for a, b in tables)
        options = " ".join(f"--rows {grid.lines[a]}:{grid.lines[b]}" for a, b in tables)
        expected = f"one; one of {options} chooses it, all read them one after another"
        raise InputError(f"{grid.name}: {len(tables)} tables, {grid.unit}s {which} (expected {expected})")
    _require_no_rest(grid, first, last)
    return first, last


def _unit_note(grid: Grid) -> str:
    """Return what to add where cells are numbers with their units, which belong into the headings."""
    # Where there are no numbers the delimiter is not known either.
    cells = (cell for row in grid.rows for text in row if isinstance(text, str) for cell in re.split(r"[;\t|]", text))
    with_unit = [cell for cell in cells if (found := WITH_UNIT.fullmatch(cell)) and known_unit(found[1])]
    return f"; units belong into the headings, not into cells as {shown(with_unit[0])}" if with_unit else ""


def _runs(counts: Sequence[int]) -> list[tuple[int, int]]:
    """Return first and last row of each run of rows with two numbers or more."""
    runs: list[tuple[int, int]] = []
    for row, count in enumerate(counts):
        if count < 2:
            continue
        if runs and runs[-1][1] == row - 1:
            runs[-1] = runs[-1][0], row
        else:
            runs.append((row, row))
    return runs


def _require_no_bad_cell(grid: Grid, counts: Sequence[int], first: int, last: int) -> None:
    """Check that what ends a table is no row of it with a bad cell."""
    for row, beyond in ((first - 1, first - 2), (last + 1, last + 2)):
        if 0 <= row < len(grid.rows):
            _require_no_bad_cell_in(grid, (first, last), row, 0 <= beyond < len(counts) and counts[beyond] >= 2)


def _require_no_bad_cell_in(grid: Grid, table: tuple[int, int], row: int, goes_on: bool) -> None:
    """Check a row beside a table: numbers in its columns, or beyond it, make it a row of the table."""
    numeric = _numeric_columns(grid, *table)
    is_number = [grid.number(grid.cell(row, column)) is not None for column in numeric]
    if not any(is_number) or not (goes_on or is_number[0]):
        return
    column = numeric[is_number.index(False)] if False in is_number else numeric[0]
    raise InputError(f"{grid.name}: {grid.at(row)}: column {column + 1}: {described(grid, row, column)}")


def _require_no_rest(grid: Grid, first: int, last: int) -> None:
    """Check that no row apart from a table looks like one of it."""
    numeric = _numeric_columns(grid, first, last)
    for row in (*range(first), *range(last + 1, len(grid.rows))):
        if numeric and all(grid.number(grid.cell(row, column)) is not None for column in numeric):
            table = f"{grid.unit}s {grid.lines[first]}-{grid.lines[last]}"
            expected = f"none; --rows {grid.lines[first]}:{grid.lines[last]} leaves it out"
            raise InputError(
                f"{grid.name}: {grid.at(row)}: looks like a row of the table, {table} (expected {expected})"
            )


def _numeric_columns(grid: Grid, first: int, last: int) -> list[int]:
    """Return the columns that hold numbers in most rows."""
    width = max(len(cells) for cells in grid.rows[first : last + 1])
    return [column for column in range(width) if _numbers(grid, first, last, column) >= MOSTLY * (last - first + 1)]


def described(grid: Grid, row: int, column: int) -> str:
    """Return what an error says of a cell that is no number."""
    cell = grid.cell(row, column)
    note = "; a spreadsheet program may have taken a number for a date" if not isinstance(cell, str | float) else ""
    if cell == "" and grid.unit == "row":
        note = "; a formula has a value once a spreadsheet program has saved the file"
    return f"{shown(cell)} (expected a number{note})"


def _numbers(grid: Grid, first: int, last: int, column: int) -> int:
    return sum(grid.number(grid.cell(row, column)) is not None for row in range(first, last + 1))


def _headings(grid: Grid, counts: Sequence[int], first: int, mapping: Mapping) -> tuple[tuple[str, ...], range]:
    """Return the headings of the columns, and the rows they stand in."""
    width = max(len(cells) for cells in grid.rows[first : first + LEAST_ROWS])
    best, chosen = ("",) * width, range(0)
    if mapping.header == 0:
        return best, chosen
    if mapping.header is not None:
        row = _place(grid, mapping.header)
        return _joined(grid, range(row, row + 1), width), range(row, row + 1)
    for begin in range(first - 1, max(first - 1 - MOST_HEADINGS, -1), -1):
        if not _is_text(grid, counts, begin):
            break
        heads = _joined(grid, range(begin, first), width)
        if _worth(heads) > _worth(best) or not chosen:
            best, chosen = heads, range(begin, first)
    return best, chosen


def _where(grid: Grid, rows: range) -> str:
    """Return rows in words: `line 4`, `rows 4-5`."""
    return grid.at(rows[0]) if len(rows) == 1 else f"{grid.unit}s {grid.lines[rows[0]]}-{grid.lines[rows[-1]]}"


def _require_names(grid: Grid, first: int, heads: range) -> None:
    """Check that there are as many names as cells: a decimal comma between commas makes two cells of one number."""
    names = max(_filled(grid, row) for row in heads)
    cells = _filled(grid, first)
    if cells > names or names > len(grid.rows[first]):  # the last cells of a row may be empty
        note = "; a decimal comma needs another delimiter, or quotes" if cells > names else ""
        expected = f"as many{note}; columns may be named by number: --column angle=1"
        raise InputError(f"{grid.name}: {grid.at(first)}: {cells} cells for {names} names (expected {expected})")


def _filled(grid: Grid, row: int) -> int:
    """Return the number of cells up to the last that is not empty."""
    return max((place for place, cell in enumerate(grid.rows[row], 1) if cell != ""), default=0)


def _is_text(grid: Grid, counts: Sequence[int], row: int) -> bool:
    return counts[row] == 0 and any(isinstance(cell, str) and cell for cell in grid.rows[row])


def _joined(grid: Grid, rows: range, width: int) -> tuple[str, ...]:
    """Return the texts of some rows column by column, a unit last; a group's name holds for empty cells to its right.

    Columns without a name of their own or a value are no part of a group: they part tables that stand side by side.
    """
    parts: list[list[str]] = [[] for _ in range(width)]
    named = [any(grid.cell(row, column) != "" for row in (rows[-1], rows[-1] + 1)) for column in range(width)]
    for row in rows:
        before = ""
        for column in range(width):
            cell = grid.cell(row, column)
            text = cell if isinstance(cell, str) else ""
            if row != rows[-1] and not known_unit(text):
                text = before = text or before
            if text and named[column]:
                parts[column].append(text)
    return tuple(" ".join(sorted(each, key=lambda text: known_unit(text) is not None)) for each in parts)


def _worth(heads: Sequence[str]) -> tuple[int, int]:
    """Return how many different quantities, and how many units, headings name."""
    found = [recognised(each) for each in heads if each]
    names = [name for name, _ in found if name is not None]
    twice = len(names) - len(set(names))
    return len(set(names)) - twice, sum(unit is not None for _, unit in found)
