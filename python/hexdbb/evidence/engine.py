"""From records and models to plain arrays, and back: the one file that knows the engine and the tables of samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis import Noise, evaluate_fit
from hexdbb.errors import RunError
from hexdbb.evidence.criteria import DEFAULT, Criteria
from hexdbb.evidence.readings import ARC, Linear, Readings, State
from hexdbb.learned import Learned, Space
from hexdbb.model import Model, OwnEffect, Tabulated, Term, new_term
from hexdbb.model.terms import started_term
from hexdbb.samples import Samples, effect_pushes

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]


FEW_ROWS = 100
"""Rows that tell where an effect pushes: several in every reversal and on every circle of a plan."""
ARCS = 20
"""Arcs of a sweep: a left-out one lasts some seconds, less than what warms or settles takes."""
ARC_GROUPS = 5
"""Groups that arcs belong to in turn: each is predicted from four fifths of the readings."""


@dataclass(frozen=True)
class Fitted:
    """A model fitted to the rows, linear about the fit."""

    model: Model
    linear: Linear
    covariance: Floats
    """Covariance of the free values, in prior standard deviations."""
    free: Ints
    """Places of the free values in the model's."""


@dataclass(frozen=True, eq=False)
class TabulatedLearned:
    """A learned hypothesis as an effect of the engine: its coefficients in the prior's own axes.

    `size_mm` is the prior standard deviation of each, `factor` T (`signatures.py`).
    """

    space: Space
    factor: Floats
    size_mm: float
    state: State
    rows: Ints
    """Rows of the state in the whole table."""

    @property
    def name(self) -> str:
        """Name in the model."""
        return self.space.hypothesis.name

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

    def tabulated(self, samples: Samples) -> Tabulated:
        """Evaluate it for a table of samples; rows other than its own stay zero."""
        values: list[int] = []
        ports: list[int] = []
        tables: list[Floats] = []
        hypothesis, functions = self.space.hypothesis, self.space.hypothesis.variable.columns
        for component in range(hypothesis.components):
            own = self.factor[component * functions : (component + 1) * functions]
            kept = np.flatnonzero(np.any(own != 0.0, axis=0))
            for element, pushes in hypothesis.pushes(component, samples.machine.base.guideway_angles_rad):
                pushed = self.state.design(self.space, element) @ own[:, kept]
                for port, weight in pushes:
                    values += kept.tolist()
                    ports += [port] * len(kept)
                    tables.append(weight * pushed)
        table = np.zeros((int(samples.row_numbers.max()) + 1, len(values)))
        table[self.rows] = np.hstack(tables)
        return Tabulated(self.info(), tuple(values), tuple(ports), table)


