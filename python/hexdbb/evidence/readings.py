"""Readings as the evidence uses them: plain arrays, whitened, linear about a fitted model.

About a fit the residual answers to the model's own values and to pushes at the engine's ports linearly,

    y = J d + sum over ports of S_port push_port + e,   e ~ N(0, I),   d ~ N(-standing, I),

with y the residual, J and S the derivatives, all divided by the noise of their row, and d the change of the model's
values in prior standard deviations; `standing` is where the fit has left them. A row is one reading, or the mean of a
few neighbouring ones where sampling is dense (`engine.py`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.learned import Columns, Learned, Space, Variable

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

GROUPINGS = ("circle", "feed", "direction", "lap")
"""What may be held out as a whole, in the order in which results are reported."""


class State:
    """Columns of some rows by name (`hexdbb.samples`), with the spaces and designs that were made of them.

    Parameters
    ----------
    columns : Columns
        Samples, or anything that has their columns.
    screw_lead_mm : float
        Travel of a slider per turn of its screw.
    """

    def __init__(self, columns: Columns, screw_lead_mm: float) -> None:
        self._columns, self.screw_lead_mm = columns, screw_lead_mm
        self._known: dict[str, Floats] = {}
        self._spaces: dict[Learned, Space] = {}
        self._designs: dict[tuple[Variable, int, float, float], NDArray[np.float32]] = {}

    def __getitem__(self, name: str) -> Floats:
        """Return a column, shape (n,), (n, 3) or (n, 6)."""
        if name not in self._known:
            self._known[name] = np.asarray(self._columns[name], np.float64)
        return self._known[name]

    def __len__(self) -> int:
        return len(self["time_s"])

    def rows(self, rows: Ints) -> State:
        """Return some rows, whose functions are those of the whole."""
        part = State(_Rows(self, rows), self.screw_lead_mm)
        part._spaces = self._spaces
        return part

    def space(self, hypothesis: Learned) -> Space:
        """Return the functions of a hypothesis; `InputError` where its variable is not measured or hardly varies."""
        if hypothesis not in self._spaces:
            self._spaces[hypothesis] = Space.of(hypothesis, self, self.screw_lead_mm)
        return self._spaces[hypothesis]

    def design(self, space: Space, element: int) -> NDArray[np.float32]:
        """Return a space's functions in every row, shape (n, columns), kept: places share their variables."""
        key = (space.hypothesis.variable, element, space.low, space.high)
        if key not in self._designs:
            self._designs[key] = space.design(self, element).astype(np.float32)
        return self._designs[key]


class _Rows:
    """Rows of a state's columns."""

    def __init__(self, whole: State, rows: Ints) -> None:
        self._whole, self._rows = whole, rows

    def __getitem__(self, name: str) -> Floats:
        found: Floats = self._whole[name][self._rows]
        return found

    def __len__(self) -> int:
        return len(self._rows)


@dataclass(frozen=True, eq=False)
class Readings:
    """What does not change with the model.

    Attributes
    ----------
    state : State
        Columns on which a cause may depend.
    groups : mapping of str to ndarray of int, shape (n,)
        Number of the circle, feed, direction and lap of each row, from 0; `sweep` in order of time.
    noise_mm : ndarray, shape (n,)
        Standard deviation of each row.
    """

    state: State
    groups: Mapping[str, Ints]
    noise_mm: Floats

    def __len__(self) -> int:
        return len(self.noise_mm)


@dataclass(frozen=True, eq=False)
class Linear:
    """A fitted model's neighbourhood.

    Attributes
    ----------
    residual : ndarray, shape (n,)
        y, in standard deviations of the noise.
    own : ndarray, shape (n, p)
        J, per prior standard deviation.
    standing : ndarray, shape (p,)
        Values in prior standard deviations.
    ports : ndarray, shape (n, 55)
        S by port column (`_core.PORTS`), noise standard deviations per mm.
    """

    residual: Floats
    own: Floats
    standing: Floats
    ports: Floats

    def answer(self, pushes: Sequence[tuple[int, float]]) -> Floats:
        """Return what a push of one mm at some port columns, each with its weight, does to the readings, shape (n,)."""
        (first, weight), *others = pushes
        found: Floats = weight * self.ports[:, first]
        for port, weight in others:
            found = found + weight * self.ports[:, port]
        return found

    @property
    def log_evidence(self) -> float:
        """Log marginal likelihood of the fitted model (Laplace; MacKay 1992), but for a constant of the readings."""
        information = self.own.T @ self.own + np.eye(self.own.shape[1])
        fit = float(self.residual @ self.residual) + float(self.standing @ self.standing)
        return -0.5 * (fit + float(np.linalg.slogdet(information)[1]))


class Thinned:
    """Some rows, evenly spread, of all linearisations of the same readings; designs made for one are kept for others.

    Parameters
    ----------
    readings : Readings
    count : int
    """

    def __init__(self, readings: Readings, count: int = DEFAULT.thinned_rows) -> None:
        whole = len(readings)
        self.rows: Ints = np.unique(np.linspace(0, whole - 1, min(whole, count)).astype(np.intp))
        self.readings = Readings(
            readings.state.rows(self.rows),
            {name: numbers[self.rows] for name, numbers in readings.groups.items()},
            readings.noise_mm[self.rows],
        )

    def linear(self, linear: Linear) -> Linear:
        """Return the rows of a linearisation."""
        return Linear(
            residual=linear.residual[self.rows],
            own=linear.own[self.rows],
            standing=linear.standing,
            ports=linear.ports[self.rows],
        )
