"""Rows of a CSV file (RFC 4180), a row a line: what other programs write into quotes must end in the same line."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator
from pathlib import Path

from hexdbb.errors import InputError


def read_rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield line (from 1) and cells of each row that is not empty; the first is the row of names.

    Raises
    ------
    InputError
        One line naming file and line: the file cannot be read, or a quote is not closed in its line.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            yield from rows_of(file, str(path))
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: byte {error.start} is not UTF-8 (expected UTF-8 text)") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None


def rows_of(
    lines: Iterable[str], name: str, delimiter: str = ",", keep_empty: bool = False
) -> Iterator[tuple[int, list[str]]]:
    """Yield line (from 1) and cells of each row of some lines, with their ends.

    Parameters
    ----------
    lines : iterable of str
    name : str
        File that they are of, for errors.
    delimiter : str
        One character.
    keep_empty : bool
        Whether rows without cells are yielded too.

    Raises
    ------
    InputError
        A quote is not closed in its line; names file and line.
    """
    expected = "every quote closed in its line, and none inside a cell without quotes"
    line = 0
    try:
        reader = csv.reader(lines, delimiter=delimiter, strict=True)
        for cells in reader:
            if any("\n" in cell or "\r" in cell for cell in cells):
                raise InputError(f"{name}: line {line + 1}: a stray quote (expected {expected})")
            line = reader.line_num
            if cells or keep_empty:
                yield line, cells
    except csv.Error:
        raise InputError(f"{name}: line {line + 1}: a stray quote (expected {expected})") from None


def require_cells(path: Path, line: int, cells: list[str], count: int) -> None:
    """Check that a row has as many cells as the row of names.

    Raises
    ------
    InputError
        It has not; names file and line.
    """
    if len(cells) != count:
        raise InputError(f"{path}: line {line}: cells: {len(cells)} (expected {expected_cells(len(cells), count)})")


def expected_cells(found: int, count: int) -> str:
    """Return what was expected of a row with a wrong number of cells; a decimal comma makes one too many."""
    return f"{count}, as the first line has" + ("; the decimal mark is a point" if found > count else "")
