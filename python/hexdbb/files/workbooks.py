"""Excel workbooks: whether openpyxl, an extra, is there, and rows written as sheets."""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from hexdbb.errors import InputError

MOST_ROWS = 1_048_576
"""Rows of a sheet (Excel 2007 and later)."""


def require_openpyxl(path: Path) -> Any:
    """Return the module openpyxl.

    Raises
    ------
    InputError
        It is not installed; names the file that needs it.
    """
    try:
        return importlib.import_module("openpyxl")
    except ModuleNotFoundError:
        expected = "openpyxl for Excel files: pip install 'hexdbb[excel]'; or save the sheet as CSV"
        raise InputError(f"{path}: openpyxl is not installed (expected {expected})") from None


def write_workbook(path: Path, sheets: Mapping[str, Iterable[Sequence[Any]]]) -> None:
    """Write rows of cells as the sheets of a workbook.

    Parameters
    ----------
    path : Path
    sheets : mapping of str to iterable of rows
        By the sheet's name.

    Raises
    ------
    InputError
        openpyxl is not installed.
    """
    book = require_openpyxl(path).Workbook(write_only=True)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(path)
