"""Readings as the evidence uses them: plain arrays, whitened, linear about a fitted model.

About a fit the residual answers to the model's own values and to pushes at the engine's ports linearly,

    y = J d + sum over ports of S_port push_port + e,   e ~ N(0, I),   d ~ N(-standing, I),

with y the residual, J and S the derivatives, all divided by the noise of their row, and d the change of the model's
values in prior standard deviations; `standing` is where the fit has left them. A row is one reading, or the mean of a
few neighbouring ones where sampling is dense (`engine.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.learned import Columns, Learned, Ranges, Space, Variable, Weight
from hexdbb.machine import MachineFile
from hexdbb.samples.distinct import distinct_rows
from hexdbb.threads.copies import in_copies

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Functions = tuple[Variable, int, *tuple[float, ...]]

GROUPINGS = ("circle", "feed", "direction", "lap")
"""What may be held out as a whole, in the order in which results are reported."""


ARC = "arc"
"""Arcs of every sweep: held out where a free function of time claims to predict what lies between."""


WORTH_A_COPY = 256
"""Hypotheses whose limits take some ten times as long as the copy of a process that looks at them."""


DESIGNS_BYTES = 64e6
"""Memory for the functions of a table's columns, beyond which all are made anew when asked for: each number that is
tuned has functions of its own, and those of a search of 11,500 rows took 360 MB. A search is as fast without them."""


class State:
    """Columns of some rows by name (`hexdbb.samples`), with the spaces and designs that were made of them.

    Parameters
    ----------
    columns : Columns
        Samples, or anything that has their columns.
    machine : MachineFile
        That the samples are of.
    unmeasured : frozenset of str
        Columns that were not measured: no function of them is a hypothesis.
    """

    def __init__(self, columns: Columns, machine: MachineFile, unmeasured: frozenset[str] = frozenset()) -> None:
        self._columns, self.machine, self.unmeasured = columns, machine, unmeasured
        self._known: dict[str, Floats] = {}
        self._ranges = Ranges(self)
        self._spaces: dict[Learned, Space] = {}
        self._alike: dict[tuple[Variable, tuple[int, ...]], Space] = {}
        self._designs: dict[Functions, NDArray[np.float32]] = {}
        self._bytes = 0
        self._squares: dict[Functions, Floats] = {}

    def __getitem__(self, name: str) -> Floats:
        """Return a column, shape (n,), (n, 3) or (n, 6)."""
        if name not in self._known:
            self._known[name] = np.asarray(self._columns[name], np.float64)
        return self._known[name]

    def lingering(self, of: Callable[[Columns], Floats], constant_s: float, standing: Floats | None = None) -> Floats:
        """Return what functions of all samples do with a first-order lag, of these rows (`Samples.lingering`)."""
        return self._columns.lingering(of, constant_s, standing)

    def __len__(self) -> int:
        return len(self["time_s"])

    def rows(self, rows: Ints) -> State:
        """Return some rows, whose functions are those of the whole."""
        part = State(_Rows(self, rows), self.machine, self.unmeasured)
        part._spaces, part._alike, part._ranges = self._spaces, self._alike, self._ranges
        return part

    def space(self, hypothesis: Learned) -> Space:
        """Return the functions of a hypothesis; `InputError` where its variable is not measured or hardly varies."""
        if unmeasured := self.unmeasured & hypothesis.variable.needs:
            raise InputError(f"{hypothesis.name}: {', '.join(unmeasured)} was not measured (expected it to be)")
        if hypothesis not in self._spaces:
            # Limits are those of the variable at the elements, whatever it pushes there: many hypotheses share them.
            pushes = hypothesis.pushes(0, self.machine)
            alike = hypothesis.variable, tuple(element for element, _ in pushes)
            if alike not in self._alike:
                self._alike[alike] = Space.within(hypothesis, self._ranges, self.machine.sliders.screw_lead_mm)
            self._spaces[hypothesis] = replace(self._alike[alike], hypothesis=hypothesis)
        return self._spaces[hypothesis]

    def find_spaces(self, hypotheses: Sequence[Learned]) -> list[bool]:
        """Make the functions of several hypotheses; return whether each has them."""
        new = [each for each in hypotheses if each not in self._spaces]
        for each, space in zip(new, in_copies(self._spaces_or_none, new, WORTH_A_COPY), strict=True):
            if space is not None:
                self._spaces[each] = space
        return [each in self._spaces for each in hypotheses]

    def _spaces_or_none(self, hypotheses: Sequence[Learned]) -> list[Space | None]:
        found: list[Space | None] = []
        for each in hypotheses:
            try:
                found.append(self.space(each))
            except InputError:
                found.append(None)
        return found

    def design(self, space: Space, element: int) -> NDArray[np.float32]:
        """Return a space's functions in every row, shape (n, columns), kept: places share their variables."""
        key = _functions(space, element)
        found = self._designs.get(key)
        if found is None:
            found = space.design(self, element).astype(np.float32)
            if self._bytes + found.nbytes > DESIGNS_BYTES:
                self._designs, self._bytes = {}, 0
            self._designs[key] = found
            self._bytes += found.nbytes
        return found

    def forget(self) -> None:
        """Release what can be made anew."""
        self._designs, self._squares, self._bytes = {}, {}, 0

    def square(self, space: Space, element: int) -> Floats:
        """Return the mean over rows of B'B of a space's functions B, shape (columns, columns), kept likewise."""
        key = _functions(space, element)
        if key not in self._squares:
            design = self.design(space, element)
            self._squares[key] = (design.T @ design).astype(np.float64) / len(self)
        return self._squares[key]


