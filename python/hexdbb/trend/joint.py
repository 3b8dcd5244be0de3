"""Records fitted together: one machine, a set-up for each record, and chosen values that change from record to record.

Records that share a fixing of the cup (`hexdbb.samples.fixings`) share its position too; it counts among the shared
values.

Model: y_r = f(x + v_r, z_r) + noise, record by record; x are the machine's values, shared by all; z_r the set-up of
record r (cups, ball); v_r the departure of the changing values from the shared ones, zero elsewhere. All have normal
priors: x and z_r with the catalogue's standard deviations, v_r with a part of them (`Changing.scale`).
Method: Gauss-Newton on the normal equations of every record, solved together (`hexdbb.trend.arrow`).
Assumption: nearly linear (errors of 0.1 mm on legs of 400 mm), as in `hexdbb.diagnosis`; a few steps suffice.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis import noise_of
from hexdbb.errors import RunError
from hexdbb.model import Model, MountKey, new_term
from hexdbb.samples import Samples, normal_equations, predict
from hexdbb.trend.arrow import Changing, Equations, Layout, Solution, cost, solve

Floats = NDArray[np.float64]

STEPS = 60
"""Largest number of steps tried: ten to thirty are needed from the nominal machine, most of them along directions that
only the curvature of the readings determines; a few from a fitted machine."""
AT_REST = 0.02
"""Fall of half chi-square below which steps end: one standard deviation of any value is a fall of 0.5."""
LEAST_DAMPING, DAMPED_MORE = 1.0, 5.0
"""Levenberg-Marquardt: the least information, in that of a prior, by which a step uphill shortens the next one, and
the factor from one to the next. Steps lead uphill along the height of a cup that only level circles see: its square
shortens the bar, and a tenth of its prior standard deviation is a step already."""


@dataclass(frozen=True, eq=False)
class Part:
    """One record as the fit sees it.

    Attributes
    ----------
    samples : Samples
    noise_mm : float
        Of one reading.
    """

    samples: Samples
    noise_mm: float

    @classmethod
    def of(cls, samples: Samples) -> Part:
        """Return a record with the noise of its own readings."""
        return cls(samples, noise_of(samples).sigma_mm)


@dataclass(frozen=True, eq=False)
class JointFit:
    """Records fitted together.

    Attributes
    ----------
    parts : tuple of Part
    models : tuple of Model
        Each record's: the shared values and its own.
    departures : tuple of ndarray
        Of the changing values from the shared ones, in prior standard deviations.
    equations : tuple of Equations
        About the values of `models`.
    solution : Solution
        About them too; its steps are those that were not taken any more.
    damping : float
        With which the last steps led downhill: the curvature along the set-ups' weak directions, which the equations
        do not have.
    """

    parts: tuple[Part, ...]
    models: tuple[Model, ...]
    departures: tuple[Floats, ...]
    equations: tuple[Equations, ...]
    solution: Solution
    damping: float = 0.0

    @property
    def cost(self) -> float:
        """Half of chi-square of readings and priors, readings counting as in `equations`."""
        return cost(self.equations, self.layout, self.changing, self.departures)

    @property
    def layout(self) -> Layout:
        """Which values are shared."""
        return self.solution.layout

    @property
    def changing(self) -> tuple[Changing, ...]:
        """The values that change from record to record."""
        return self.solution.changing


def started(parts: Sequence[Part], model: Model) -> tuple[Model, ...]:
    """Return the model that each record begins with: the machine of `model`, mounts where planned.

    Every model knows the fixings of the cup that several records share, and first; then the mounts of its own record.
    """
    counts = Counter(key for part in parts for key in part.samples.mounts)
    shared = [key for key, count in counts.items() if count > 1]
    own = [[key for key in part.samples.mounts if counts[key] == 1] for part in parts]
    return tuple(_of_mounts(model, (*shared, *each)) for each in own)


def fit_together(
    parts: Sequence[Part],
    models: Sequence[Model],
    changing: Sequence[Changing] = (),
    departures: Sequence[Floats] | None = None,
) -> JointFit:
    """Fit records together.

    Parameters
    ----------
    parts : sequence of Part
    models : sequence of Model
        Where the fit starts (`started`, or those of an earlier fit).
    changing : sequence of Changing
    departures : sequence of ndarray, optional
        Those of `models`; zero where not given.

    Raises
    ------
    InputError
        A record of another machine, or a sample that the machine cannot reach.
    RunError
        Steps did not come to rest.
    """
    layout = _layout(models)
    columns = np.array([column for each in changing for column in each.columns], dtype=np.intp)
    departed = [np.zeros(len(columns)) for _ in models] if departures is None else list(departures)
    state = _State(tuple(models), tuple(departed))
    equations = _of_all(parts, state.models)
    damping = 0.0
    for _ in range(STEPS):
        solution = solve(equations, layout, changing, state.departures, damping)
        further = state.moved(solution)
        there = _of_all(parts, further.models, equations)
        fall = cost(equations, layout, changing, state.departures) - cost(there, layout, changing, further.departures)
        if fall < 0.0:
            damping = max(DAMPED_MORE * damping, LEAST_DAMPING)
        else:
            damping = damping / DAMPED_MORE if damping > LEAST_DAMPING else 0.0
            state, equations = further, _of_all(parts, further.models)
        if abs(fall) < AT_REST:
            solution = solve(equations, layout, changing, state.departures)
            return JointFit(tuple(parts), state.models, state.departures, equations, solution, damping)
    raise RunError(f"records fitted together: no rest after {STEPS} steps (expected a model nearer to the machine)")


@dataclass(frozen=True, eq=False)
class _State:
    """Where a fit stands: every record's model, and its departures."""

    models: tuple[Model, ...]
    departures: tuple[Floats, ...]

    def moved(self, solution: Solution) -> _State:
        """Return the state one step further."""
        models, departures = [], []
        for number, (model, own) in enumerate(zip(self.models, solution.own, strict=True)):
            set_up, change = solution.layout.set_up[number], own[solution.of_departures(number)]
            step = np.zeros(len(model.values))
            step[solution.layout.places[number]] = solution.moved
            step[set_up] = own[: len(set_up)]
            step[solution.departing] += change
            models.append(model.with_values(model.values + step * model.prior_sigma))
            departures.append(self.departures[number] + change)
        return _State(tuple(models), tuple(departures))


