"""A sheet of an Excel workbook as cells, by openpyxl (extra ``hexdbb[excel]``), imported when a workbook is read."""

from __future__ import annotations

import warnings
import zipfile
from collections.abc import Iterator
from datetime import date, datetime, time
from pathlib import Path
from typing import Any

from hexdbb.errors import InputError
from hexdbb.files.workbooks import require_openpyxl
from hexdbb.importing.grid import Cell, Grid
from hexdbb.importing.mapping import Mapping
from hexdbb.importing.numbers import decimal_mark, reader
from hexdbb.importing.table import LEAST_ROWS

MOST_UNPACKED = 2_000_000_000
"""Largest content of a workbook, bytes unpacked: a million rows of twenty columns are 1e9; more is an attack."""
ROWS_LOOKED_AT = 50
"""Rows of a sheet that are looked at to choose one that holds readings."""


def read_sheet_grid(path: Path, mapping: Mapping) -> Grid:
    """Read a sheet of a workbook: the one that the mapping names, else the only one that holds a table.

    Raises
    ------
    InputError
        It is no workbook, openpyxl is not installed, there is no such sheet, or several may be meant.
    """
    openpyxl = require_openpyxl(path)
    _require_workbook(path)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of parts of a workbook that hold no cells
            book = openpyxl.load_workbook(path, read_only=True, data_only=True)
    except Exception:  # openpyxl raises what its XML reader and zip reader raise
        raise InputError(f"{path}: no workbook of Excel, or damaged (expected one saved as .xlsx)") from None
    try:
        sheet = _sheet(path, book, mapping.sheet)
        rows = [list(map(_cell, row)) for row in sheet.iter_rows(values_only=True)]
    except (ValueError, KeyError, zipfile.BadZipFile, SyntaxError, AttributeError) as error:
        raise InputError(f"{path}: damaged: {str(error).splitlines()[0]} (expected a whole Excel file)") from None
    finally:
        book.close()
    several = len(book.sheetnames) > 1
    texts = (cell for cells in rows for cell in cells if isinstance(cell, str) and cell)
    name = f"{path}, sheet {sheet.title}" if several else str(path)
    number = reader(mapping.decimal or decimal_mark(texts, name) or ".")
    return Grid(name, rows, range(1, len(rows) + 1), "row", number, f"Excel, sheet {sheet.title}")


def _require_workbook(path: Path) -> None:
    try:
        with zipfile.ZipFile(path) as parts:
            unpacked = sum(each.file_size for each in parts.infolist())
    except (zipfile.BadZipFile, OSError):
        expected = "an Excel workbook, .xlsx; save an older one (.xls) anew"
        raise InputError(f"{path}: not a workbook (expected {expected})") from None
    if unpacked > MOST_UNPACKED:
        raise InputError(f"{path}: holds {unpacked} bytes unpacked (expected {MOST_UNPACKED} at most)")


def _sheet(path: Path, book: Any, name: str | None) -> Any:
    sheets = book.worksheets
    if name is not None:
        found = next((each for each in sheets if each.title == name), None)
        if found is None:
            names = ", ".join(f'"{each.title}"' for each in sheets)
            raise InputError(f'{path}: sheet: "{name}" (expected one of {names})')
        return found
    numeric = [each for each in sheets if _holds_table(each)]
    if len(numeric) > 1:
        names = ", ".join(f'"{each.title}"' for each in numeric)
        raise InputError(f"{path}: {len(numeric)} sheets hold tables: {names} (expected --sheet NAME, one of them)")
    if not sheets:
        raise InputError(f"{path}: holds no sheet (expected one with readings)")
    return (numeric or sheets)[0]


def _holds_table(sheet: Any) -> bool:
    """Return whether enough rows among the first hold two numbers each, some perhaps as texts."""
    rows: Iterator[Any] = sheet.iter_rows(max_row=ROWS_LOOKED_AT, values_only=True)
    return sum(sum(_may_be_number(_cell(cell)) for cell in row) >= 2 for row in rows) >= LEAST_ROWS


def _may_be_number(cell: Cell) -> bool:
    return any(reader(mark)(cell) is not None for mark in ".,")


def _cell(value: Any) -> Cell:
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).upper()
    if isinstance(value, (int, float)):
        return float(value)
    return value if isinstance(value, (datetime, date, time)) else str(value).strip()
