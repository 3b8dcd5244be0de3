"""Hypotheses tried in full: fitted by the engine, with their discrepancy, and their evidence (Laplace).

A trial is a model with one or more hypotheses added, all free values fitted nonlinearly, then made linear about the
fit. Every effect of the catalogue among them has a discrepancy beside it: functions of its own variables at its own
place (`homes.py`), of a size that is a fraction f of the effect's, f half-normal with `Criteria.form_sigma`. These
columns stand in the linearisation beside the model's own values, so that evidence, held-out prediction and the search
for what else is missing all have them.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from hexdbb.errors import RunError
from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.engine import Engine, Fitted
from hexdbb.evidence.homes import Home, Homes, discrepancy
from hexdbb.evidence.marginal import marginal
from hexdbb.evidence.physical import outside_domain
from hexdbb.evidence.readings import GROUPINGS, Linear
from hexdbb.evidence.screen import Known
from hexdbb.evidence.signatures import signature_of
from hexdbb.evidence.sums import Sums, squared_error
from hexdbb.learned import Learned
from hexdbb.model import Model, Parameter

Floats = NDArray[np.float64]
KEPT = 24
"""Linearisations kept in memory: some megabytes each."""


@dataclass(frozen=True)
class Member:
    """A hypothesis of a trial; a learned one with its prior's factor and size."""

    hypothesis: Known | Learned
    factor: Floats | None = None
    size_mm: float = 0.0


@dataclass(frozen=True)
class Form:
    """How far an effect's form differs from the machine's: the relative size of the functions beside it."""

    fraction: float
    deviation: float
    functions: tuple[str, ...]


@dataclass(frozen=True)
class Trial:
    """Hypotheses fitted.

    Attributes
    ----------
    members : tuple of Member
    model : Model
        Fitted.
    log_evidence : float
    forms : tuple of Form or None
        One a member.
    refused : tuple of str
        Why a member is not admissible, one sentence each.
    left : float
        Mean square of the residual in noise variances, discrepancies explained.
    """

    members: tuple[Member, ...]
    model: Model
    log_evidence: float
    forms: tuple[Form | None, ...]
    refused: tuple[str, ...]
    left: float
    present: tuple[tuple[str, Form], ...] = ()
    """Effects that the model had before, each with its form."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the members."""
        return tuple(each.hypothesis.name for each in self.members)