def _functions(space: Space, element: int) -> Functions:
    """Return what tells the functions of one place from those of another."""
    limits = (space.low, space.high, space.sign_width, space.since_s, space.span_s, space.warp_width)
    return (space.hypothesis.variable, element, *limits)


class _Rows:
    """Rows of a state's columns."""

    def __init__(self, whole: State, rows: Ints) -> None:
        self._whole, self._rows = whole, rows

    def __getitem__(self, name: str) -> Floats:
        found: Floats = self._whole[name][self._rows]
        return found

    def lingering(self, of: Callable[[Columns], Floats], constant_s: float, standing: Floats | None = None) -> Floats:
        found: Floats = self._whole.lingering(of, constant_s, standing)[self._rows]
        return found

    def __len__(self) -> int:
        return len(self._rows)


@dataclass(frozen=True, eq=False)
class Cells:
    """Rows that no grouping tells apart, cell by cell, padded to one length.

    Attributes
    ----------
    keys : ndarray of int, shape (cells, 1 + groupings)
        Group of each cell, by grouping; the first column is zero.
    order : ndarray of int, shape (n,)
        Rows, cell after cell.
    at : ndarray of int, shape (n,)
        Place of each of these in a table of `shape` (cells, longest cell).
    shape : tuple of int
    counts : ndarray of int, shape (cells,)
    slices : list of slice or None
        Rows of every cell where they stand together; None where those of any do not.
    """

    keys: Ints
    order: Ints
    at: Ints
    shape: tuple[int, int]
    counts: Ints
    slices: list[slice] | None

    @classmethod
    def of(cls, groups: Sequence[Ints], rows: int) -> Cells:
        """Make the cells of some groupings."""
        table = np.column_stack([np.zeros(rows, np.intp), *groups])
        first, cell = distinct_rows(*table.T)
        keys = table[first]
        counts = np.bincount(cell, minlength=len(keys))
        width = int(counts.max())
        begin = np.cumsum(counts) - counts
        at = (np.arange(rows) - np.repeat(begin, counts)) + width * np.repeat(np.arange(len(keys)), counts)
        order = np.argsort(cell, kind="stable")
        stand_together = np.count_nonzero(np.diff(cell)) + 1 == len(keys)
        slices = [slice(first, first + count) for first, count in zip(order[begin], counts, strict=True)]
        return cls(keys, order, at, (len(keys), width), counts, slices if stand_together else None)


