"""The period of a function that repeats, right to a hundredth of a turn over all readings.

A Fourier transform of a residual that geometry has bent to places a period within a tenth of a turn over all readings:
at a hundred times the noise that leaves several times the noise. One step of Gauss and Newton about the fit mends it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hexdbb.evidence.signatures import signature_of
from hexdbb.evidence.sums import Sums
from hexdbb.evidence.trial import Member, Trial, Trials
from hexdbb.learned import Learned, with_period

TURN_STEP = 0.02
"""Change of a period, in turns at the readings' ends, over which a function's change is taken: small against a turn,
large against the rounding of single precision."""
MOST_STEPS = 12.0
"""Such changes that a period may move by: a quarter of a turn, beyond which a line is no approximation of a wave."""


def best_period(trials: Trials, trial: Trial, member: Member) -> Learned:
    """Return the periodic function of a trial's member with its period moved to where it fits best.

    Parameters
    ----------
    trials : Trials
    trial : Trial
    member : Member
        Of the trial, with a period that readings chose.
    """
    learned, readings, model = member.hypothesis, trials.engine.readings, trial.model
    assert isinstance(learned, Learned) and member.factor is not None
    variable = learned.variable
    step = TURN_STEP * variable.period / max(float(np.ptp(readings.state[variable.column])), variable.period)
    mine = np.array([each.effect == learned.name for each in model.parameters()])
    coefficients = member.factor @ model.values[mine]
    ahead, behind = (
        signature_of(_with_period(learned, 1.0 + part), readings).table @ coefficients for part in (step, -step)
    )
    linear = trials.linear(trial)
    column = 0.5 * (ahead - behind)
    wider = replace(linear, own=np.column_stack([linear.own, column]), standing=np.append(linear.standing, 0.0))
    moved = float(Sums(wider, readings, ()).whole.own_values()[-1])
    return _with_period(learned, 1.0 + step * float(np.clip(moved, -MOST_STEPS, MOST_STEPS)))


def _with_period(learned: Learned, times: float) -> Learned:
    return replace(learned, variable=with_period(learned.variable, learned.variable.period * times))