class Trials:
    """Tries hypotheses on one set of rows.

    Parameters
    ----------
    engine : Engine
    homes : Homes
    criteria : Criteria
    """

    def __init__(self, engine: Engine, homes: Homes, criteria: Criteria) -> None:
        self.engine, self.homes, self.criteria = engine, homes, criteria
        self._known: dict[frozenset[str], Trial] = {}
        self._present = [Known(*each) for each in engine.present()]
        self._homes: dict[tuple[str, str, str], list[Home]] = {}
        self._linear: OrderedDict[frozenset[str], Linear] = OrderedDict()

    def of(self, members: Sequence[Member]) -> Trial:
        """Fit a model with hypotheses.

        Raises
        ------
        RunError
            Where the engine cannot fit it.
        """
        key = _key(members)
        if key not in self._known:
            self._known[key] = self._tried(tuple(members))
        return self._known[key]

    def linear(self, trial: Trial) -> Linear:
        """Return a trial's linearisation with the discrepancies; the last few are kept, others made anew."""
        key = _key(trial.members)
        if key not in self._linear:
            self._tried(trial.members)
        self._linear.move_to_end(key)
        return self._linear[key]

    @cached_property
    def explained_before(self) -> float:
        """Mean square of what the effects in the model explain that its other values do not, in noise variances."""
        fitted = self.engine.linearised(self.engine.base)
        names = {(each.effect, each.elements[0]) for each in self._present}
        every = [self.engine.base.parameters()[column] for column in fitted.free]
        own = np.array([(each.effect, each.element) in names for each in every])
        if not own.any():
            return 0.0
        part = fitted.linear.own[:, own] @ fitted.linear.standing[own]
        others = fitted.linear.own[:, ~own]
        imitated = others @ np.linalg.solve(others.T @ others + np.eye(others.shape[1]), others.T @ part)
        return float(np.mean((part - imitated) ** 2))

    def _tried(self, members: tuple[Member, ...]) -> Trial:
        fitted = self._fitted(members)
        linear, forms = fitted.linear, []
        present = []
        for known in self._present:
            linear, form = self._with_form(linear, fitted, Member(known))
            if form is not None:
                present.append((known.name, form))
        for member in members:
            linear, form = self._with_form(linear, fitted, member)
            forms.append(form)
        refused, penalty = outside_domain(fitted, [each.hypothesis for each in members], self.criteria)
        every = [*forms, *(form for _, form in present)]
        prior = sum(-0.5 * (form.fraction / self.criteria.form_sigma) ** 2 for form in every if form is not None)
        whole = Sums(linear, self.engine.readings, ()).whole
        change = whole.own_values()
        residual = linear.residual - linear.own @ change
        gain = 0.5 * float(whole.own @ whole.own)
        self._linear[_key(members)] = replace(linear, residual=residual, standing=linear.standing + change)
        if len(self._linear) > KEPT:
            self._linear.popitem(last=False)
        return Trial(
            members=members,
            model=fitted.model,
            log_evidence=linear.log_evidence + gain + penalty + prior,
            forms=tuple(forms),
            refused=refused,
            left=float(np.mean(residual**2)),
            present=tuple(present),
        )

    def _fitted(self, members: Sequence[Member]) -> Fitted:
        model = self.engine.base
        for member in members:
            if isinstance(member.hypothesis, Known):
                model = self.engine.with_effect(model, member.hypothesis.effect, member.hypothesis.elements)
            else:
                assert member.factor is not None
                model = self.engine.with_learned(model, member.hypothesis, member.factor, member.size_mm)
        free, added = model.free, {m.hypothesis.effect for m in members if isinstance(m.hypothesis, Known)}
        shapes = (
            np.array([each.is_shape and each.shape is None and each.effect in added for each in model.parameters()])
            & free
        )
        if not shapes.any():
            return self.engine.fit(model)
        found = []
        for start in self.criteria.shape_starts:
            values = np.where(shapes, start * model.prior_sigma, model.values)
            try:
                found.append(self.engine.fit(model.with_values(values)))
            except RunError:
                continue
        if not found:
            raise RunError("no start of the fit succeeded")
        return max(found, key=lambda each: each.linear.log_evidence)

    def _with_form(self, linear: Linear, fitted: Fitted, member: Member) -> tuple[Linear, Form | None]:
        """Add the discrepancy of an effect of the catalogue to a linearisation."""
        if not isinstance(member.hypothesis, Known):
            return linear, None
        size_mm, functions = self._size(fitted, member.hypothesis)
        if not functions or size_mm <= 0.0:
            return linear, Form(0.0, 0.0, ())
        spaces = [signature_of(each, self.engine.readings) for each in functions]
        signature = np.hstack([each.table for each in spaces])
        roughness = self.criteria.roughness[1]
        parts = [space.prior_factor(roughness if space.hypothesis.variable.is_smooth else 1.0) for space in spaces]
        factor = _diagonal(parts) * (size_mm / np.sqrt(len(spaces)))
        sums = Sums(linear, self.engine.readings, ())
        block = sums.block(signature)
        projected = sums.whole.project(block)
        factor = _visible(factor, projected.information, block.own[0], self.criteria.form_visible)
        if not factor.shape[1]:
            return linear, Form(0.0, 0.0, ())
        grid = np.array(self.criteria.form_grid)
        weights = stats.halfnorm.pdf(grid / self.criteria.form_sigma)
        found = marginal(projected.information, projected.gradient, [factor], grid, weights / weights.sum())
        if found.size <= 0.0:
            return linear, Form(0.0, 0.0, tuple(each.name for each in functions))
        at, squares = 0, []
        for space in spaces:
            width = space.table.shape[1]
            squares.append(space.rms_mm(found.coefficients[at : at + width]) ** 2)
            at += width
        deviation = float(np.sqrt(sum(squares))) / size_mm
        if deviation > self.criteria.form_limit:
            # At hundreds of times the noise no prior holds a discrepancy back: what differs so much is another cause.
            return linear, Form(0.0, 0.0, ())
        form = Form(found.size, deviation, tuple(each.name for each in functions))
        columns = signature @ (factor * found.size)
        wider = replace(
            linear,
            own=np.hstack([linear.own, columns]),
            standing=np.concatenate([linear.standing, np.zeros(columns.shape[1])]),
        )
        return wider, form

    def _size(self, fitted: Fitted, known: Known) -> tuple[float, list[Learned]]:
        """Return the RMS push (mm) of an effect as fitted, and the functions of its discrepancy."""
        model, readings = fitted.model, self.engine.readings
        sigmas = model.prior_sigma
        square, functions = 0.0, []
        for place, column in enumerate(fitted.free):
            parameter = model.parameters()[column]
            if parameter.effect != known.effect or parameter.element not in known.elements or parameter.is_shape:
                continue
            # Columns of the discrepancies stand behind those of the free values.
            homes = self._homes_of(parameter, fitted.linear.own[:, place])
            if homes:
                square += (homes[0].rms_mm * float(model.values[column]) / sigmas[column]) ** 2
                functions += [each for each in discrepancy(homes, self.criteria.most_homes) if each not in functions]
        assert len(readings) > 0
        return float(np.sqrt(square)), functions

    def _homes_of(self, parameter: Parameter, signature: Floats) -> list[Home]:
        """Return the homes of a value's signature; those of an effect without shape are the same in every trial."""
        key = (parameter.effect, parameter.element, parameter.name)
        if any(each.is_shape for each in self.engine.base.info(parameter.effect).parameters):
            return self.homes.around(signature)
        if key not in self._homes:
            self._homes[key] = self.homes.around(signature)
        return self._homes[key]


