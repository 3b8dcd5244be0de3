"""From records and models to plain arrays, and back: with `absent.py` all that knows the engine and the samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis import Noise, evaluate_fit
from hexdbb.errors import RunError
from hexdbb.evidence.criteria import DEFAULT, Criteria
from hexdbb.evidence.linear.absent import Absent, held
from hexdbb.evidence.linear.axes import LearnedAxes, Standing, learned_of
from hexdbb.evidence.linear.prior import LEAST_SCALE, prior_scale
from hexdbb.evidence.linear.readings import ARC, Linear, Readings, State
from hexdbb.evidence.linear.rows import arcs_of, blocks_of, codes_of, means_of, middles_of
from hexdbb.learned import Learned
from hexdbb.model import Model, MountKey, OwnEffect, Tabulated, new_term
from hexdbb.samples import Samples, of_its_own

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
UNSEEN = 1e-3
"""Information, in values' worth, below which a direction of a learned function that the model has already is left out:
it stands in every hypothesis alike, and changes the evidence of one over another by less."""

SCALE_ROUNDS = 2
"""Fits with a wider prior, at most: the first follows the value that the normal prior held back, the second what the
first found."""


@dataclass(frozen=True)
class Fitted:
    """A model fitted to the rows, linear about the fit."""

    model: Model
    linear: Linear
    free: Ints
    """Places of the free values in the model's."""
    prior_sigma: Floats
    """Their prior standard deviations, engine units."""

    @cached_property
    def spread(self) -> Floats:
        """Standard deviations of the free values, in prior standard deviations."""
        information = self.linear.normal[:-1, :-1] + np.eye(len(self.free))
        return np.sqrt(np.diag(np.linalg.inv(information)))


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
        within_mm = criteria.block_turns * samples.machine.sliders.screw_lead_mm
        blocks = blocks_of(samples["sweep"], criteria.max_rows)
        begin, count = middles_of(*blocks, samples["sliders_mm"], within_mm)
        chosen = begin + count // 2
        self.part = samples.part(chosen)
        averaged = means_of(self.residual_mm, begin, count)
        self.reading_mm = self.part.reading_mm - self.residual_mm[chosen] + averaged
        self.row_noise_mm = noise.sigma_mm / np.sqrt(count)
        self._fitted_rows = np.unique(np.linspace(0, len(chosen) - 1, min(len(chosen), criteria.fit_rows)).astype(int))
        self._fitted_part = samples.part(chosen[self._fitted_rows])
        self._blocks: dict[tuple[int, tuple[MountKey, ...], frozenset[str]], _core.Samples] = {}
        self._tables: dict[OwnEffect, Tabulated] = {}
        self.absent = Absent(self)

    @cached_property
    def readings(self) -> Readings:
        """State, groups and noise of the rows."""
        part = self.part
        groups = {
            "circle": codes_of(part["circle"]),
            "feed": codes_of(part["feed_mm_s"]),
            "direction": codes_of(part["direction"]),
            "lap": codes_of(part["lap"]),
            "sweep": codes_of(part["sweep"]),
            ARC: arcs_of(codes_of(part["sweep"])),
        }
        ports = _core.port_sensitivity(*self.plain(self.base)) / self.row_noise_mm[:, None]
        return Readings(self._state, groups, self.row_noise_mm, np.asfortranarray(ports))  # taken column by column

    @cached_property
    def _state(self) -> State:
        return State(self.part, self.part.machine, self.part.unmeasured)

    @cached_property
    def _fitted_state(self) -> State:
        return self._state.rows(self._fitted_rows)

    @cached_property
    def start(self) -> Model:
        """The base as fits begin from it: of its learned functions the axes that the readings see."""
        model = self.base
        ports = self.readings.ports
        for term in model.learned:
            if term.free.all():
                axes = LearnedAxes.of(term)
                push = axes.answer(self._state, ports) * axes.size_mm
                seen, turned = np.linalg.eigh(push.T @ push)
                kept = turned[:, seen > min(UNSEEN, 0.5 * float(seen[-1]))]
                fewer = replace(axes, factor=axes.factor @ kept)
                standing = replace(new_term(fewer.name, kept.shape[1]), values=kept.T @ term.values)
                terms = tuple(standing if each is term else each for each in model.terms)
                model = replace(model.knowing_effects([fewer]), terms=terms)
        return model

    def fit(
        self, model: Model, from_minimum: bool = False, starts: Sequence[Floats] = (), less: Floats | None = None
    ) -> Fitted:
        """Fit a model's free values to some of the rows and linearise about the fit.

        What the other rows add is first order (`Trials` takes that step); they cost most of a fit's time.

        Parameters
        ----------
        model : Model
        from_minimum : bool
            The minimum is near the model's values.
        starts : sequence of ndarray, shape (size,)
            Further values from which to begin; those that are held stay the model's.
        less : ndarray, shape (n,), optional
            What the model need not describe of each row, in noise standard deviations; the linearisation has it.

        Raises
        ------
        RunError
            Where the fit did not end in a usable solution.
        """
        shaped = np.array([each.shape is not None for each in model.parameters()])
        rounds = self.criteria.shape_rounds if (shaped & model.free).any() else 1
        used = np.ones(len(shaped))
        wanted_mm = self.reading_mm if less is None else self.reading_mm - less * self.row_noise_mm
        for _ in range(rounds):
            model, starts = self._fitted_once(model, wanted_mm, shaped, used, from_minimum, starts), ()
        found = self.linearised(model)
        # An effect that turns out larger than expected is fitted again, where its prior no longer pulls at it.
        for _ in range(SCALE_ROUNDS):
            scale = self._scale_of(model, found.linear.residual)
            if np.max(np.abs(np.log(scale / used)), initial=0.0) < np.log(LEAST_SCALE):
                break
            model, used = self._fitted_once(model, wanted_mm, shaped, scale, from_minimum=True), scale
            found = self.linearised(model)
        return found

    def prior_scale(self, model: Model) -> Floats:
        """Return factors on the prior standard deviations, those of the one effect that is tried: shape (size,)."""
        return prior_scale(model, self._mine(), self._there, self.criteria)

    def _scale_of(self, model: Model, residual: Floats) -> Floats:
        """Return the factors where they count: where the effect, held back, explains nearly all as it is.

        What explains a part only and is far too large stands in for something else.
        """
        scale = self.prior_scale(model)
        if (scale == 1.0).all():
            return scale
        left = float(np.mean(residual**2))
        return scale if left - 1.0 < self.criteria.complete * (self.left_before - 1.0) else np.ones(len(scale))

    @cached_property
    def _there(self) -> set[tuple[str, str]]:
        """Effects and elements that the model has, learned functions in either form: none is the one that is tried."""
        return {
            (each.effect, each.element)
            for model in (self.base, self.start)
            for each, is_free in zip(model.parameters(), model.free, strict=True)
            if is_free
        }

    @cached_property
    def left_before(self) -> float:
        """Mean square (noise variances) that the model leaves as it is."""
        prediction = _core.predict(*self.plain(self.start))
        return float(np.mean(((self.reading_mm - prediction.reading_mm) / self.row_noise_mm) ** 2))

    def _fitted_once(
        self,
        model: Model,
        wanted_mm: Floats,
        shaped: NDArray[np.bool_],
        prior_scale: Floats,
        from_minimum: bool,
        starts: Sequence[Floats] = (),
    ) -> Model:
        """Fit all free values; shapes of users' effects go one step of Gauss and Newton."""
        fewer, part = self._fitted_rows, self._fitted_part
        before = np.where(shaped, model.values, 0.0)  # the engine has the change of these
        result = _core.fit(
            model.engine(partial(self._tabulate, part, self._fitted_state)),
            self._block(part, model),
            wanted_mm[fewer],
            noise_mm=float(np.mean(self.row_noise_mm)) * float(np.sqrt(len(fewer) / len(self.reading_mm))),
            free=[bool(each) for each in model.free],
            hypothesis=True,
            from_minimum=from_minimum,
            covariance=False,  # that of the linearisation on all rows counts
            prior_scale=prior_scale,
            starts=np.array([each - before for each in starts]).reshape(len(starts), len(before)).T,
        )
        if not result.usable:
            raise RunError(f"{self.samples.name}: the fit did not succeed: {result.termination}")
        values = result.values + before
        for place in np.flatnonzero(shaped):
            domain = model.parameters()[place].shape
            assert domain is not None
            values[place] = np.clip(values[place], domain.lower, domain.upper)
        return model.with_values(values)

    def linearised(self, model: Model) -> Fitted:
        """Linearise the rows about a model as it is."""
        engine, block = self.plain(model)
        prediction = _core.predict(engine, block, want_jacobian=True)
        free = np.flatnonzero(model.free)
        residual = (self.reading_mm - prediction.reading_mm) / self.row_noise_mm
        prior = (model.prior_sigma * self._scale_of(model, residual))[free]
        own = self._jacobian(model, prediction.jacobian, engine, block)[:, free]
        own *= prior
        own /= self.row_noise_mm[:, None]
        linear = Linear(residual=residual, own=own, standing=(model.values - model.start)[free] / prior)
        return Fitted(model, linear, free, prior)

    def _jacobian(self, model: Model, plain: Floats, engine: _core.Model, block: _core.Samples) -> Floats:
        """Return the derivatives of the readings by all values, from those without learned functions, mm per unit."""
        learned = learned_of(model)
        if not learned:
            return plain
        answers = _core.port_sensitivity(engine, block)
        found = np.empty((len(plain), len(model.values)))
        at = first = 0
        for term in model.terms:
            width = len(term.values)
            own = found[:, at : at + width]
            at += width
            if term.effect in learned:
                own[:] = learned[term.effect].answer(self._state, answers)
            else:
                own[:] = plain[:, first : first + width]
                first += width
        return found

    def plain(self, model: Model) -> tuple[_core.Model, _core.Samples]:
        """Return the engine's form of a model and all rows: learned functions as they stand, without their values."""
        plain = self.without_learned(model)
        return plain.engine(partial(self._tabulate, self.part, self._state)), self._block(self.part, plain)

    def without_learned(self, model: Model) -> Model:
        """Return a model in which one effect, the last, pushes what all its learned functions push."""
        learned = learned_of(model)
        if not learned:
            return model
        pushes: dict[int, Floats] = {}
        for term in model.terms:
            if term.effect in learned:
                for port, pushed in learned[term.effect].pushes_mm(self._state, term.values).items():
                    pushes[port] = pushes.get(port, 0.0) + pushed
        standing = Standing.of(pushes)
        others = tuple(term for term in model.terms if term.effect not in learned)
        term = replace(new_term(standing.name, 1, free=False), values=np.ones(1))
        return replace(model.knowing_effects([standing]), terms=(*others, term))

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

    def values_of(self, model: Model, effect: str, elements: Sequence[str]) -> NDArray[np.bool_]:
        """Return which free values of a model are those of an effect at some elements."""
        named = zip(model.parameters(), model.free, strict=True)
        of = [each.effect == effect and each.element in elements for each, is_free in named if is_free]
        return np.array(of, dtype=bool)

    def _mine(self) -> set[str]:
        return {*_core.effect_names("catalogue"), *self.base.own_effects}

    def with_effect(self, model: Model, effect: str, elements: Sequence[str]) -> Model:
        """Return the model with some elements of an effect of the catalogue free as well, at zero."""
        if effect not in {term.effect for term in model.terms}:
            model = replace(model, terms=(*model.terms, held(model, effect)))
        freed = [each.effect == effect and each.element in elements for each in model.parameters()]
        return model.with_free(model.free | np.array(freed))

    def with_learned(self, model: Model, hypothesis: Learned, factor: Floats, size_mm: float) -> Model:
        """Return the model with a learned hypothesis, its coefficients free, at zero."""
        own = LearnedAxes(self._state.space(hypothesis), factor, size_mm)
        wider = model.knowing_effects([own])
        return replace(wider, terms=(*wider.terms, new_term(own.name, factor.shape[1])))

    def _block(self, part: Samples, model: Model) -> _core.Samples:
        """Return the engine's form of a part of the samples as if there were no others: tables have its rows alone."""
        key = (len(part), model.mounts, model.needs)
        if key not in self._blocks:
            self._blocks[key] = of_its_own(part.block(model))
        return self._blocks[key]

    def _tabulate(self, part: Samples, state: State, effect: OwnEffect, values: Floats) -> Tabulated:
        """Evaluate an effect for the rows of a part; learned functions of the base, those of every trial, are kept."""
        if isinstance(effect, Standing):
            return effect.table
        if isinstance(effect, LearnedAxes):
            if self.start.own(effect.name) is not effect:
                return effect.tabulated(state)
            if effect not in self._tables:
                self._tables[effect] = effect.tabulated(state)
            return self._tables[effect]
        whole = self.samples.tabulated(effect, values)
        return replace(whole, per_unit=whole.per_unit[part.row_numbers])
