"""The values of a model as columns and as a small table, for notebooks."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.files.frames import html_table
from hexdbb.model import Model
from hexdbb.units import shown_factor, shown_unit


def value_columns(model: Model) -> dict[str, NDArray[Any]]:
    """Give every value of a model, one row each.

    Returns
    -------
    dict of str to ndarray, shape (size,)
        ``effect``, ``element``, ``name``, ``value``, ``sigma`` (nan where not known on its own), ``unit``,
        ``identifiable``, ``free``; values in the unit named beside them.
    """
    parameters = model.parameters()
    factors = np.array([shown_factor(each.unit) for each in parameters])
    known = np.concatenate([np.zeros(0, bool), *(term.identifiable for term in model.terms)])
    return {
        "effect": np.array([each.effect for each in parameters], dtype=object),
        "element": np.array([each.element for each in parameters], dtype=object),
        "name": np.array([each.name for each in parameters], dtype=object),
        "value": model.values * factors,
        "sigma": model.sigma * factors,
        "unit": np.array([shown_unit(each.unit) for each in parameters], dtype=object),
        "identifiable": known,
        "free": model.free,
    }


def values_html(model: Model) -> str:
    """Give the values that are free or not zero as a table."""
    columns = value_columns(model)
    rows = [
        (
            str(columns["effect"][row]),
            str(columns["element"][row]),
            str(columns["name"][row]),
            f"{columns['value'][row]:.2f}",
            _sigma(columns, row),
            str(columns["unit"][row]),
        )
        for row in np.flatnonzero(columns["free"] | (columns["value"] != 0.0))
    ]
    return html_table(("effect", "element", "parameter", "value", "± 1 sigma", "unit"), rows)


def _sigma(columns: dict[str, NDArray[Any]], row: np.intp) -> str:
    if not columns["free"][row]:
        return "held"
    return f"{columns['sigma'][row]:.2f}" if columns["identifiable"][row] else "~"
