"""What a study is, and what its cases together say.

A study is a value: which cases it has, what one case gives (a row of a dataset), and what the rows together say. How
cases are distributed and kept is `hexdbb.cluster`'s.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import pyarrow as pa
from matplotlib.figure import Figure

from hexdbb.plan import Plan
from hexdbb.studies.rates import Bounded
from hexdbb.studies.setting import Setting

Case = Mapping[str, Any]
"""What tells one case of a study from the others: numbers and texts."""
Row = Mapping[str, Any]


@dataclass(frozen=True)
class Sheet:
    """A table of a result.

    Attributes
    ----------
    title : str
    head : tuple of str
    rows : tuple of tuple of str
    names : int
        Columns from the left that are text.
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    names: int = 1


@dataclass(frozen=True)
class Result:
    """What the cases of a study say.

    Attributes
    ----------
    answer : tuple of str
        Sentences that answer the study's question.
    sheets : tuple of Sheet
    draw : callable
        Makes the picture.
    notes : tuple of str
        Sentences that a page has below the tables.
    plans : mapping of str to Plan
        Plans that were found, by name.
    """

    answer: tuple[str, ...]
    sheets: tuple[Sheet, ...]
    draw: Callable[[], Figure]
    notes: tuple[str, ...] = ()
    plans: Mapping[str, Plan] = field(default_factory=dict)


@dataclass(frozen=True)
class Study:
    """A kind of study.

    Attributes
    ----------
    name : str
        Of the command `hexdbb study NAME`.
    question : str
    columns : pyarrow.Schema
        Of a case's row.
    cases : callable
        Returns the cases of a setting in order; those of a larger number begin with those of a smaller one.
    row : callable
        Returns the row of one case.
    result : callable
        Returns what rows say; they are in the order of the cases, those that failed left out.
    page : callable or None
        Returns a page of the documentation, as Markdown: of the rows, the number of cases that failed, the link to the
        picture, and the command; that of `hexdbb.studies.page` where there is none of its own.
    """

    name: str
    question: str
    columns: pa.Schema
    cases: Callable[[Setting], Sequence[Case]]
    row: Callable[[Setting, Case], Row]
    result: Callable[[Setting, Sequence[Row]], Result]
    page: Callable[[Sequence[Row], int, str, str], str] | None = None


def percent(each: Bounded, digits: int = 1) -> tuple[str, str]:
    """Return a share and its bounds as text, per cent."""
    if not each.number:
        return "-", "-"
    value, low, high = (f"{100.0 * part:.{digits}f}" for part in (each.value, each.low, each.high))
    return value, f"{low} to {high}"


def number(each: Bounded, digits: int = 3) -> tuple[str, str]:
    """Return a value and its bounds as text; what lies beyond the cases as such."""
    if not each.number:
        return "-", "-"
    if (each.low, each.high) == (float("-inf"), float("inf")):
        return _digits(each.value, digits), "too few cases"
    return _digits(each.value, digits), f"{_digits(each.low, digits)} to {_digits(each.high, digits)}"


def _digits(value: float, digits: int) -> str:
    if value in (float("inf"), float("-inf")):
        return "beyond" if value > 0.0 else "below"
    return f"{float(f'{value:.{digits}g}'):g}"
