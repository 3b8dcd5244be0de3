"""Prediction of what was left out: circles, feeds, directions and laps in turn, each from all others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.fit.formula import left_by_formulas
from hexdbb.evidence.fit.trial import Trial
from hexdbb.evidence.fit.trials import Trials
from hexdbb.evidence.linear.covered import is_covered
from hexdbb.evidence.linear.readings import ARC, GROUPINGS, Readings
from hexdbb.evidence.linear.sums import Sums, squared_error
from hexdbb.learned import Learned

Group = tuple[int, NDArray[np.intp]]
"""Number of a group and its cells."""


@dataclass(frozen=True)
class HeldOut:
    """Prediction of groups left out, in noise standard deviations.

    `before` and `after` are RMS errors without and with the hypotheses, `share` the part explained of what is beyond
    the noise, `expected` the RMS error that the fit to the other groups expects of itself. `as_fitted` is `after` where
    the functions of forms predict what they cover, wherever they lead.
    """

    before: float
    after: float
    share: float
    expected: float
    as_fitted: float


def first_error(trial: Trial, base: Trial, trials: Trials) -> float:
    """Return the error of the first grouping that a set claims to predict, as `heldout` has it; nan where of none.

    A grouping that lies outside what the others determine, by what the fit expects of itself, tells one set of splines
    from another by chance only: the next is asked, and the first where all do.
    """
    first = float("nan")
    for grouping in _groupings(trial):
        if trial.is_of_time and grouping != ARC:
            continue
        if found := heldout(trial, base, trials, (grouping,)):
            if found[grouping].expected <= trials.criteria.extrapolates:
                return found[grouping].after
            first = found[grouping].after if np.isnan(first) else first
    return first


def heldout(trial: Trial, base: Trial, trials: Trials, groupings: tuple[str, ...] | None = None) -> dict[str, HeldOut]:
    """Predict every group from all others, to first order about the fits; by grouping that has two groups or more.

    A free function of time claims what lies between readings: arcs of every circle are left out besides. A group in
    whose range of a learned function's variable hardly any other reading lies is not predicted, nor claimed to be.
    """
    readings = trials.engine.readings
    groupings = groupings or _groupings(trial)
    before, after = trials.sums(base, groupings), trials.sums(trial, groupings)
    found = {}
    for grouping in groupings:
        numbers = readings.groups[grouping]
        groups = list(zip(np.unique(numbers), before.groups(grouping), strict=True))
        if len(groups) < 2:
            continue
        groups = _claimed(trial, readings, grouping, groups)
        rows = sum(float(before.rows[cells].sum()) for _, cells in groups)
        if not groups:
            continue
        without = error = as_fitted = expected = 0.0
        with_form = len(trial.members) <= 1 and not is_its_formula(trial, base, trials)
        for number, cells in groups:
            in_group = numbers == number
            without += _errors(before, base, cells, in_group)[0]
            least, fitted = _errors(after, trial, cells, in_group, with_form=with_form)
            error, as_fitted = error + least, as_fitted + fitted
            expected += after.without(cells).expected_error(after, cells)
        share = (without - error) / max(without - rows, 1e-9)
        found[grouping] = HeldOut(
            before=float(np.sqrt(without / rows)),
            after=float(np.sqrt(error / rows)),
            share=share,
            expected=float(np.sqrt(expected / rows)),
            as_fitted=float(np.sqrt(as_fitted / rows)),
        )
    return found


def contradiction(trial: Trial, trials: Trials, grouping: str) -> float:
    """Return how much each group contradicts the fit to the other groups, per fitted value that the group determines.

    This is the squared distance between the two sets of values in standard deviations, as they are with all that the
    fit leaves: what it leaves of a form displaces values as noise does. It is about 1 by chance, even where the other
    groups determine the values badly.
    """
    numbers, sums = trials.engine.readings.groups[grouping], trials.sums(trial, _groupings(trial))
    groups = list(zip(np.unique(numbers), sums.groups(grouping), strict=True))
    found = [
        (*sums.without(cells).contradiction(sums, cells), float(sums.rows[cells].sum()))
        for _, cells in _claimed(trial, trials.engine.readings, grouping, groups)
    ]
    squared, determined, rows = (sum(column) for column in zip(*found, strict=True))
    return float((squared - rows * trial.left) / max(determined, 1e-9) / max(trial.left, 1.0))


def _groupings(trial: Trial) -> tuple[str, ...]:
    return (*GROUPINGS, ARC) if trial.is_free_in_time else GROUPINGS


def _claimed(trial: Trial, readings: Readings, grouping: str, groups: list[Group]) -> list[Group]:
    """Return the groups that a trial claims to predict.

    A known effect whose form is off claims what the functions of its form cover: how it goes on from there is in none
    of the other readings. Where they cover no group at all, its formula is asked.
    """
    # Arcs are what free functions of time claim, whatever lies between.
    if grouping == ARC:
        return groups
    numbers = readings.groups[grouping]
    learned = [each.hypothesis for each in trial.members]
    formed = [Learned.parse(name) for form, _ in trial.columns_of_forms() for name in form.functions]
    claimed = [each for each in groups if is_covered(learned, readings, numbers == each[0])]
    covered = [each for each in claimed if is_covered(formed, readings, numbers == each[0])]
    return covered or claimed


def is_its_formula(trial: Trial, base: Trial, trials: Trials) -> bool:
    """Check that the formula of what a trial adds explains nearly all: that is what it claims of other readings."""
    if not trial.members:
        return False
    left = left_by_formulas(trial.forms, trials.linear(trial))
    return base.left - left >= trials.criteria.form_explains * (base.left - 1.0)


def _errors(
    sums: Sums, trial: Trial, cells: NDArray[np.intp], in_group: NDArray[np.bool_], *, with_form: bool = True
) -> tuple[float, float]:
    """Return the sums of squared errors of a fit to all other cells in the cells of a group: the least, and as fitted.

    Of several causes each known effect claims what its formula predicts, or with the functions of its form: other
    circles hardly say how those of one go on beside the others, and functions that follow them lead away. So does one
    whose formula explains nearly all. Else alone (`with_form`), and as fitted, they may do so only where hardly any
    other reading lies in the range of their variable.
    """
    training = sums.without(cells)
    least = fitted = squared_error(sums, cells, training.own_values(), None, None)
    dropped = np.empty(0, np.intp)
    for form, columns in trial.columns_of_forms():
        covers = is_covered((Learned.parse(name) for name in form.functions), sums.readings, in_group)
        if covers and with_form:
            continue
        fewer = np.concatenate([dropped, np.arange(columns.start, columns.stop)])
        alone = squared_error(sums, cells, training.own_values_without(sums, fewer), None, None)
        if alone < least:
            dropped, least = fewer, alone
            fitted = fitted if covers else min(fitted, alone)
    return least, fitted