@dataclass(frozen=True, eq=False)
class Readings:
    """What does not change with the model.

    Attributes
    ----------
    state : State
        Columns on which a cause may depend.
    groups : mapping of str to ndarray of int, shape (n,)
        Number of the circle, feed, direction and lap of each row, from 0; `sweep` in order of time, `arc` in turn.
    noise_mm : ndarray, shape (n,)
        Standard deviation of each row.
    ports : ndarray, shape (n, 55)
        S by port column (`_core.PORTS`), noise standard deviations per mm. That of the model as it was fitted first: it
        is the machine's lever arms, which values of a tenth of a millimetre change by a ten-thousandth.
    """

    state: State
    groups: Mapping[str, Ints]
    noise_mm: Floats
    ports: Floats
    covered: dict[tuple[Learned, bytes], bool] = field(default_factory=dict, repr=False)
    """Whether a function can be learned in a group of rows from the others (`covered.py`), as far as it was asked."""
    _cells: dict[tuple[str, ...], Cells] = field(default_factory=dict, repr=False)

    def cells(self, groupings: tuple[str, ...]) -> Cells:
        """Return the cells of some groupings; none make one cell of all rows."""
        if groupings not in self._cells:
            self._cells[groupings] = Cells.of([self.groups[name] for name in groupings], len(self))
        return self._cells[groupings]

    def answer(self, pushes: Sequence[tuple[int, Weight]]) -> Floats:
        """Return what a push of one mm at some port columns, each with its weight, does to the readings, shape (n,)."""
        (first, weight), *others = pushes
        found: Floats = weight * self.ports[:, first]
        for port, weight in others:
            found = found + weight * self.ports[:, port]
        return found

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
    """

    residual: Floats
    own: Floats
    standing: Floats

    @cached_property
    def normal(self) -> Floats:
        """[J y]'[J y], shape (p + 1, p + 1)."""
        found = np.empty((self.own.shape[1] + 1, self.own.shape[1] + 1))
        found[:-1, :-1] = self.own.T @ self.own
        found[-1, :-1] = found[:-1, -1] = self.own.T @ self.residual
        found[-1, -1] = self.residual @ self.residual
        return found

    def wider(self, columns: Floats) -> Linear:
        """Return the same with further values that stand at zero, shape (n, k), and its sums from those known."""
        found = Linear(
            residual=self.residual,
            own=np.hstack([self.own, columns]),
            standing=np.concatenate([self.standing, np.zeros(columns.shape[1])]),
        )
        size = self.own.shape[1]
        normal = np.empty((found.own.shape[1] + 1, found.own.shape[1] + 1))
        kept = np.r_[:size, -1]
        normal[np.ix_(kept, kept)] = self.normal
        normal[size:-1, size:-1] = columns.T @ columns
        normal[size:-1, :size] = columns.T @ self.own
        normal[size:-1, -1] = columns.T @ self.residual
        normal[:size, size:-1] = normal[size:-1, :size].T
        normal[-1, size:-1] = normal[size:-1, -1]
        vars(found)["normal"] = normal
        return found

    def moved(self, change: Floats) -> Linear:
        """Return the same about other values, to first order: `change` in prior standard deviations, shape (p,)."""
        found = Linear(self.residual - self.own @ change, self.own, self.standing + change)
        normal = self.normal.copy()
        normal[-1, :-1] -= self.normal[:-1, :-1] @ change
        normal[:-1, -1] = normal[-1, :-1]
        normal[-1, -1] = found.residual @ found.residual
        vars(found)["normal"] = normal
        return found

    def beyond(self, own: NDArray[np.bool_], others: NDArray[np.bool_]) -> tuple[float, float]:
        """Return the mean square of what some values push, and of that which others, with their priors, do not imitate.

        Parameters
        ----------
        own, others : ndarray of bool, shape (p,)
        """
        values, normal = self.standing[own], self.normal[:-1, :-1]
        among, both = normal[np.ix_(others, others)], normal[np.ix_(others, own)] @ values
        imitated = np.linalg.solve(among + np.eye(len(among)), both)
        whole = float(values @ normal[np.ix_(own, own)] @ values)
        left = whole - float(2.0 * both @ imitated - imitated @ among @ imitated)
        return whole / len(self.residual), max(left, 0.0) / len(self.residual)

    @property
    def log_evidence(self) -> float:
        """Log marginal likelihood of the fitted model (Laplace; MacKay 1992), but for a constant of the readings."""
        information = self.normal[:-1, :-1] + np.eye(self.own.shape[1])
        fit = float(self.normal[-1, -1]) + float(self.standing @ self.standing)
        return -0.5 * (fit + float(np.linalg.slogdet(information)[1]))
