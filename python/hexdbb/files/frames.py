"""Columns as data frames and HTML tables, for notebooks.

pandas is an optional dependency: nothing else needs it, and it is not installed with hexdbb.
"""

from __future__ import annotations

import html
import importlib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError


def to_frame(columns: Mapping[str, NDArray[Any]]) -> Any:
    """Return columns of equal length as a ``pandas.DataFrame``.

    Parameters
    ----------
    columns : mapping of str to ndarray, each of shape (n,)

    Raises
    ------
    InputError
        pandas is not installed.
    """
    try:
        pandas = importlib.import_module("pandas")
    except ModuleNotFoundError:
        raise InputError(
            "pandas is not installed (expected it for data frames: pip install pandas; columns() needs only NumPy)"
        ) from None
    return pandas.DataFrame({name: np.asarray(values) for name, values in columns.items()})


def html_table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return an HTML table as notebooks show it; heads and cells are escaped."""
    head = "".join(f"<th>{html.escape(each)}</th>" for each in heads)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
