"""The columns of the table of samples as a list to choose from: each part a variable of its own, in words."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.samples import Samples
from hexdbb.samples.column_page import OWN, UNITS
from hexdbb.samples.table import ENDINGS

LEFT_OUT = ("row", "record", "set_up", "mount", "sliders_mm")
"""Columns that number things; the sliders' places are `encoder_mm` of the state."""
PARTS = {"slider": "slider", "leg": "leg", "axis": "axis"}


@dataclass(frozen=True)
class Variable:
    """One part of a column: `key` is its name in `Samples.columns`."""

    key: str
    column: str
    part: int | None
    label: str
    unit: str

    def values(self, samples: Samples) -> NDArray[np.float64]:
        """Return its values, shape (n,)."""
        column = samples[self.column]
        return np.asarray(column if self.part is None else column[:, self.part], dtype=np.float64)


def variables(samples: Samples) -> dict[str, Variable]:
    """Return every part of every column that varies in some samples, by key."""
    described = {each.name: (each.of, each.unit, each.meaning) for each in _core.state_columns()} | OWN
    found = {}
    for name in samples.column_names:
        if name in LEFT_OUT or name not in described:
            continue
        column, (of, unit, meaning) = samples[name], described[name]
        endings = ENDINGS[column.shape[1]] if column.ndim > 1 else ("",)
        for part, ending in enumerate(endings):
            values = column if column.ndim == 1 else column[:, part]
            known = values[np.isfinite(values)] if values.dtype.kind == "f" else values
            if len(known) and known.min() < known.max():
                key = f"{name}_{ending}" if ending else name
                whose = f"{PARTS.get(of, of)} {ending}: " if ending else ""
                place = part if ending else None
                found[key] = Variable(key, name, place, f"{whose}{meaning}", UNITS.get(unit, unit))
    return found
