"""Hypotheses tried in full: fitted by the engine, with their discrepancy, and their evidence (Laplace).

A trial is a model with one or more hypotheses added, all free values fitted nonlinearly, then made linear about the
fit. Every effect of the catalogue among them has a discrepancy beside it: functions of its own variables at its own
place (`homes.py`), of a size that is a fraction f of the effect's, f half-normal with `Criteria.form_sigma`. These
columns stand in the linearisation beside the model's own values, so that evidence, held-out prediction and the search
for what else is missing all have them.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import RunError
from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.fit.fits import fitted
from hexdbb.evidence.fit.trial import NOTHING_LEFT, Member, Trial
from hexdbb.evidence.forms.alike import gained_alike
from hexdbb.evidence.forms.form import Form, Forms
from hexdbb.evidence.forms.homes import Homes
from hexdbb.evidence.linear.engine import Engine, Fitted
from hexdbb.evidence.linear.physical import outside_domain
from hexdbb.evidence.linear.readings import Linear
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.linear.sums import Sums
from hexdbb.learned import Learned
from hexdbb.threads import fits_at_once

Floats = NDArray[np.float64]
KEPT, KEPT_BYTES = 24, 128e6
"""Linearisations kept in memory, at most, and their size: some megabytes each of 10,000 rows, ten where functions have
many splines; 24 of those took 300 MB, and a search takes as long with fewer."""
FORM_ROUNDS = 3
"""Times that an effect's form is asked for, at most, beside the forms of others, which change meanwhile: functions
chosen in turn settle in the second round mostly."""


class Trials:
    """Tries hypotheses on one set of rows.

    Parameters
    ----------
    engine : Engine
    homes : Homes
    criteria : Criteria
    """

    def __init__(self, engine: Engine, homes: Homes, criteria: Criteria) -> None:
        self.engine, self.criteria = engine, criteria
        self.forms = Forms(engine, homes, criteria)
        self._known: dict[frozenset[str], Trial] = {}
        self._in_order: dict[tuple[str, ...], Trial] = {}
        self._ahead: dict[frozenset[str], Future[Fitted]] = {}
        self.present = [Known(*each) for each in engine.present()]
        self._linear: OrderedDict[frozenset[str], Linear] = OrderedDict()
        self._base: dict[tuple[str, ...], Sums] = {}
        self._last_sums: tuple[Trial, tuple[str, ...], Sums] | None = None
        """What a check asks several questions of."""

    def of(self, members: Sequence[Member], near: Trial | None = None) -> Trial:
        """Fit a model with hypotheses.

        Parameters
        ----------
        members : sequence of Member
        near : Trial, optional
            Of nearly the same members: the fit starts from its values.

        Returns
        -------
        Trial
            With its members in the order asked for, whichever was fitted.

        Raises
        ------
        RunError
            Where the engine cannot fit it, or a function is there twice.
        """
        key = _key(members)
        if key not in self._known:
            if len({each.hypothesis.name for each in members}) < len(members):
                raise RunError("a set has one function twice")
            ahead = self._ahead.pop(key, None)
            found = self._about(tuple(members), self._fitted(members, near) if ahead is None else ahead.result())
            self._known[key] = self._beside_forms(found)
        return self._ordered(self._known[key], members)

    def _beside_forms(self, trial: Trial) -> Trial:
        """Return what fits beside forms find, where that leaves far less than a fit of formulas alone.

        Such a fit need not describe what forms do: a spike of three times the noise was held at zero by what the
        formula of a bow of thirty left. First beside the forms of all but the last, which had taken half of the spike,
        then beside all: the noise's variance was left 8.6, 1.2, and 1.0 times. Only what is likelier than the set
        without it is worth the time, and a shape, of which first order tells nothing.
        """
        before = self._known.get(_key(trial.members[:-1])) if len(trial.members) > 1 else None
        if before is None or trial.left - 1.0 < NOTHING_LEFT or not any(before.columns_of_forms()):
            return trial
        last, gain = trial.members[-1].hypothesis, trial.log_evidence - before.log_evidence
        has_shape = isinstance(last, Known) and self.engine.absent.has_shape(last.effect)
        if gain < self.criteria.detect_nats and not has_shape:
            return trial
        found = self._fitted_beside(trial, partial(fitted, before=before, less=self._beyond_formulas(before)))
        again = self._fitted_beside(found, partial(fitted, near=found, less=self._beyond_formulas(found)))
        best = max(found, again, key=lambda each: each.log_evidence)
        # Of two fits that leave nearly the same the one of formulas keeps less in free functions: a gain beside a
        # delay left 1.20 in place of 1.21 times the noise, and erred by 19 in place of 5 where a feed was left out.
        is_far_better = best.left - 1.0 < self.criteria.far_better * (trial.left - 1.0)
        best = best if best.log_evidence > trial.log_evidence and is_far_better else trial
        if best is not again:
            self._linear.pop(_key(trial.members), None)  # of the fit made last; made anew where it is asked for
        return best

    def beside_own_forms(self, trial: Trial) -> Trial:
        """Fit a set again beside what the functions of its forms describe; return what has more evidence.

        To first order a form is right where formulas alone end, and what it leaves there is predicted: a lead beside a
        bow erred by 3.5 times the noise on circles left out, by 1.6 fitted so.
        """
        again = self._fitted_beside(trial, partial(fitted, near=trial, less=self._beyond_formulas(trial)))
        if again.log_evidence <= trial.log_evidence:
            self._linear.pop(_key(trial.members), None)
            return trial
        self._known[_key(trial.members)] = again
        return again

    def _fitted_beside(self, trial: Trial, fit: Callable[[Engine, Sequence[Member]], Fitted]) -> Trial:
        """Return a trial as another fit finds it; the same where there is none."""
        try:
            return self._about(trial.members, fit(self.engine, trial.members))
        except RunError:
            return trial

    def _ordered(self, trial: Trial, members: Sequence[Member]) -> Trial:
        """Return a trial with its members in an order: what is asked of the last one is asked of what was added."""
        names = tuple(each.hypothesis.name for each in members)
        if names == trial.names:
            return trial
        kept = self._in_order.get(names)
        if kept is None or kept.model is not trial.model:
            places = [trial.names.index(each) for each in names]
            own, forms = tuple(map(trial.members.__getitem__, places)), tuple(map(trial.forms.__getitem__, places))
            kept = self._in_order[names] = replace(trial, members=own, forms=forms)
        return kept

    def of_fewer(self, members: Sequence[Member], whole: Trial) -> Trial:
        """Fit what is left of a set, whose time constants are not sought anew from several starts."""
        known = (each.hypothesis.effect for each in members if isinstance(each.hypothesis, Known))
        return self.of(members, near=whole if any(map(self.engine.absent.has_shape, known)) else None)

    def with_shapes_anew(self, members: Sequence[Member]) -> Trial:
        """Fit a set as `of` does, the shapes of its last effect sought anew; keep what has more evidence.

        Found alone, the time of a spike was that of whatever else was at fault too.
        """
        key = _key(members)
        before = self._known.get(key)
        found = self._about(tuple(members), self._fitted(members))
        if before is not None and before.log_evidence >= found.log_evidence:
            self._linear.pop(key, None)  # of what was found; made anew where it is asked for
            return self._ordered(before, members)
        self._known[key] = found
        return found

    def each_of(self, every: Iterable[Sequence[Member]], near: Trial | None = None) -> Iterator[Callable[[], Trial]]:
        """Fit several models with hypotheses beside each other, as many at once as there are cores.

        Parameters
        ----------
        every : iterable of sequences of Member
        near : Trial, optional
            As `of` has it.

        Yields
        ------
        callable
            Returns the next trial, as `of` does, while those behind it are fitted: the engine fits without Python's
            lock.
        """
        new, at_once = list(every), fits_at_once()
        with ThreadPoolExecutor(at_once) as pool:
            for place, each in enumerate(new):
                # As many again wait, so that no core does while a trial is weighed about its fit.
                for later in new[place : place + 2 * at_once]:
                    key = _key(later)
                    if not (self.has(later) or key in self._ahead):
                        self._ahead[key] = pool.submit(self._fitted, later, near)
                yield partial(self.of, each, near)

    def has(self, members: Sequence[Member]) -> bool:
        """Check whether a model with hypotheses was fitted already."""
        return _key(members) in self._known

    def forget(self) -> None:
        """Release linearisations and what was made of them; each is made anew where it is asked for."""
        self._linear.clear()
        self._base.clear()
        self._ahead.clear()
        self._last_sums = None
        self.forms.functions.forget()

    def linear(self, trial: Trial) -> Linear:
        """Return a trial's linearisation with the discrepancies; the last few are kept, others made anew."""
        key = _key(trial.members)
        if key not in self._linear:
            linear = self.engine.linearised(trial.model).linear
            # Which functions stand beside the effects was decided when they were weighed.
            for form in sorted((form for form, _ in trial.columns_of_forms()), key=lambda each: each.first):
                linear = self.forms.with_columns(linear, form)
            self._keep(key, linear, self._change(linear))
        self._linear.move_to_end(key)
        return self._linear[key]

    def with_laws_at_each(self, trial: Trial, only: Form | None = None) -> Linear:
        """Return a trial's linearisation with six sizes of the law of each effect that elements share.

        Parameters
        ----------
        trial : Trial
        only : Form, optional
            Of the one effect that is asked for; of all where not given.
        """
        linear = self.linear(trial)
        for form in trial.forms:
            if form is not None and form.law is not None and (only is None or form is only):
                linear = linear.wider(form.law.differences)
        return linear

    def _change(self, linear: Linear) -> Floats:
        """Return the change of all values that leads to the best of all rows."""
        return Sums(linear, self.engine.readings, ()).whole.own_values()

    def _keep(self, key: frozenset[str], linear: Linear, change: Floats) -> Linear:
        """Keep a linearisation, moved to the best values; of too many the one not asked for the longest is dropped."""
        moved = self._linear[key] = linear.moved(change)
        while len(self._linear) > 1 and (len(self._linear) > KEPT or self._kept_bytes() > KEPT_BYTES):
            self._linear.popitem(last=False)
        return moved

    def _kept_bytes(self) -> int:
        return sum(each.own.nbytes for each in self._linear.values())

    def sums(self, trial: Trial, groupings: tuple[str, ...]) -> Sums:
        """Return the sums of a trial's linearisation; those of the model without hypotheses are kept, and the last."""
        if trial.members:
            last = self._last_sums
            if last is None or last[0].model is not trial.model or last[1] != groupings:
                last = self._last_sums = trial, groupings, Sums(self.linear(trial), self.engine.readings, groupings)
            return last[2]
        if groupings not in self._base:
            self._base[groupings] = Sums(self.linear(trial), self.engine.readings, groupings)
        return self._base[groupings]

    @cached_property
    def present_elements(self) -> set[tuple[str, str]]:
        """Effects that the model had before, each with its element."""
        return {(each.effect, each.elements[0]) for each in self.present}

    @cached_property
    def explained_before(self) -> float:
        """Mean square of what the effects in the model explain that its other values do not, in noise variances.

        With the functions of their forms: where geometry takes most of an effect, its form is what the readings show.
        """
        root = self.of(())
        linear, own = self.linear(root), self._columns_of_present(root)
        for _, columns in root.columns_of_forms():
            own[columns] = True
        return linear.beyond(own, ~own)[1]

    def pushed(self, trial: Trial) -> Floats:
        """Return what the effects that the model had before push on each row, in noise standard deviations."""
        linear, own = self.linear(trial), self._columns_of_present(trial)
        return linear.own[:, own] @ linear.standing[own]

    def _columns_of_present(self, trial: Trial) -> NDArray[np.bool_]:
        """Return which columns of a trial's linearisation are those of effects that the model had before."""
        parameters, free = trial.model.parameters(), np.flatnonzero(trial.model.free)
        own = np.zeros(self.linear(trial).own.shape[1], bool)
        own[: len(free)] = [
            (parameters[place].effect, parameters[place].element) in self.present_elements for place in free
        ]
        return own

    def size(self, trial: Trial, known: Known) -> float:
        """Mean square of what a known effect of a trial pushes that geometry does not, in noise variances.

        What it explains alone; that other effects may stand in for it makes it no smaller.
        """
        linear, model = self.linear(trial), trial.model
        own, geometry = np.zeros((2, linear.own.shape[1]), bool)
        own[: int(model.free.sum())] = self.engine.values_of(model, known.effect, known.elements)
        geometry[: int(model.free.sum())] = self.engine.geometry_of(model)
        return linear.beyond(own, geometry)[1]

    def bent(self, trial: Trial) -> float:
        """Mean square, in noise variances, by which geometry is bent beyond its priors.

        What a set leaves to geometry costs evidence as what it leaves unexplained does; a prior standard deviation of
        each value is what a machine has.
        """
        standing = self.linear(trial).standing[: int(trial.model.free.sum())][self.engine.geometry_of(trial.model)]
        return max(float(standing @ standing) - len(standing), 0.0) / len(self.engine.readings)

    def _about(self, members: tuple[Member, ...], fitted: Fitted) -> Trial:
        """Weigh members about their fit, and keep its linearisation."""
        known = [each.hypothesis for each in members if isinstance(each.hypothesis, Known)]
        for each in known:
            fitted = self.forms.laws.with_best_shape(fitted, each)
        linear = fitted.linear
        linear, found = self._with_forms(linear, fitted, [*self.present, *known])
        present = [(each.name, found[each]) for each in self.present]
        forms = [found[each.hypothesis] if isinstance(each.hypothesis, Known) else None for each in members]
        refused, penalty = outside_domain(fitted, [each.hypothesis for each in members], self.criteria)
        every = [*forms, *(form for _, form in present)]
        prior = sum(-0.5 * (form.fraction / self.criteria.form_sigma) ** 2 for form in every if form is not None)
        whole = Sums(linear, self.engine.readings, ()).whole
        change = whole.own_values()
        gain = 0.5 * float(whole.own @ whole.own)
        moved = self._keep(_key(members), linear, change)
        alike = gained_alike(moved, fitted, [each.hypothesis for each in members])
        return Trial(
            members=members,
            model=fitted.model,
            log_evidence=linear.log_evidence + gain + penalty + prior + alike,
            forms=tuple(forms),
            refused=refused,
            left=float(np.mean(moved.residual**2)),
            present=tuple(present),
        )

    def _with_forms(self, linear: Linear, fitted: Fitted, every: Sequence[Known]) -> tuple[Linear, dict[Known, Form]]:
        """Return a linearisation with the discrepancies of some effects, and these.

        What one effect's form leaves, that of one asked before it had to describe: a form larger than most, or too
        large to be one, is asked for again beside the others, until all stand beside those beside which they were
        found. A small one is left: asked again, a gain's took a free function of time.
        """
        forms: dict[Known, Form] = {}
        alone, asked = linear, dict[Known, list[tuple[str, ...]]]()
        for again in range(FORM_ROUNDS):
            for each in every:
                if again and forms[each].functions and forms[each].deviation <= self.criteria.form_sigma:
                    continue
                others = [other for other in forms if other is not each and forms[other].columns]
                functions = [forms[other].functions for other in others]
                if asked.get(each) == functions:
                    continue
                asked[each] = functions
                if again:  # its own columns stand among the others'
                    linear = alone
                    for other in others:
                        forms[other] = replace(forms[other], first=linear.own.shape[1])
                        linear = self.forms.with_columns(linear, forms[other])
                linear, forms[each] = self.forms.beside(linear, fitted, each)
        return linear, forms

    def _fitted(self, members: Sequence[Member], near: Trial | None = None) -> Fitted:
        """Fit the model of some members: from `near`, or from where it was fitted with all but the last if it was."""
        before = self._known.get(_key(members[:-1])) if len(members) > 1 else None
        return fitted(self.engine, members, before, near)

    def _beyond_formulas(self, trial: Trial) -> Floats | None:
        """Return what a trial's effects describe of each row beyond their formulas as fitted, in noise deviations.

        The functions of their forms, and by how much the formulas' values change beside these: the two together, as
        either takes from the other what both may say. A fit beside it need not describe it: a spike of three times the
        noise was held at zero by what the formula of a bow of thirty left.
        """
        if not any(trial.columns_of_forms()):
            return None
        about, linear = self.engine.linearised(trial.model).linear, self.linear(trial)
        change = linear.standing.copy()
        change[: len(about.standing)] -= about.standing
        of_effects = np.ones(len(change), bool)
        of_effects[: len(about.standing)] = ~self.engine.geometry_of(trial.model)
        pushed: Floats = linear.own[:, of_effects] @ change[of_effects]
        return pushed


def _key(members: Sequence[Member]) -> frozenset[str]:
    return frozenset(f"{each.hypothesis.name} {_prior(each)}" for each in members)


def _prior(member: Member) -> str:
    """Return what tells one prior of a learned function from another: splines, smoothness, size."""
    if not isinstance(member.hypothesis, Learned) or member.factor is None:
        return ""
    variable = member.hypothesis.variable
    return f"{variable.count} {variable.is_even} {np.sum(member.factor**2):.4g} {member.size_mm:.3g}"
