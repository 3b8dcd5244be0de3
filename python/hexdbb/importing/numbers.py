"""Numbers as people write them: decimal point or comma, groups of three digits, which of the two a file uses."""

from __future__ import annotations

import re
from collections.abc import Iterable

from hexdbb.errors import InputError
from hexdbb.importing.grid import Cell, Number

SPACES = " '’\u00a0\u202f\u2009"
"""What separates groups of three digits besides point and comma."""
OTHER = {".": ",", ",": "."}
MINUS = str.maketrans({"\u2212": "-", "\u2013": "-"})
"""Typographic minus signs."""
_PLAIN = {
    mark: re.compile(rf"[+-]?(?:\d+(?:{re.escape(mark)}\d*)?|{re.escape(mark)}\d+)(?:[eE][+-]?\d+)?") for mark in ".,"
}
_GROUPED = {
    mark: re.compile(
        rf"[+-]?\d{{1,3}}([{re.escape(OTHER[mark])}{SPACES}])\d{{3}}(?:\1\d{{3}})*(?:{re.escape(mark)}\d*)?"
    )
    for mark in ".,"
}
_GROUPS = re.compile(rf"(?<=\d)[{SPACES}.,](?=\d{{3}})")


def reader(decimal: str) -> Number:
    """Return the function that reads numbers with a decimal mark; groups of three digits may be separated."""
    plain, grouped, other = _PLAIN[decimal], _GROUPED[decimal], OTHER[decimal]

    def number(cell: Cell) -> float | None:
        if not isinstance(cell, str):
            return cell if isinstance(cell, float) else None
        text = cell.translate(MINUS)
        if plain.fullmatch(text):
            return float(text.replace(",", "."))
        if grouped.fullmatch(text):
            for mark in other + SPACES:
                text = text.replace(mark, "")
            return float(text.replace(",", "."))
        return None

    return number


def decimal_mark(cells: Iterable[str], name: str) -> str | None:
    """Find the decimal mark of a file's numbers; None where they have neither points nor commas.

    What tells: both marks in one number (the last one is the decimal mark), one mark followed by other than three
    digits or led by a zero (decimal), one mark twice (groups).

    Raises
    ------
    InputError
        Two numbers contradict one another, or all could be either: `1,234`.
    """
    votes: dict[str, str] = {}
    unclear = ""
    for cell in cells:
        told = _told(cell.translate(MINUS))
        if told in OTHER:
            votes.setdefault(told, cell)
        elif told:
            unclear = cell
    if len(votes) == 2:
        point, comma = votes["."], votes[","]
        raise InputError(
            f'{name}: numbers with a decimal point ("{point}") and with a decimal comma ("{comma}")'
            " (expected one of them; --decimal chooses)"
        )
    if votes:
        return next(iter(votes))
    if unclear:
        raise InputError(
            f'{name}: the mark in "{unclear}" may be a decimal mark or separate thousands (expected --decimal . or ,)'
        )
    return None


def _told(text: str) -> str:
    """Return the decimal mark that a cell shows, `?` where it has a mark that may be either, empty where none."""
    marks = [mark for mark in text if mark in OTHER]
    if not marks or not (_PLAIN["."].fullmatch(text) or _PLAIN[","].fullmatch(text) or _grouped(text)):
        return ""
    if len(set(marks)) == 2:
        return marks[-1]
    mark = marks[0]
    if len(marks) > 1:
        return OTHER[mark]
    whole, _, digits = text.lstrip("+-").partition(mark)
    is_group = len(digits) == 3 and 1 <= len(whole) <= 3 and not whole.startswith("0")
    return "?" if is_group else mark


def _grouped(text: str) -> bool:
    return any(each.fullmatch(text) is not None for each in _GROUPED.values())
