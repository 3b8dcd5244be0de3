"""Generated pages: the text is in `data/thesis/*.md`; tables and numbers are computed and filled in."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from hexdbb.machine import shipped
from hexdbb.studies.thesis.unknowns import Unknown
from hexdbb.units import shown_factor

HEADER = "<!-- Written by `hexdbb thesis pages -o docs`; not to be edited. -->"

UNITS = {"mm": "µm", "rad": "µrad"}
"""Engine unit to the unit of pages."""


def markdown_table(heads: Sequence[str], rows: Iterable[Sequence[str]], left: int = 1) -> str:
    """Return a Markdown table; its first `left` columns are left-aligned, the others right-aligned."""
    rule = [":---" if index < left else "---:" for index in range(len(heads))]
    lines = [heads, rule, *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def number(value: float, digits: int) -> str:
    """Return a number with a fixed count of decimals and no minus sign before a zero."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def shown(unknown: Unknown, value: float, digits: int = 2) -> str:
    """Return a value of an unknown in the unit of pages, without the unit."""
    return number(value * shown_factor(unknown.unit), digits)


def fill_page(name: str, **fields: str) -> str:
    """Return a page: its text with every `{field}` replaced.

    Parameters
    ----------
    name : str
        File of the text in the package's `data/thesis`.
    fields : str
        The replacement of each field.
    """
    text = shipped("thesis", name).read_text(encoding="utf-8")
    return text.format(header=HEADER, **fields)
