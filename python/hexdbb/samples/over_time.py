"""What follows a column over time, from sweep to sweep.

What the machine did between two sweeps no record says: it is taken to have run out along the circle and up along the
next one, as it came round in other laps, and to have gone evenly from the one to the other, or to have waited where the
next run-up begins. Before the first sweep it stood.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core

Floats = NDArray[np.float64]
Waiting = Callable[[Floats], Floats]
STOPS_S = 0.01
"""Time in which a machine goes to the state in which it waits: a hundredth of any time constant that is asked for."""
FAR_RUN_UP_RAD = np.pi
"""Angle along which ball-bar tests run up to a circle that overshoot by half a circle, the usual setting of their
makers' programs; the engine's RUN_UP_RAD stands where nothing else is said."""


def sweeps_of(sweep: NDArray[np.integer[Any]]) -> list[slice]:
    """Return the rows of each sweep, of numbers that rise from sweep to sweep, shape (n,)."""
    begins = np.flatnonzero(np.diff(sweep, prepend=sweep[0] - 1))
    return [slice(*ends) for ends in zip(begins, np.append(begins[1:], len(sweep)), strict=True)]


def followed(
    follow: Callable[[Floats, Floats], Floats],
    values: Floats,
    time_s: Floats,
    sweeps: Sequence[slice],
    angle_rad: Floats,
    run_up_rad: float = _core.RUN_UP_RAD,
    waiting: Waiting | None = None,
) -> Floats:
    """Return what follows values over time, shape (n, k).

    Parameters
    ----------
    follow : callable
        Of times, shape (m,), and values there, shape (m, k), from the first sweep of a record to its last, with those
        between the sweeps: what follows them, shape (m, k).
    values : ndarray, shape (n, k)
    time_s, angle_rad : ndarray, shape (n,)
        Times rise within a sweep; polar angles with or without their turns.
    sweeps : sequence of slice
        Rows of each.
    run_up_rad : float
        Of every sweep; as far it runs out.
    waiting : callable, optional
        Of the values where the next run-up begins, shape (k,): those while the machine waits there, from the end of
        the run-out on. Where not given, values go evenly from the one to the other.
    """
    found = np.empty_like(values)
    for chain in _chains(sweeps, time_s):
        at_s, given = _joined(
            [_way(time_s[rows], angle_rad[rows], values[rows], run_up_rad) for rows in chain], waiting
        )
        whole = follow(at_s, given)
        for rows in chain:
            found[rows] = whole[np.searchsorted(at_s, time_s[rows])]
    return found


def _chains(sweeps: Sequence[slice], time_s: Floats) -> list[list[slice]]:
    """Return the sweeps of each stretch of time: with every record it begins anew."""
    found = [[sweeps[0]]]
    for before, rows in pairwise(sweeps):
        if time_s[rows.start] > time_s[before.stop - 1]:
            found[-1].append(rows)
        else:
            found.append([rows])
    return found


@dataclass(frozen=True)
class _Way:
    """A sweep: times and values of its samples, of the run-up before them and of the run-out behind."""

    at_s: Floats
    values: Floats
    up_s: Floats
    up: Floats
    out_s: Floats
    out: Floats


def _way(time_s: Floats, angle_rad: Floats, values: Floats, run_up_rad: float) -> _Way:
    """Return a sweep with run-up and run-out, as it came round a lap later and before; none of less than a lap."""
    first, end, lap_s = _core.run_up(time_s, angle_rad, run_up_rad)
    # Seen from its end, a sweep runs out as it was run up to.
    behind, from_end, _ = _core.run_up(-time_s[::-1], angle_rad[::-1], run_up_rad)
    up, out = slice(first, end), slice(len(time_s) - from_end, len(time_s) - behind)
    return _Way(
        at_s=time_s,
        values=values,
        up_s=time_s[up] - lap_s,
        up=values[up],
        out_s=time_s[out] + lap_s,
        out=values[out],
    )


def _joined(ways: Sequence[_Way], waiting: Waiting | None) -> tuple[Floats, Floats]:
    """Return times and values of all, where there is time between two sweeps with the run-out and the run-up."""
    times, values = [ways[0].up_s], [ways[0].up]
    for way, following in zip(ways, (*ways[1:], None), strict=True):
        times.append(way.at_s)
        values.append(way.values)
        if following is None:
            break
        left, begins = np.max(way.out_s, initial=way.at_s[-1]), np.min(following.up_s, initial=following.at_s[0])
        if left < begins:
            times.append(way.out_s)
            values.append(way.out)
            if waiting is not None and left + STOPS_S < begins:
                times.append(np.array([left + STOPS_S, begins]))
                first = following.up[:1] if len(following.up) else following.values[:1]
                values.append(np.repeat(waiting(first), 2, axis=0))
            times.append(following.up_s)
            values.append(following.up)
    return np.concatenate(times), np.vstack(values)
