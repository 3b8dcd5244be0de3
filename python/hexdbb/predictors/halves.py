"""Two halves of the samples: what is fitted to one is tested on the other."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.samples import Samples

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
    keys = np.column_stack([codes(samples[name]) for name in ("record", "circle", "feed_mm_s", "direction")])
    group = np.unique(keys, axis=0, return_inverse=True)[1].ravel()
    turn = np.column_stack([group, codes(samples["sweep"]), codes(samples["lap"])])
    turns, turn_of = np.unique(turn, axis=0, return_inverse=True)
    turn_of = turn_of.ravel()
    first = np.searchsorted(turns[:, 0], turns[:, 0])
    place = np.arange(len(turns)) - first
    alone = np.bincount(turns[:, 0])[turns[:, 0]] == 1
    second: NDArray[np.bool_] = np.where(alone[turn_of], stretches(len(group)), place[turn_of] % 2 == 1)
    return second


def sampling_rate_hz(samples: Samples) -> float:
    """Return the usual number of samples a second (median)."""
    steps_s = np.diff(samples["time_s"])
    usual_s = float(np.median(steps_s[steps_s > 0.0])) if (steps_s > 0.0).any() else np.inf
    return 1.0 / usual_s


def codes(values: NDArray[Any]) -> NDArray[np.intp]:
    """Return the number of each value among the distinct ones, counted from 0; shape (n,)."""
    return np.unique(values, return_inverse=True)[1].ravel()