class Engine:
    """Samples prepared for evidence: rows, groups, state, and fits of models to the rows.

    Parameters
    ----------
    samples : Samples
    model : Model
        That knows the samples' mounts.
    noise : Noise
    criteria : Criteria
    """

    def __init__(self, samples: Samples, model: Model, noise: Noise, criteria: Criteria = DEFAULT) -> None:
        self.samples, self.noise, self.criteria = samples, noise, criteria
        self.base, result = evaluate_fit(samples, model, model.free, noise, hypothesis=True)
        self.residual_mm = result.residual_mm
        begin, count = _blocks(samples["sweep"], criteria.max_rows)
        chosen = begin + count // 2
        self.part = samples.part(chosen)
        averaged = np.add.reduceat(self.residual_mm, begin) / count
        self.reading_mm = self.part.reading_mm - self.residual_mm[chosen] + averaged
        self.row_noise_mm = noise.sigma_mm / np.sqrt(count)
        self._fitted_rows = np.unique(np.linspace(0, len(chosen) - 1, min(len(chosen), criteria.fit_rows)).astype(int))
        self._fitted_part = samples.part(chosen[self._fitted_rows])

    @cached_property
    def readings(self) -> Readings:
        """State, groups and noise of the rows."""
        part = self.part
        groups = {
            "circle": _codes(part["circle"]),
            "feed": _codes(part["feed_mm_s"]),
            "direction": _codes(part["direction"]),
            "lap": _codes(part["lap"]),
            "sweep": _codes(part["sweep"]),
            ARC: _arcs(_codes(part["sweep"])),
        }
        ports = _core.port_sensitivity(self._engine(self.base), part.block(self.base)) / self.row_noise_mm[:, None]
        return Readings(State(part, part.machine, part.unmeasured), groups, self.row_noise_mm, ports)

    def fit(self, model: Model) -> Fitted:
        """Fit a model's free values to some of the rows and linearise about the fit.

        What the other rows add is first order (`Trials` takes that step); they cost most of a fit's time.

        Raises
        ------
        RunError
            Where the fit did not end in a usable solution.
        """
        shaped = np.array([each.shape is not None for each in model.parameters()])
        rounds = self.criteria.shape_rounds if (shaped & model.free).any() else 1
        for _ in range(rounds):
            model = self._fitted_once(model, shaped)
        return self.linearised(model)

    def _fitted_once(self, model: Model, shaped: NDArray[np.bool_]) -> Model:
        """Fit all free values; shapes of users' effects go one step of Gauss and Newton."""
        fewer = self._fitted_rows
        part = self._fitted_part
        result = _core.fit(
            self._engine(model),
            part.block(model),
            self.reading_mm[fewer],
            noise_mm=float(np.mean(self.row_noise_mm)) * float(np.sqrt(len(fewer) / len(self.reading_mm))),
            free=[bool(each) for each in model.free],
            sweep=part["sweep"],
            hypothesis=True,
        )
        if not result.usable:
            raise RunError(f"{self.samples.name}: the fit did not succeed: {result.termination}")
        values = result.values + np.where(shaped, model.values, 0.0)
        for place in np.flatnonzero(shaped):
            domain = model.parameters()[place].shape
            assert domain is not None
            values[place] = np.clip(values[place], domain.lower, domain.upper)
        return model.with_values(values)

    def linearised(self, model: Model) -> Fitted:
        """Linearise the rows about a model as it is."""
        engine, block = self._engine(model), self.part.block(model)
        prediction = _core.predict(engine, block, want_jacobian=True)
        free = np.flatnonzero(model.free)
        prior = model.prior_sigma[free]
        start = np.array([each.start for each in model.parameters()])
        weight = 1.0 / self.row_noise_mm[:, None]
        own = prediction.jacobian[:, free] * prior * weight
        linear = Linear(
            residual=(self.reading_mm - prediction.reading_mm) / self.row_noise_mm,
            own=own,
            standing=(model.values - start)[free] / prior,
        )
        covariance: Floats = np.linalg.inv(own.T @ own + np.eye(len(free))).astype(np.float64)
        return Fitted(model, linear, covariance, free)

    def has_shape(self, effect: str) -> bool:
        """Check whether an effect has a shape parameter of the engine's (a time constant)."""
        return self.base.own(effect) is None and any(each.is_shape for each in self.base.info(effect).parameters)

    def ports(self, effect: str) -> frozenset[str]:
        """Return the engine's ports at which an effect pushes."""
        few = self.part.part(np.unique(np.linspace(0, len(self.part) - 1, FEW_ROWS).astype(np.intp)))
        alone = replace(self.base, terms=(_held(self.base, effect),))
        return frozenset(port for port, pushes in effect_pushes(few, alone).items() if np.any(pushes != 0.0))

    def signatures(
        self, model: Model, effects: Sequence[str], shape: float = 0.0
    ) -> tuple[Floats, list[tuple[str, str, str, float]]]:
        """Return first-order signatures of absent effects, per prior standard deviation.

        Parameters
        ----------
        model : Model
        effects : sequence of str
        shape : float
            Value of shape parameters, in prior standard deviations.

        Returns
        -------
        signatures : ndarray, shape (n, k)
        whose : list of (effect, element, parameter, prior standard deviation)
        """
        present = {term.effect for term in model.terms}
        terms = [_held(model, name) for name in effects if name not in present]
        full = replace(model, terms=(*model.terms, *terms))
        if shape:
            absent = np.array([each.is_shape and each.effect not in present for each in full.parameters()])
            full = full.with_values(np.where(absent, shape * full.prior_sigma, full.values))
        jacobian = _core.predict(self._engine(full), self.part.block(full), want_jacobian=True).jacobian
        wanted = [
            (index, each)
            for index, each in enumerate(full.parameters())
            if each.effect in effects and not full.free[index] and not each.is_shape
        ]
        columns = [index for index, _ in wanted]
        sigmas = np.array([each.prior_sigma for _, each in wanted])
        table: Floats = jacobian[:, columns] * sigmas / self.row_noise_mm[:, None]
        return table, [(each.effect, each.element, each.name, each.prior_sigma) for _, each in wanted]

    def present(self) -> list[tuple[str, tuple[str, ...], bool]]:
        """Return the catalogue's and the user's effects that the base has free: effect, element, if it has no other."""
        base = self.base
        mine = self._mine()
        named = zip(base.parameters(), base.free, strict=True)
        free = [each for each, is_free in named if is_free and not each.is_coefficient]
        found = dict.fromkeys((each.effect, each.element) for each in free if each.effect in mine)
        return [(effect, (element,), len(base.info(effect).elements) == 1) for effect, element in found]

    def geometry(self, fitted: Fitted) -> NDArray[np.bool_]:
        """Return which free values are geometry's or the set-up's: all but those of effects that could be missing."""
        return self.geometry_of(fitted.model)

    def geometry_of(self, model: Model) -> NDArray[np.bool_]:
        """Return the same of a model as it is; what the base does not have is not geometry's."""
        before = {each.effect for each in self.base.parameters()} - self._mine()
        named = zip(model.parameters(), model.free, strict=True)
        return np.array([each.effect in before for each, is_free in named if is_free], dtype=bool)

    def _mine(self) -> set[str]:
        return {*_core.effect_names("catalogue"), *self.base.own_effects}

    def with_effect(self, model: Model, effect: str, elements: Sequence[str]) -> Model:
        """Return the model with some elements of an effect of the catalogue free as well, at zero."""
        if effect not in {term.effect for term in model.terms}:
            model = replace(model, terms=(*model.terms, _held(model, effect)))
        freed = [each.effect == effect and each.element in elements for each in model.parameters()]
        return model.with_free(model.free | np.array(freed))

    def with_learned(self, model: Model, hypothesis: Learned, factor: Floats, size_mm: float) -> Model:
        """Return the model with a learned hypothesis, its coefficients free, at zero."""
        state = self.readings.state
        own = TabulatedLearned(state.space(hypothesis), factor, size_mm, state, self.part.row_numbers)
        wider = model.knowing_effects([own])
        return replace(wider, terms=(*wider.terms, new_term(own.name, factor.shape[1])))

    def _engine(self, model: Model) -> _core.Model:
        return model.engine(self._tabulate)

    def _tabulate(self, effect: OwnEffect, values: Floats) -> Tabulated:
        """Evaluate an effect for the whole table; a learned one belongs to one fit and is not kept."""
        if isinstance(effect, TabulatedLearned):
            return effect.tabulated(self.samples)
        return self.samples.tabulated(effect, values)


