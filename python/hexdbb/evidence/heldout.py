"""Prediction of what was left out: circles, feeds, directions and laps in turn, each from all others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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

    A free function of time claims what lies between readings: arcs of every circle are left out besides.
    """
    readings = trials.engine.readings
    groupings = (*GROUPINGS, ARC) if trial.is_free_in_time else GROUPINGS
    before, after = (Sums(trials.linear(each), readings, groupings) for each in (base, trial))
    found, rows = {}, len(readings)
    for grouping in groupings:
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
