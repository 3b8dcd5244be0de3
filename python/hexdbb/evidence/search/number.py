"""The number in a function's name moved to where it fits best: a period, or the time that memory lasts.

A Fourier transform of a residual that geometry has bent to places a period within a tenth of a turn over all readings:
at a hundred times the noise that leaves several times the noise. One step of Gauss and Newton about the fit mends it.
Time constants are tried at a few values only, and move from there by several such steps of their logarithm.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from hexdbb.errors import RunError
from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.fit.trials import Trials
from hexdbb.evidence.linear.readings import Readings
from hexdbb.evidence.linear.screen import Hypothesis
from hexdbb.evidence.linear.signatures import signature_of
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.search.screened import add_kin
from hexdbb.learned import Learned, Variable, has_chosen_number, number_of
from hexdbb.learned.repeating import has_chosen_period, repeats_over
from hexdbb.learned.signs import rate_of

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

TURN_STEP = 0.02
"""Change of a period, in turns at the readings' ends, over which a function's change is taken: small against a turn,
large against the rounding of single precision."""
CONSTANT_STEP = 0.05
"""The same of a time constant, relative to it: a lag bends by its square, a thousandth."""
MOST_TURNING = 0.5
"""Largest transition rate of a change of sign, as a part of the rate's root mean square: at that rate it is over but
for a tenth. Beyond, a function would be in proportion to the rate, which a controller takes for one that switches."""
MOST_STEPS = 12.0
"""Such changes that a number may move by: a quarter of a turn, beyond which a line is no approximation of a wave, or a
factor of nearly two, from one of the constants first tried to the next."""


def best_number(trials: Trials, trial: Trial, member: Member) -> Learned:
    """Return the function of a trial's member with its number moved to where it fits best.

    Parameters
    ----------
    trials : Trials
    trial : Trial
    member : Member
        Of the trial, with a number that readings chose.
    """
    learned, readings, model = member.hypothesis, trials.engine.readings, trial.model
    assert isinstance(learned, Learned) and member.factor is not None
    variable, number = learned.variable, number_of(learned.variable)
    step = CONSTANT_STEP
    if has_chosen_period(variable):
        step = TURN_STEP * number / max(float(np.ptp(readings.state[repeats_over(variable)])), number)
    mine = np.array([each.effect == learned.name for each in model.parameters()])
    coefficients = member.factor @ model.values[mine]
    limits = readings.state.space(learned)
    ahead, behind = (
        signature_of(learned.with_number(number * (1.0 + part)), readings, limits).table @ coefficients
        for part in (step, -step)
    )
    linear = trials.linear(trial)
    column = 0.5 * (ahead - behind)
    wider = replace(linear, own=np.column_stack([linear.own, column]), standing=np.append(linear.standing, 0.0))
    moved = float(Sums(wider, readings, ()).whole.own_values()[-1])
    found = number * (1.0 + step * float(np.clip(moved, -MOST_STEPS, MOST_STEPS)))
    return learned.with_number(min(found, _most(readings, variable)))


def _most(readings: Readings, variable: Variable) -> float:
    """Return the largest number that a variable may have: that over which a direction turns is limited."""
    rate = rate_of(variable.times)
    return np.inf if rate is None else MOST_TURNING * float(np.sqrt(np.mean(np.square(readings.state[rate]))))


def with_best_number(search: Search, trial: Trial, hypothesis: Hypothesis) -> Trial:
    """Return a trial with the number of one of its hypotheses where it fits best; the same where that gains nothing."""
    if not isinstance(hypothesis, Learned) or not has_chosen_number(hypothesis.variable):
        return trial
    tuned = hypothesis
    is_period = has_chosen_period(hypothesis.variable)
    for _ in range(1 if is_period else search.criteria.constant_rounds):
        member = next(each for each in trial.members if each.hypothesis == tuned)
        moved = best_number(search.trials, trial, member)
        if moved.name != member.hypothesis.name and moved.name in trial.names:
            break  # another function of the set has this number already: at the limit two may meet
        search.count_as(moved, hypothesis)
        try:
            members = [replace(each, hypothesis=moved) if each is member else each for each in trial.members]
            found = search.trials.of(members, near=trial)
        except RunError:
            break
        if found.log_evidence <= trial.log_evidence or found.refused:
            break
        trial, tuned = found, moved
    if tuned != hypothesis and not is_period:
        # A gauge that settles within a tenth of a second is late by that: the same as one that is read late.
        add_kin(search, [tuned])
    return trial
