"""Prediction of what was left out: circles, feeds, directions and laps in turn, each from all others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hexdbb.evidence.covered import is_covered
from hexdbb.evidence.readings import ARC, GROUPINGS
from hexdbb.evidence.sums import Sums, squared_error
from hexdbb.evidence.trial import Trial, Trials


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


def heldout(trial: Trial, base: Trial, trials: Trials) -> dict[str, HeldOut]:
    """Predict every group from all others, to first order about the fits; by grouping that has two groups or more.

    A free function of time claims what lies between readings: arcs of every circle are left out besides. A group in
    whose range of a learned function's variable hardly any other reading lies is not predicted, nor claimed to be.
    """
    readings = trials.engine.readings
    groupings = (*GROUPINGS, ARC) if trial.is_free_in_time else GROUPINGS
    before, after = (Sums(trials.linear(each), readings, groupings) for each in (base, trial))
    found = {}
    for grouping in groupings:
        groups = before.groups(grouping)
        if len(groups) < 2:
            continue
        numbers = readings.groups[grouping]
        hypotheses = [each.hypothesis for each in trial.members]
        # Arcs are what free functions of time claim, whatever lies between.
        inside = [grouping == ARC or is_covered(hypotheses, readings, numbers == each) for each in np.unique(numbers)]
        groups = [each for each, is_inside in zip(groups, inside, strict=True) if is_inside]
        rows = sum(float(before.rows[cells].sum()) for cells in groups)
        if not groups:
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
