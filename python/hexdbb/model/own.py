"""Effects of a user's own in a model: declared by a file the user names; the model's file keeps name and values.

What such an effect does depends on the samples themselves, so the engine's form of a model that has one is made for the
samples it is to predict. Nothing in a model file causes code to run: a file that names such an effect is refused until
the user names the file that declares it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol, TypeGuard

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core


@dataclass(frozen=True, eq=False)
class Tabulated:
    """A user's effect as numbers: value `values[j]` pushes port column `ports[j]` by `per_unit[:, j]`.

    `per_unit` has shape (n, k): one row for each sample of a whole table.
    """

    info: _core.EffectInfo
    values: tuple[int, ...]
    ports: tuple[int, ...]
    per_unit: NDArray[np.float64]

    def pushes(self, rows: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return the pushes at every port in some rows, shape (n, 55, size): mm per unit of the value."""
        ports = sum(count for _, count in _core.PORTS.values())
        every = np.zeros((len(rows), ports, self.info.size))
        for index, (value, port) in enumerate(zip(self.values, self.ports, strict=True)):
            every[:, port, value] += self.per_unit[rows, index]
        return every

    def add_to(self, engine: _core.Model) -> None:
        """Append it, values zero, to a model that is to predict the samples it was tabulated for, or a part of them."""
        engine.add_tabulated(self._effect)

    @cached_property
    def _effect(self) -> _core.TabulatedEffect:
        """The engine's form, which models of the same samples share: to copy the table takes as long as to predict."""
        return _core.TabulatedEffect(
            self.info, values=list(self.values), ports=list(self.ports), per_unit=self.per_unit
        )


class OwnEffect(Protocol):
    """What a model requires of a user's effect (`hexdbb.effects.UserEffect`)."""

    @property
    def name(self) -> str:
        """Name, as in the model file."""
        ...

    def info(self) -> _core.EffectInfo:
        """Describe it as the engine's own are described."""
        ...

    def tabulated(self, samples: Any) -> Tabulated:
        """Evaluate it for a table of samples (`hexdbb.samples.Samples`, of which a model knows nothing)."""
        ...


@dataclass(frozen=True)
class Shape:
    """A fitted shape parameter of a user's effect: where a dent lies, how wide it is.

    Attributes
    ----------
    start : float
        Value before any fit, and mean of its prior.
    prior_sigma : float
        Standard deviation of its prior.
    lower, upper : float
        Physical domain: no fit leaves it.
    unit : str
        Of all of these; nothing converts it.
    """

    start: float
    prior_sigma: float
    lower: float = -math.inf
    upper: float = math.inf
    unit: str = "mm"


class ShapedEffect(OwnEffect, Protocol):
    """A user's effect with shape parameters: what it pushes depends on their values, by element."""

    @property
    def shapes(self) -> Mapping[str, Shape]:
        """Shape parameters by name."""
        ...

    def tabulated_at(self, samples: Any, values: NDArray[np.float64]) -> Tabulated:
        """Evaluate it and its derivatives about some values of all its parameters, shape (size,)."""
        ...


OwnEffects = Mapping[str, OwnEffect]
"""Users' effects by name."""
Tabulate = Callable[[OwnEffect, NDArray[np.float64]], Tabulated]
"""Evaluates a user's effect with these values for the samples that are to be predicted."""


def shapes_of(own: OwnEffect | None) -> Mapping[str, Shape]:
    """Return the shape parameters of an effect by name; none where it has none, or is the engine's."""
    return getattr(own, "shapes", {})


def is_shaped(own: OwnEffect | None) -> TypeGuard[ShapedEffect]:
    """Check whether an effect has shape parameters."""
    return bool(shapes_of(own))