@dataclass(frozen=True)
class HeldOut:
    """Prediction of groups left out, in noise standard deviations.

    `before` and `after` are RMS errors without and with the hypotheses, `share` the part explained of what is beyond
    the noise, `expected` the RMS error that the fit to the other groups expects of itself.
    """

    before: float
    after: float
    share: float
    expected: float


def _key(members: Sequence[Member]) -> frozenset[str]:
    return frozenset(f"{each.hypothesis.name} {each.size_mm:.3g}" for each in members)


def heldout(trial: Trial, base: Trial, trials: Trials) -> dict[str, HeldOut]:
    """Predict every group from all others, to first order about the fits; by grouping that has two groups or more."""
    readings = trials.engine.readings
    before, after = Sums(trials.linear(base), readings), Sums(trials.linear(trial), readings)
    found, rows = {}, len(readings)
    for grouping in GROUPINGS:
        groups = before.groups(grouping)
        if len(groups) < 2:
            continue
        without = sum(squared_error(before, c, before.without(c).own_values(), None, None) for c in groups)
        error = expected = 0.0
        for cells in groups:
            training = after.without(cells)
            error += squared_error(after, cells, training.own_values(), None, None)
            expected += training.expected_error(after, cells)
        share = (without - error) / max(without - rows, 1e-9)
        found[grouping] = HeldOut(
            float(np.sqrt(without / rows)), float(np.sqrt(error / rows)), share, float(np.sqrt(expected / rows))
        )
    return found


def _visible(factor: Floats, projected: Floats, whole: Floats, least: float) -> Floats:
    """Keep the directions of a discrepancy that the model's own values do not imitate: shape (k, r)."""
    values, vectors = np.linalg.eigh(factor.T @ whole @ factor)
    kept = values > 1e-9 * values[-1]
    white = factor @ (vectors[:, kept] / np.sqrt(values[kept]))
    shares, turned = np.linalg.eigh(white.T @ projected @ white)
    # Back in the prior's own scale: a direction's size is what it was before it was whitened.
    own = np.sqrt(values[kept])[:, None] * turned
    seen = shares > least
    axes, _ = np.linalg.qr(own[:, seen]) if seen.any() else (own[:, :0], None)
    found: Floats = factor @ vectors[:, kept] @ axes
    return found


def _diagonal(parts: Sequence[Floats]) -> Floats:
    width = sum(each.shape[0] for each in parts)
    table, at = np.zeros((width, sum(each.shape[1] for each in parts))), [0, 0]
    for each in parts:
        table[at[0] : at[0] + each.shape[0], at[1] : at[1] + each.shape[1]] = each
        at[0] += each.shape[0]
        at[1] += each.shape[1]
    return table
