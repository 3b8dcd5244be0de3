"""Learned functions among the values of a fit: their coefficients along the axes of their prior.

A function is linear in its coefficients. The engine therefore needs a table of pushes, a column for each axis, only for
the rows that are fitted; where a model is made linear, the sum of its functions suffices, a column for each port, and
what each axis does to the readings follows from their answer to a push there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.evidence.linear.readings import State
from hexdbb.learned import Space, Weight
from hexdbb.model import Model, Tabulated, Term

Floats = NDArray[np.float64]
Pushes = tuple[tuple[int, Weight], ...]
Part = tuple[NDArray[np.intp], Pushes, Floats]
"""Axes, the engine's port columns that they push, each with its weight, and their functions in every row."""


@dataclass(frozen=True, eq=False)
class LearnedAxes:
    """A learned hypothesis as an effect of the engine: its coefficients in the prior's own axes.

    `size_mm` is the prior standard deviation of each, `factor` T (`signatures.py`), shape (coefficients, axes).
    """

    space: Space
    factor: Floats
    size_mm: float

    @classmethod
    def of(cls, term: Term) -> LearnedAxes:
        """Return a learned effect of a model in this form."""
        learned = term.learned
        assert learned is not None
        factor: Floats = np.kron(np.eye(learned.space.hypothesis.components), learned.factor).astype(np.float64)
        return cls(learned.space, factor, learned.prior_sigma_mm)

    @property
    def name(self) -> str:
        """Name in the model."""
        return self.space.hypothesis.name

    def is_like(self, other: object) -> bool:
        """Check whether another effect's coefficients mean the same."""
        if not isinstance(other, LearnedAxes) or (other.name, other.size_mm) != (self.name, self.size_mm):
            return False
        return np.array_equal(other.factor, self.factor)

    def info(self) -> _core.EffectInfo:
        """Describe it as the engine's own are described."""
        size = self.size_mm
        values = [
            _core.ParameterInfo(name=f"z{k}", unit="mm", prior_sigma=size, limit=1e3 * size)
            for k in range(self.factor.shape[1])
        ]
        return _core.EffectInfo(
            name=self.name,
            physics="A function learned from readings.",
            source="learned",
            element_kind="machine",
            elements=["1"],
            parameters=values,
            ports=[self.space.hypothesis.port],
        )

    def tabulated(self, state: State) -> Tabulated:
        """Evaluate it for some rows."""
        values: list[int] = []
        ports: list[int] = []
        tables: list[Floats] = []
        for axes, pushes, pushed in self._parts(state):
            for port, weight in pushes:
                values += axes.tolist()
                ports += [port] * len(axes)
                tables.append(np.reshape(weight, (-1, 1)) * pushed)
        return Tabulated(self.info(), tuple(values), tuple(ports), np.hstack(tables))

    def pushes_mm(self, state: State, values: Floats) -> dict[int, Floats]:
        """Return what it pushes at its port columns in some rows, shape (n,) each, at the values of its axes."""
        found: dict[int, Floats] = {}
        coefficients = self.factor @ values
        for component, element, pushes in self._acting(state):
            pushed = state.design(self.space, element) @ coefficients[self._own(component)]
            for port, weight in pushes:
                found[port] = found.get(port, 0.0) + weight * pushed
        return found

    def answer(self, state: State, ports: Floats) -> Floats:
        """Return what its axes do to the readings, shape (n, axes): in the unit of `ports`, shape (n, 55), times mm."""
        found = np.zeros((len(ports), self.factor.shape[1]))
        for axes, pushes, pushed in self._parts(state):
            answer = np.asarray(sum(weight * ports[:, port] for port, weight in pushes))[:, None] * pushed
            if len(axes) == found.shape[1]:
                found += answer
            else:
                found[:, axes] += answer
        return found

    def _parts(self, state: State) -> Iterator[Part]:
        for component, element, pushes in self._acting(state):
            own = self.factor[self._own(component)]
            axes = np.flatnonzero(np.any(own != 0.0, axis=0))
            yield axes, pushes, state.design(self.space, element) @ own[:, axes]

    def _acting(self, state: State) -> Iterator[tuple[int, int, Pushes]]:
        """Yield each of its functions: component, element of the variable, and what it pushes."""
        for component in range(self.space.hypothesis.components):
            for element, pushes in self.space.pushes(component, state, state.machine):
                yield component, element, pushes

    def _own(self, component: int) -> slice:
        functions = self.space.hypothesis.variable.columns
        return slice(component * functions, (component + 1) * functions)


@dataclass(frozen=True, eq=False)
class Standing:
    """What the learned functions of a model push together, as an effect of one value, which stands at one."""

    table: Tabulated
    name: str = "learned"

    @classmethod
    def of(cls, pushes_mm: dict[int, Floats]) -> Standing:
        """Make it of the pushes at each port column, shape (n,) each."""
        info = _core.EffectInfo(
            name=cls.name,
            physics="All learned functions together.",
            source="learned",
            element_kind="machine",
            elements=["1"],
            parameters=[_core.ParameterInfo(name="all", unit="1", prior_sigma=1.0, limit=1.0)],
            ports=[],
        )
        ports = tuple(pushes_mm)
        return cls(Tabulated(info, (0,) * len(ports), ports, np.column_stack([pushes_mm[port] for port in ports])))

    def info(self) -> _core.EffectInfo:
        """Describe it as the engine's own are described."""
        return self.table.info

    def tabulated(self, _: object) -> Tabulated:
        """Return its table, whatever the samples."""
        return self.table


def learned_of(model: Model) -> dict[str, LearnedAxes]:
    """Return the learned functions of a model by name."""
    found = {}
    for term in model.terms:
        own = model.own(term.effect)
        if isinstance(own, LearnedAxes):
            found[term.effect] = own
        elif term.learned is not None:
            found[term.effect] = LearnedAxes.of(term)
    return found
