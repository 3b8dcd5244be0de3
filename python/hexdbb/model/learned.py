"""A learned function as a member of a model: pure data, named as `hexdbb add` takes it.

Its values are the function's coefficients in the axes of its prior: c = T z, z independent with one prior standard
deviation (mm), T of `hexdbb.learned.Space.prior_factor`. So they are fitted like all other values.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.learned import Curve, Directed, Space, Table
from hexdbb.model.own import Tabulated

Floats = NDArray[np.float64]

LIMIT_OF_SIGMA = 1000.0
"""Limit of a coefficient in prior standard deviations: stops a diverging fit and nothing else."""


@dataclass(frozen=True)
class LearnedEffect:
    """A learned function.

    Attributes
    ----------
    space : Space
        Where it pushes, on what it depends, knots.
    roughness : float
        Penalty on second differences of neighbouring coefficients, which sets how smooth it is.
    prior_sigma_mm : float
        Prior standard deviation of the values.
    sigma_mm : tuple of float
        Standard deviation of the function at `Space.points`, one function after another; empty before it is fitted.
        Where a constant belongs to the function, that of the function less its mean over the samples: a constant push
        is a leg's or a slider's offset in other words.
    samples : tuple of float
        Number of samples nearest to each point, of those it was fitted to.
    """

    space: Space
    roughness: float
    prior_sigma_mm: float
    sigma_mm: tuple[float, ...] = field(default=(), compare=False)
    samples: tuple[float, ...] = field(default=(), compare=False)

    @property
    def name(self) -> str:
        """Name in a model."""
        return self.space.hypothesis.name

    @property
    def size(self) -> int:
        """Number of values."""
        return self.space.size

    @cached_property
    def factor(self) -> Floats:
        """T, shape (columns, columns); the same for every component."""
        return self.space.prior_factor(self.roughness)

    def has_constant(self, function: int) -> bool:
        """Check whether a push that is the same in all samples belongs to one of its functions, from 0."""
        hypothesis = self.space.hypothesis
        return bool(hypothesis.variable.column) and hypothesis.variable.count > 1 and not hypothesis.times_of(function)

    def info(self) -> _core.EffectInfo:
        """Describe it as the engine's own are described."""
        hypothesis = self.space.hypothesis
        sigma = self.prior_sigma_mm
        return _core.EffectInfo(
            name=self.name,
            physics=f"A function learned from readings, of {hypothesis.variable.words}.",
            source="learned",
            element_kind=hypothesis.kind,
            elements=[hypothesis.element_name or "1"],
            parameters=[
                _core.ParameterInfo(name=f"axis_{k + 1}", unit="mm", prior_sigma=sigma, limit=LIMIT_OF_SIGMA * sigma)
                for k in range(self.size)
            ],
            ports=[hypothesis.port],
        )

    def tabulated(self, samples: Any) -> Tabulated:
        """Evaluate it for a table of samples."""
        values: list[int] = []
        ports: list[int] = []
        tables: list[Floats] = []
        hypothesis, columns = self.space.hypothesis, self.space.hypothesis.variable.columns
        pushed: dict[int, Floats] = {}
        for component in range(hypothesis.components):
            for element, pushes in self.space.pushes(component, samples, samples.machine):
                if element not in pushed:
                    pushed[element] = self.space.design(samples, element) @ self.factor
                for port, weight in pushes:
                    values += range(component * columns, (component + 1) * columns)
                    ports += [port] * columns
                    tables.append(np.reshape(weight, (-1, 1)) * pushed[element])
        return Tabulated(self.info(), tuple(values), tuple(ports), np.hstack(tables))

    def coefficients(self, values: Floats) -> Floats:
        """Return the splines' coefficients (mm) of the effect's values, shape (size,)."""
        return np.concatenate([self.factor @ part for part in np.split(values, self.space.hypothesis.components)])

    def tables(self, values: Floats, machine: Directed) -> tuple[Table, ...]:
        """Return the function as a compensation of a machine needs it, one table a function."""
        return self.space.tables(self.coefficients(values), machine)

    def curves(self, values: Floats) -> tuple[Curve, ...]:
        """Return its functions over their variable: the effect's values, shape (size,), set them."""
        hypothesis, points = self.space.hypothesis, self.space.points()
        parts = self.coefficients(values).reshape(hypothesis.functions, -1)
        sigma = np.array(self.sigma_mm or [np.nan] * len(parts) * len(points)).reshape(len(parts), -1)
        samples = np.array(self.samples or [np.nan] * len(points))
        basis, variable = self.space.functions(points), hypothesis.variable
        words, unit, column = variable.words, variable.unit, variable.column
        return tuple(
            Curve(words, unit, column, hypothesis.times_of(function), points, basis @ part, band, samples)
            for function, (part, band) in enumerate(zip(parts, sigma, strict=True))
        )

    def fitted(self, covariance: Floats, samples: Any) -> LearnedEffect:
        """Return the same effect with the band of a fit: covariance of its values, mm², and the samples fitted to."""
        splines = self.space.functions(self.space.points())
        own = splines.shape[1]
        basis, counts = splines @ self.factor[:own, :own], self.space.counts(samples)
        changes, sigma = basis - np.average(basis, axis=0, weights=counts), []
        for function in range(self.space.hypothesis.functions):
            at = slice(function * own, (function + 1) * own)
            shown = changes if self.has_constant(function) else basis
            sigma += np.sqrt(np.sum((shown @ covariance[at, at]) * shown, axis=1)).tolist()
        return replace(self, sigma_mm=tuple(sigma), samples=tuple(map(float, counts)))
