"""Location of a fault in a CSV file. Used only after reading has failed, hence exact rather than fast."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

from hexdbb.errors import InputError
from hexdbb.files.delimited import expected_cells, read_rows
from hexdbb.files.validation import format_value
from hexdbb.record.columns import COLUMN_TYPES, REQUIRED_COLUMNS, RowSource


def line_of_row(path: Path, row: int) -> int:
    """Return the line of a CSV file that holds a data row (from 0); empty lines do not count as rows."""
    for index, (line, _) in enumerate(_rows(path)):
        if index == row:
            return line
    return row + 2


def first_bad_cell(path: Path, names: list[str], reason: Exception) -> InputError:
    """Return the error that names the first row with too few or too many cells or with a cell that is not a number.

    Parameters
    ----------
    path : Path
        The CSV file.
    names : list of str
        Its columns.
    reason : Exception
        Error of the CSV reader; its first line is used where no cell is found to be wrong.
    """
    source = RowSource(str(path), lambda row: line_of_row(path, row))
    for row, (_, cells) in enumerate(_rows(path)):
        if len(cells) != len(names):
            return source.bad_row(row, "cells", str(len(cells)), expected_cells(len(cells), len(names)))
        for name, cell in zip(names, cells, strict=True):
            if name in COLUMN_TYPES and not _is_number(cell, may_be_empty=name not in REQUIRED_COLUMNS):
                return source.bad_row(row, name, format_value(cell), "a number")
    return InputError(f"{path}: {str(reason).splitlines()[0]}")


def _rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield line number and cells of each data row."""
    rows = read_rows(path)
    next(rows, None)
    yield from rows


def _is_number(cell: str, may_be_empty: bool) -> bool:
    if not cell.strip():
        return may_be_empty
    try:
        return not math.isnan(float(cell))
    except ValueError:
        return False
