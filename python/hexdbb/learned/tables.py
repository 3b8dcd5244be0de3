"""A learned function as it is drawn, and as a compensation needs it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.learned.following import RELAY
from hexdbb.learned.hypothesis import Push
from hexdbb.learned.variable import OF_MEMORY

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Curve:
    """A function over its variable.

    Attributes
    ----------
    variable : str
        In words.
    unit : str
        Of `at`.
    column : str
        Empty where the function is one number.
    times : str
        Column that multiplies; empty where none does.
    at, value_mm, sigma_mm : ndarray, shape (m,)
        Places, the function there, and its standard deviation (nan where it was never fitted).
    samples : ndarray, shape (m,)
        Number of samples nearest to each place.
    """

    variable: str
    unit: str
    column: str
    times: str
    at: Floats
    value_mm: Floats
    sigma_mm: Floats
    samples: Floats

    @property
    def has_states(self) -> bool:
        """Whether its places are two states, between which there is nothing."""
        return f"{OF_MEMORY}{RELAY}@" in self.column


@dataclass(frozen=True)
class Table:
    """A function as a compensation needs it: linear between the knots, held beyond them.

    The push at a port column is weight times `times` times the value at the variable of the element.

    Attributes
    ----------
    port : str
    column : str
        Variable, a column of the samples; empty where the value is one number.
    times : str
        Column that multiplies; empty where none does.
    period : float
        Of the variable, which is wrapped into 0 to `period`; 0 where it is not periodic.
    pushes : tuple of Push
        Elements of the variable, and what each pushes.
    knots, values_mm : tuple of float
        Knots rise.
    rate : str
        Where `times` is a direction in place of a smoothed change of sign: the column of the rate whose sign it is.
    turns_over : float
        Transition rate of that change, in the rate's unit.
    """

    port: str
    column: str
    times: str
    period: float
    pushes: tuple[Push, ...]
    knots: tuple[float, ...]
    values_mm: tuple[float, ...]
    rate: str = ""
    turns_over: float = 0.0
