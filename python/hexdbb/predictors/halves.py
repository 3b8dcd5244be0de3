"""Two halves of the samples: what is fitted to one is tested on the other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.samples import Samples
from hexdbb.samples.distinct import distinct_rows

STRETCH = 4
"""Neighbouring samples that go to one half together: few, so that both halves hold every instant to a fraction of a
second; more than one, so that a sample is not tested on its two neighbours. The value is a compromise, not a limit."""


def stretches(count: int) -> NDArray[np.bool_]:
    """Return the second half where samples are dealt in order, `STRETCH` to either half in turn; shape (count,)."""
    second: NDArray[np.bool_] = (np.arange(count) // STRETCH) % 2 == 1
    return second


def halves(samples: Samples) -> NDArray[np.bool_]:
    """Return the second of two halves that hold the same circles, directions and feeds.

    Laps of one circle, direction and feed go to either half in turn. Where there is one lap only, stretches of
    `STRETCH` samples do: what is fitted to one half is then tested on readings with noise of their own.

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    group = distinct_rows(*(samples[name] for name in ("record", "circle", "feed_mm_s", "direction")))[1]
    turns, turn_of = distinct_rows(group, samples["sweep"], samples["lap"])
    group_of_turn = group[turns]
    place = np.arange(len(turns)) - np.searchsorted(group_of_turn, group_of_turn)
    alone = np.bincount(group_of_turn)[group_of_turn] == 1
    second: NDArray[np.bool_] = np.where(alone[turn_of], stretches(len(group)), place[turn_of] % 2 == 1)
    return second


def sampling_rate_hz(samples: Samples) -> float:
    """Return the usual number of samples a second (median)."""
    steps_s = np.diff(samples["time_s"])
    usual_s = float(np.median(steps_s[steps_s > 0.0])) if (steps_s > 0.0).any() else np.inf
    return 1.0 / usual_s
