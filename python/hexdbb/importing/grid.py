"""Cells of a text file or a sheet, before anything is known of what they mean."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import date, datetime, time

Cell = str | float | datetime | date | time
"""A text (stripped; empty where there is nothing), or what a spreadsheet knows to be a number or a date."""
Number = Callable[[Cell], float | None]
"""Returns the number that a cell holds; None where it holds none."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Rows of cells.

    Attributes
    ----------
    name : str
        File, and sheet where there are several, for errors.
    rows : sequence of list of Cell
        Cells of each row; rows may differ in length.
    lines : sequence of int
        Line of the file, or row of the sheet, that each row stands in.
    unit : str
        What these are called: `line` or `row`.
    number : Number
        How numbers are read.
    how : str
        What was detected, in words.
    """

    name: str
    rows: Sequence[list[Cell]]
    lines: Sequence[int]
    unit: str
    number: Number
    how: str

    def at(self, row: int) -> str:
        """Return a row (from 0) in words: `line 17`."""
        return f"{self.unit} {self.lines[row]}"

    def cell(self, row: int, column: int) -> Cell:
        """Return a cell, empty text beyond the end of its row."""
        cells = self.rows[row]
        return cells[column] if column < len(cells) else ""


def shown(cell: Cell) -> str:
    """Return a cell as an error shows it."""
    if isinstance(cell, float):
        return f"{cell:.10g}"
    if cell == "":
        return "an empty cell"
    text = f'"{cell}"' if isinstance(cell, str) else f"{cell.isoformat()} (a date)"
    return text if len(text) <= 60 else f"{text[:57]}..."