def _held(model: Model, effect: str) -> Term:
    """Return a term of an effect that a model lacks, at its start, held."""
    info = model.info(effect)
    return replace(started_term(effect, model.own(effect), info), free=np.zeros(info.size, bool))


def _blocks(sweep: NDArray[np.integer], max_rows: int) -> tuple[Ints, Ints]:
    """Cut sweeps into blocks of neighbouring readings: first row and length of each."""
    length = max(1, int(np.ceil(len(sweep) / max_rows)))
    edges = np.concatenate([[0], np.flatnonzero(np.diff(sweep)) + 1, [len(sweep)]])
    begin = np.concatenate(
        [
            np.linspace(first, last, max(1, round((last - first) / length)) + 1)[:-1].round()
            for first, last in pairwise(edges)
        ]
    ).astype(np.intp)
    return begin, np.diff(np.append(begin, len(sweep)))


def _codes(values: NDArray[np.generic]) -> Ints:
    codes: Ints = np.unique(values, return_inverse=True)[1].ravel()
    return codes


def _arcs(sweep: Ints) -> Ints:
    """Return the group of the arc in which each row lies."""
    found = np.empty(len(sweep), np.intp)
    for each in np.unique(sweep):
        rows = np.flatnonzero(sweep == each)
        found[rows] = np.arange(len(rows)) * ARCS // len(rows) % ARC_GROUPS
    return found
