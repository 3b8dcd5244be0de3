"""Where in a CSV file the trouble is: only used once reading has failed, so slow and exact rather than fast."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator
from pathlib import Path

from hexdbb.errors import InputError
from hexdbb.files.validation import format_value
from hexdbb.record.columns import COLUMN_TYPES, REQUIRED_COLUMNS, Origin


def line_of_row(path: Path, row: int) -> int:
    """Give the line of the file that holds a data row (from 0); empty lines are no rows."""
    for index, (line, _) in enumerate(_rows(path)):
        if index == row:
            return line
    return row + 2


def first_bad_cell(path: Path, names: list[str], reason: Exception) -> InputError:
    """Make the error that names the first row with too few cells or with a cell that is not a number.

    Parameters
    ----------
    path : Path
        The CSV file.
    names : list of str
        Its columns.
    reason : Exception
        What the reader said; given back where the cells do not tell more.
    """
    origin = Origin(str(path), lambda row: line_of_row(path, row))
    for row, (_, cells) in enumerate(_rows(path)):
        if len(cells) != len(names):
            return origin.bad(row, "cells", str(len(cells)), f"{len(names)}, as the first line has")
        for name, cell in zip(names, cells, strict=True):
            if name in COLUMN_TYPES and not _is_number(cell, may_be_empty=name not in REQUIRED_COLUMNS):
                return origin.bad(row, name, format_value(cell), "a number")
    return InputError(f"{path}: {str(reason).splitlines()[0]}")


def _rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield line number and cells of each data row."""
    with path.open(encoding="utf-8-sig", errors="replace", newline="") as file:
        reader = csv.reader(file)
        next(reader, None)
        for cells in reader:
            if cells:
                yield reader.line_num, cells


def _is_number(cell: str, may_be_empty: bool) -> bool:
    if not cell.strip():
        return may_be_empty
    try:
        return not math.isnan(float(cell))
    except ValueError:
        return False
