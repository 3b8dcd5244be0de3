"""Dates and times of day in the columns of a table: when readings were taken, and on which day."""

from __future__ import annotations

import re
from contextlib import suppress
from datetime import date, datetime, time

from hexdbb.importing.grid import Cell
from hexdbb.importing.quantities import recognised
from hexdbb.importing.table import Table

DOTTED_DATE = re.compile(r"^(\d{1,2})\.(\d{1,2})\.(\d{4})(?=\D|$)")
"""Day, month, year with points between them, which nobody writes in another order; with slashes either may be first."""
NO_DATE = date(1, 1, 1)
"""Day of a time without a date."""
MIDNIGHT = time(0, 0)


def clock_times(table: Table, column: int) -> list[datetime | None]:
    """Return the times of a column (its number from 0), on `NO_DATE` where they have no date; None for other cells."""
    return [clock_time(table.grid.cell(row, column)) for row in table.rows]


def holds_days(table: Table, column: int) -> bool:
    """Return whether a column holds dates alone, no times: it says on which day a test was made, and no more."""
    times = clock_times(table, column)
    return all(each is not None and each.date() != NO_DATE and each.time() == MIDNIGHT for each in times)


def started(table: Table) -> str | None:
    """Return the first time of a table's columns of dates, or its day, ISO 8601; None where it has no dates."""
    dates: list[datetime] = []
    for column, heading in enumerate(table.headings):
        times = clock_times(table, column) if recognised(heading)[0] == "time" else []
        dated = [each for each in times if each is not None and each.date() != NO_DATE]
        dates += [min(dated)] if dated and len(dated) == len(times) else []
    if not dates:
        return None
    first = max(dates)  # of a day and a time on it, the time
    return first.date().isoformat() if first.time() == MIDNIGHT else first.isoformat(timespec="seconds")


def clock_time(cell: Cell) -> datetime | None:
    """Return the time that a cell holds, on `NO_DATE` where it has no date; None where it is none."""
    if isinstance(cell, str):
        text = DOTTED_DATE.sub(lambda found: f"{found[3]}-{found[2]:0>2}-{found[1]:0>2}", cell.replace(",", "."))
        for parse in (datetime.fromisoformat, time.fromisoformat):
            with suppress(ValueError):
                return clock_time(parse(text))
        return None
    if isinstance(cell, datetime):
        return cell.replace(tzinfo=None)
    return datetime.combine(NO_DATE, cell.replace(tzinfo=None)) if isinstance(cell, time) else None
