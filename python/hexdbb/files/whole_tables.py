"""Tables that lose nothing: narrowed by wrapping texts between words; where that does not suffice, one line per cell.

rich narrows its widest columns whatever they hold: it ends words with an ellipsis and cuts lines at the console's edge,
where `-206.4` becomes `-206`.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator

from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderableType
from rich.measure import Measurement
from rich.table import Column, Table
from rich.text import Text

UNLIMITED = 10_000
"""Characters in which any table is measured as wide as it would like to be."""


def whole(table: Table, console: Console, options: ConsoleOptions, long_lines: bool) -> Iterator[RenderableType]:
    """Yield what shows a table within the width of the options: the table itself, one narrower, or its long form.

    Parameters
    ----------
    table : rich.table.Table
        A table with headings.
    console : rich.console.Console
    options : rich.console.ConsoleOptions
    long_lines : bool
        A table that cannot be narrow enough stays a table, its lines longer than the width.
    """
    free = _loose(table)
    measured = [_measured(column, console, options) for column in free.columns]
    wanted = [max((each.maximum for each in cells), default=0) for cells in measured]
    least = [_least(column, cells) for column, cells in zip(free.columns, measured, strict=True)]
    for column, width in zip(free.columns, wanted, strict=True):
        column.width = width  # rich need not measure the cells again
    beside = _width(free, console, options) - sum(wanted)
    room = options.max_width - beside
    if sum(least) > room and not long_lines:
        yield from long_form(table)
        return
    widths = _shared(wanted, least, room)
    for column, width in zip(free.columns, widths, strict=True):
        column.width, column.no_wrap = width, False  # what may not wrap fits; a heading wraps between words
    total = sum(widths) + beside
    if total > options.max_width:
        free.width = total
    elif table.min_width is not None:
        free.min_width = min(table.min_width, options.max_width)
    yield free


def long_form(table: Table) -> Iterator[Text]:
    """Yield a table line by line: `heading: cell` for every cell that is not empty, rows parted by an empty line.

    A row whose first cell is empty goes on with the row above: it is indented, and not parted from it.
    """
    if table.title is not None:
        yield Text(str(table.title), style=table.title_style or "")
    headings = [_line(column.header, " ") for column in table.columns]
    for number, row in enumerate(zip(*(column.cells for column in table.columns), strict=True)):
        cells = [_line(cell, ", ") for cell in row]
        goes_on = number > 0 and not cells[0]
        if number > 0 and not goes_on:
            yield Text("")
        for heading, cell in zip(headings, cells, strict=True):
            if cell:
                yield Text(f"{'  ' if goes_on else ''}{heading}{': ' if heading else ''}{cell}", overflow="fold")
    if table.show_edge:
        yield Text("")


def _loose(table: Table) -> Table:
    """Return a copy whose columns have a life of their own, no width of its own, and cells that are never cut."""
    free = copy.copy(table)
    free.columns = [copy.copy(column) for column in table.columns]
    for column in free.columns:
        column.overflow = "fold"
    free.min_width = None
    return free


def _width(table: Table, console: Console, options: ConsoleOptions) -> int:
    return Measurement.get(console, options.update(width=UNLIMITED), table).maximum


def _least(column: Column, measured: list[Measurement]) -> int:
    """Return the width that a column needs: of its longest word; where it holds numbers, of its longest cell."""
    heading, *cells = measured
    whole_cells = column.no_wrap or column.justify == "right"
    longest = max((each.maximum if whole_cells else each.minimum for each in cells), default=0)
    return max(longest, heading.minimum)


def _measured(column: Column, console: Console, options: ConsoleOptions) -> list[Measurement]:
    """Return what heading and cells need; at the largest width nothing in them wraps."""
    unlimited = options.update(width=UNLIMITED)
    measured = [_of_cell(each or " ", console, unlimited) for each in (column.header, *column.cells)]
    return [each.clamp(column.min_width) for each in measured]


def _of_cell(cell: RenderableType, console: Console, unlimited: ConsoleOptions) -> Measurement:
    """Return what a cell needs; of plain text its longest word and line, for which rich takes twenty times as long."""
    if not isinstance(cell, str) or not all(map(str.isprintable, lines := cell.split("\n"))):
        return Measurement.get(console, unlimited, cell)
    longest = max(map(cell_len, lines))
    return Measurement(max(map(cell_len, cell.split()), default=longest), longest)


def _shared(wanted: list[int], least: list[int], room: int) -> list[int]:
    """Return widths that fill the room: the widest are narrowed first, to the same width, none below its least."""
    level = max(wanted)
    while level > 0 and sum(_at_level(wanted, least, level)) > room:
        level -= 1
    widths = _at_level(wanted, least, level)
    left = room - sum(widths)
    for index, width in enumerate(widths):
        if left > 0 and width < wanted[index]:
            widths[index], left = width + 1, left - 1
    return widths


def _at_level(wanted: list[int], least: list[int], level: int) -> list[int]:
    return [max(low, min(high, level)) for high, low in zip(wanted, least, strict=True)]


def _line(cell: RenderableType, between: str) -> str:
    """Return a cell or heading as one line, its own lines joined."""
    return between.join(map(str.strip, str(cell).splitlines()))
