"""Generated pages: their words stand in `data/thesis/*.md`, their tables and numbers are computed and filled in."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from hexdbb.machine import shipped
from hexdbb.studies.thesis.unknowns import Unknown
from hexdbb.units import shown_factor

HEADER = "<!-- Written by `hexdbb thesis pages -o docs`; not to be edited. -->"

UNITS = {"mm": "µm", "rad": "µrad"}
"""Engine unit to the unit in which a page shows it."""


def markdown_table(heads: Sequence[str], rows: Iterable[Sequence[str]], left: int = 1) -> str:
    """Lay out a table, its first `left` columns left-aligned, the others right."""
    rule = [":---" if index < left else "---:" for index in range(len(heads))]
    lines = [heads, rule, *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def number(value: float, digits: int) -> str:
    """Write a number with a fixed count of decimals and no minus sign before a zero."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def shown(unknown: Unknown, value: float, digits: int = 2) -> str:
    """Write a value of an unknown in the unit a page shows it in, without the unit."""
    return number(value * shown_factor(unknown.unit), digits)


def fill_page(name: str, **fields: str) -> str:
    """Give a page: its words with every `{field}` replaced.

    Parameters
    ----------
    name : str
        File of the words in the package's `data/thesis`.
    fields : str
        A text for each field the words have.
    """
    words = shipped("thesis", name).read_text(encoding="utf-8")
    return words.format(header=HEADER, **fields)
