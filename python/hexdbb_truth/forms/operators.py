"""Memories that mechanisms have: play, stiction, lag, presliding. Each takes a whole history at once.

Between two reversals each has a closed form, so that a history costs as many steps as it has reversals.
Source: play operator, Krasnosel'skii and Pokrovskii, Systems with Hysteresis (1989), chapter 1; Dahl's model, A solid
friction model, TOR-158 (1968), with exponent 1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy.signal import lfilter

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.history import Pieces

Release = Callable[[Array], Array]
"""Time since the breakaway, s, to what is left of it, 1 at first."""


def _slices(pieces: Pieces, n: int) -> Iterator[tuple[slice, float]]:
    ends = [*pieces.begin[1:].tolist(), n]
    for begin, end, sign in zip(pieces.begin.tolist(), ends, pieces.sign.tolist(), strict=True):
        yield slice(begin, end), sign


def lost_motion(at: Array, half_play: Array | float, pieces: Pieces) -> Array:
    """Return follower minus driver for a play of half width `half_play` (may vary along the way), shape of `at`."""
    half = np.broadcast_to(half_play, at.shape)
    follower, before = np.empty_like(at), float(at[0])
    for rows, sign in _slices(pieces, len(at)):
        reach = at[rows] - sign * half[rows]
        # Pushed along by the side of the play that moves towards it, never drawn back.
        pushed = np.maximum.accumulate(reach) if sign > 0.0 else np.minimum.accumulate(reach)
        follower[rows] = np.maximum(pushed, before) if sign > 0.0 else np.minimum(pushed, before)
        before = float(follower[rows][-1])
    return follower - at


def travel_since_reversal(at: Array, pieces: Pieces) -> Array:
    """Return how far `at` has moved since it last turned, at least 0."""
    travelled = np.empty_like(at)
    for rows, _ in _slices(pieces, len(at)):
        start = at[max(rows.start - 1, 0)]
        travelled[rows] = np.abs(at[rows] - start)
    return travelled


def windup(at: Array, time: Array, pieces: Pieces, breakaway: Array | float, release: Release) -> Array:
    """Return driver minus follower where the follower sticks at each reversal until `breakaway`, then is released.

    Parameters
    ----------
    at, time : (N,) arrays
    pieces : Pieces
    breakaway : float or (number of pieces,) array
        Windup at which it slides again, by piece.
    release : callable
        Share of the breakaway that is left so long after.
    """
    heights = np.broadcast_to(breakaway, pieces.sign.shape)
    path, left = np.zeros_like(at), 0.0
    for index, (rows, sign) in enumerate(_slices(pieces, len(at))):
        height = float(heights[index])
        if index == 0 or height == 0.0:
            continue
        start = at[rows.start - 1]
        wound = left + (at[rows] - start)
        loose = np.flatnonzero(wound * sign >= height)
        sticks = int(loose[0]) if len(loose) else len(wound)
        path[rows.start : rows.start + sticks] = wound[:sticks]
        if sticks < len(wound):
            since = time[rows.start + sticks : rows.stop] - time[rows.start + sticks]
            path[rows.start + sticks : rows.stop] = sign * height * release(since)
        left = float(path[rows.stop - 1])
    return path


def relay(values: Array, low: float, high: float) -> Array:
    """Return the state of a two-state element: 1 from where `values` exceed `high` until they fall below `low`, else 0.

    Source: the non-ideal relay, Krasnosel'skii and Pokrovskii, Systems with Hysteresis (1989), chapter 5.
    """
    state = np.where(values > high, 1.0, 0.0)
    known = (values > high) | (values < low)
    last = np.maximum.accumulate(np.where(known, np.arange(len(values)), 0))
    return np.asarray(state[last])


def pushed_ahead(at: Array, time: Array, back_mm_s: float, begin: float) -> Array:
    """Return a front that `at` pushes ahead of itself where it reaches it and that flows back evenly elsewhere.

    It lies at `begin`, or where `at` is if that is further, at first.
    """
    back = back_mm_s * (time - time[0])
    return np.asarray(np.maximum.accumulate(np.maximum(at + back, begin)) - back)


def lowpass(values: Array, dt: float, tau: float) -> Array:
    """Return a first-order lag of `values`, exact for values that stay from instant to instant; starts settled."""
    decay = float(np.exp(-dt / tau))
    filtered, _ = lfilter([1.0 - decay], [1.0, -decay], values, zi=[decay * values[0]])
    return np.asarray(filtered)


def presliding(at: Array, pieces: Pieces, stretch: float) -> Array:
    """Return Dahl's friction, -1 to 1: after a reversal it turns over within some times `stretch` of travel."""
    force, before = np.empty_like(at), 0.0
    for rows, sign in _slices(pieces, len(at)):
        start = at[max(rows.start - 1, 0)]
        force[rows] = sign + (before - sign) * np.exp(-np.abs(at[rows] - start) / stretch)
        before = float(force[rows][-1])
    return force
