"""What learned functions do to the readings, as numbers.

A function is linear in its coefficients: W = sum over the elements e it acts at of S_e B(u_e), S the reading's answer
to a push there (`Readings.ports`), B the splines of the variable of that element (`hexdbb.learned.Space`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import compress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.linear.readings import Readings
from hexdbb.learned import Learned, Space, hypotheses

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Signature:
    """A learned hypothesis on some rows.

    Attributes
    ----------
    space : Space
        Its functions.
    table : ndarray, shape (n, components x columns)
        W, in noise standard deviations per mm.
    square : ndarray, shape (columns, columns)
        Mean over rows and elements of B'B: c' square c is the mean square of a function, mm^2.
    """

    space: Space
    table: NDArray[Any]
    square: Floats

    @property
    def hypothesis(self) -> Learned:
        """Hypothesis whose functions they are."""
        return self.space.hypothesis

    def prior_factor(self, roughness: float, steepness: float = 0.0) -> Floats:
        """Return T such that coefficients T z, z standard normal, make functions of mean square one over the rows."""
        factor = self.space.prior_factor(roughness, steepness)
        factor = factor / np.sqrt(max(float(np.sum(factor * (self.square @ factor))), 1e-300))
        return factor if self.hypothesis.components == 1 else np.kron(np.eye(self.hypothesis.components), factor)

    def rms_mm(self, coefficients: Floats) -> float:
        """Return the root mean square of the functions of some coefficients."""
        parts = coefficients.reshape(self.hypothesis.components, -1)
        return float(np.sqrt(np.sum(parts * (parts @ self.square))))


def signature_of(
    hypothesis: Learned, readings: Readings, like: Space | None = None, table: NDArray[Any] | None = None
) -> Signature:
    """Return a hypothesis' signature on some rows.

    Parameters
    ----------
    hypothesis : Learned
    readings : Readings
    like : Space, optional
        Of the same hypothesis but for its number: whose splines' limits to take.
    table : ndarray, shape (n, components x columns), optional
        What W is written into, in its own precision; a new one where not given.
    """
    state = readings.state
    space = state.space(hypothesis) if like is None or like.period else replace(like, hypothesis=hypothesis)
    columns = hypothesis.variable.columns
    table = np.empty((len(readings), hypothesis.components * columns)) if table is None else table
    for component in range(hypothesis.components):
        _write(table[:, component * columns : (component + 1) * columns], space, component, readings)
    squares = [state.square(space, element) for element in hypothesis.elements]
    return Signature(space, table, np.asarray(sum(squares)) / len(squares))


def _write(table: NDArray[Any], space: Space, component: int, readings: Readings) -> None:
    """Write what one component does to the readings."""
    state, is_first = readings.state, True
    for element, pushes in space.pushes(component, state, state.machine):
        answer = readings.answer(pushes).astype(table.dtype)[:, None]
        if is_first:
            np.multiply(answer, state.design(space, element), out=table)
        else:
            table += answer * state.design(space, element)
        is_first = False
    assert not is_first  # every place has an element


def varying(every: Iterable[Learned], readings: Readings) -> Iterator[Learned]:
    """Yield those hypotheses whose variable is measured and varies in the readings."""
    some = list(every)
    return compress(some, readings.state.find_spaces(some))


def all_varying(readings: Readings, *, of_forms: bool = False) -> list[Learned]:
    """Return every learned hypothesis, or all that only describe forms, whose variable varies in the readings."""
    return list(varying(hypotheses(of_forms=of_forms), readings))
