"""Which groups a set of hypotheses claims to predict: those in whose range of its variables other readings lie."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.linear.readings import Readings
from hexdbb.learned import Learned

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]

COVERED_PART = 0.5
"""Part of a group's readings that must lie within the range of the others: a function of the acceleration, learned at
12 mm/s, says nothing of most accelerations at 50 mm/s; one of the position says nearly all of a circle beside it. A
function of time must have readings on both sides nearer than its splines: the one direction between the other."""


def is_covered(hypotheses: Iterable[object], readings: Readings, in_group: Bools) -> bool:
    """Check that what learned functions say of a group can be learned from the other readings.

    Parameters
    ----------
    hypotheses : iterable of Known or Learned
        A formula extrapolates, only learned functions do not.
    readings : Readings
    in_group : ndarray of bool, shape (n,)
    """
    return all(_is_covered_once(each, readings, in_group) for each in hypotheses if isinstance(each, Learned))


def _is_covered_once(learned: Learned, readings: Readings, in_group: Bools) -> bool:
    """Return the same of one function, asked once: every set that holds it is."""
    key = (learned, in_group.tobytes())
    if key not in readings.covered:
        readings.covered[key] = _is_covered(learned, readings, in_group)
    return readings.covered[key]


def _is_covered(learned: Learned, readings: Readings, in_group: Bools) -> bool:
    space = readings.state.space(learned)
    if space.period or (learned.variable.count == 1 and not learned.variable.instants):
        return True
    covered = total = 0
    for element in learned.elements:
        values = space.argument(readings.state, element)
        known = np.isfinite(values)
        others, own = np.sort(values[known & ~in_group]), values[known & in_group]
        if len(others):
            covered += int(np.count_nonzero(_has_others(own, others, space.interval if learned.is_of_time else np.inf)))
        total += len(own)
    return covered >= COVERED_PART * total


def _has_others(own: Floats, others: Floats, within: float) -> Bools:
    """Return which values have other ones on both sides, the nearer one no farther than so much."""
    at = np.clip(np.searchsorted(others, own), 1, max(len(others) - 1, 1))
    below, above = others[at - 1], others[np.minimum(at, len(others) - 1)]
    between = (own >= others[0]) & (own <= others[-1])
    found: Bools = between & (np.minimum(np.abs(own - below), np.abs(own - above)) <= within)
    return found
