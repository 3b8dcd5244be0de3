"""What the columns of some samples span: the same for all functions of one column at the same elements.

Thousands of functions are looked at, of a few hundred columns and elements.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from hexdbb.learned.variable import AXES_OF_VECTOR, Variable

Floats = NDArray[np.float64]

NEVER = 1e5
"""Times and distances since a reversal beyond this stand for a reversal that never was (the engine's 1e6)."""
SHORTEST = 1e-3
"""Shortest time (s) or distance (mm) since a reversal that a logarithm is taken of: below the samples' spacing."""
FIRST_PART = 0.005
"""Part of the samples below a logarithm's range: the first few after a reversal would take half of its splines."""
COUNTED = 4096
"""Samples of which different values are counted: several times what any variable asks for."""
GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
"""Distance of two samples of which values are counted, in all samples, whole turns left out: laps repeat their
positions, and every ninth sample of laps of 720 would be the same eighty again and again."""


class Columns(Protocol):
    """Samples, of which this package knows the columns alone (`hexdbb.samples.Samples`)."""

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Return a column, shape (n,), (n, 3) or (n, 6)."""
        ...

    def lingering(self, of: Callable[[Columns], Floats], constant_s: float, standing: Floats | None = None) -> Floats:
        """Return what functions of all samples of the table, shape (m, k), do with a first-order lag, of these rows."""
        ...

    def __len__(self) -> int: ...


@dataclass(frozen=True)
class Range:
    """What a column has at some elements.

    Attributes
    ----------
    lowest, highest, rms : float
        Of its known values; zero where it has none.
    log_low, log_high : float
        Of their logarithms, but for the first few after a reversal.
    different : int
        Different values, about, for each element.
    is_known : bool
    """

    lowest: float = 0.0
    highest: float = 0.0
    rms: float = 0.0
    log_low: float = 0.0
    log_high: float = 0.0
    different: int = 0
    is_known: bool = False


class Ranges:
    """What the columns of some samples span, each looked at once.

    Parameters
    ----------
    samples : Columns
    """

    def __init__(self, samples: Columns) -> None:
        self._samples = samples
        self._found: dict[tuple[str, int, bool, tuple[int, ...]], Range] = {}
        self._acting: dict[str, bool] = {}

    def of(self, variable: Variable, elements: tuple[int, ...]) -> Range:
        """Return what a variable's column has at some elements."""
        key = variable.state, variable.axis, variable.is_log, elements
        if key not in self._found:
            self._found[key] = self._looked_at(variable, elements)
        return self._found[key]

    def acts(self, column: str) -> bool:
        """Check that a column is known and not zero in some sample."""
        if column not in self._acting:
            self._acting[column] = bool(np.any(np.nan_to_num(self._samples[column])))
        return self._acting[column]

    @cached_property
    def time_s(self) -> tuple[float, float]:
        """First and last time."""
        time_s = self._samples["time_s"]
        return float(np.min(time_s)), float(np.max(time_s))

    def _looked_at(self, variable: Variable, elements: tuple[int, ...]) -> Range:
        values = np.concatenate([values_of(self._samples, variable, each) for each in elements])
        usual = np.abs(values) < NEVER  # which nan is not
        known = values if usual.all() else values[usual]
        if not len(known):
            return Range()
        some = known if len(known) <= COUNTED else known[_spread(len(known))]
        log = np.log(np.maximum(known, SHORTEST)) if variable.is_log else np.zeros(1)
        return Range(
            lowest=float(known.min()),
            highest=float(known.max()),
            rms=float(np.sqrt(np.mean(known**2))),
            log_low=float(np.quantile(log, FIRST_PART)),
            log_high=float(log.max()),
            different=min(len(np.unique(some)), len(known) // len(elements)),
            is_known=True,
        )


@lru_cache
def _spread(count: int) -> NDArray[np.intp]:
    """Return the places of so many samples of which different values are counted, spread over all alike."""
    return np.asarray(np.arange(COUNTED) * GOLDEN % 1.0 * count, np.intp)


def values_of(samples: Columns, variable: Variable, element: int) -> Floats:
    """Return a variable's column: that of one element where it has six, one axis of three; shape (n,)."""
    values = np.asarray(samples[variable.state], np.float64)
    if values.ndim == 1:
        return values
    found: Floats = values[:, variable.axis if values.shape[1] == AXES_OF_VECTOR else element]
    return found
