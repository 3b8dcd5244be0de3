"""The values of a model as columns and as a small table, for notebooks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.files.frames import html_table
from hexdbb.model.terms import Bools, Floats, Parameter
from hexdbb.units import readable_unit, shown_factor, shown_unit

Columns = Mapping[str, NDArray[Any]]


def value_columns(
    parameters: Sequence[Parameter], values: Floats, sigma: Floats, identifiable: Bools, free: Bools
) -> dict[str, NDArray[Any]]:
    """Return values, one row each.

    Returns
    -------
    dict of str to ndarray, shape (size,)
        ``effect``, ``element``, ``name``, ``value``, ``sigma`` (nan where not known on its own), ``unit``,
        ``identifiable``, ``free``; values in the unit named beside them.
    """
    factors = np.array([shown_factor(each.unit) for each in parameters])
    return {
        "effect": np.array([each.effect for each in parameters], dtype=object),
        "element": np.array([each.element for each in parameters], dtype=object),
        "name": np.array([each.name for each in parameters], dtype=object),
        "value": values * factors,
        "sigma": sigma * factors,
        "unit": np.array([shown_unit(each.unit) for each in parameters], dtype=object),
        "identifiable": identifiable,
        "free": free,
    }


def values_html(columns: Columns) -> str:
    """Return the values that are free or not zero as a table."""
    rows = [
        (
            str(columns["effect"][row]),
            str(columns["element"][row]),
            str(columns["name"][row]),
            f"{columns['value'][row]:.2f}",
            sigma_shown(columns, row),
            readable_unit(str(columns["unit"][row])),
        )
        for row in np.flatnonzero(columns["free"] | (columns["value"] != 0.0))
    ]
    return html_table(("effect", "element", "parameter", "value", "± 1 sigma", "unit"), rows)


def sigma_shown(columns: Columns, row: np.intp, places: str = ".2f") -> str:
    """Return a value's standard deviation for people: ``held`` where it is not free, ``~`` where not identifiable."""
    if not columns["free"][row]:
        return "held"
    return f"{columns['sigma'][row]:{places}}" if columns["identifiable"][row] else "~"