def _of_all(
    parts: Sequence[Part], models: Sequence[Model], weighed: Sequence[Equations] | None = None
) -> tuple[Equations, ...]:
    """Return the equations of all records; readings count as in others where given, else by what the models leave."""
    found = [_equations(part, model) for part, model in zip(parts, models, strict=True)]
    if weighed is None:
        return _pooled(found)
    return tuple(replace(each, effective_mm=by.effective_mm) for each, by in zip(found, weighed, strict=True))


def _layout(models: Sequence[Model]) -> Layout:
    counts = Counter(key for model in models for key in model.mounts)
    places, own = [], []
    for model in models:
        parameters = model.parameters()
        joint = [str(number) for number, key in enumerate(model.mounts, 1) if counts[key] > 1]
        of_mounts = np.array([model.info(each.effect).element_kind == "mount" for each in parameters])
        of_joint = of_mounts & np.array([each.element in joint for each in parameters])
        is_own = np.array([each.is_set_up for each in parameters]) | of_mounts
        # Shape parameters of the user's effects are held: they are not fitted by these equations.
        machine = ~is_own & np.array([each.shape is None for each in parameters])
        # Mounts after all else: shared values then stand in one order in all records.
        of_fixings = np.flatnonzero(of_joint & model.free)
        places.append(np.concatenate([np.flatnonzero(machine & model.free), of_fixings]))
        own.append(np.flatnonzero(is_own & ~of_joint & model.free))
    return Layout(places[0], tuple(own), tuple(places), len(of_fixings))


def _of_mounts(model: Model, mounts: tuple[MountKey, ...]) -> Model:
    """Return the model with some mounts in place of its own; values of the set-up start where planned."""
    known = replace(model, mounts=mounts)
    is_mount = {term.effect: model.info(term.effect).element_kind == "mount" for term in model.terms}
    # Effects of mounts stand last: places of all other values are then the same in every record.
    ordered = sorted(model.terms, key=lambda term: is_mount[term.effect])
    return replace(
        known,
        terms=tuple(
            new_term(term.effect, known.info(term.effect).size, free=bool(term.free.any()))
            if is_mount[term.effect]
            else term
            for term in ordered
        ),
    )


def _equations(part: Part, model: Model) -> Equations:
    found = normal_equations(part.samples, model)
    if found.failure >= 0:
        predict(part.samples, model)  # raises, naming the sample
    prior = model.prior_sigma
    residual_mm = predict(part.samples, model).residual_mm
    rms_mm = float(np.sqrt(np.mean(residual_mm**2)))
    correlation = _core.autocorrelation_time(residual_mm, part.samples["sweep"])
    return Equations(
        found.information * np.outer(prior, prior),
        found.gradient * prior,
        (model.values - model.start) / prior,
        max(part.noise_mm, rms_mm) * float(np.sqrt(correlation)),
        part.noise_mm,
        found.squared,
        rms_mm,
        len(residual_mm),
    )


def _pooled(equations: Sequence[Equations]) -> tuple[Equations, ...]:
    """Return the equations with readings of all records counting alike, where a record's own noise is not larger.

    Weights by each record's own residual would let the records that the model fits badly, the changed ones, count
    least.
    """
    readings = sum(each.readings for each in equations)
    pooled_mm = float(np.sqrt(sum(each.readings * each.effective_mm**2 for each in equations) / readings))
    return tuple(replace(each, effective_mm=max(pooled_mm, each.noise_mm)) for each in equations)
