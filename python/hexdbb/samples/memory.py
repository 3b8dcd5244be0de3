"""Columns that follow others by a number: `leg_force.lagged@12`, `leg_force.relaxing@12`, `time_in_sweep_s.after@45`.

Rubber yields late, grease and warmth follow slowly: what acts is a state as it was some time before. The lag is of
first order, y' = (x - y) / tau, x linear between samples; what relaxes is x - y. What the machine did between two
sweeps no record says: it is taken to have run out along the circle and up along the next one, as it came round in other
laps, and to have gone evenly from the one to the other. Before the first sweep it stood. A time after a run-up of some
degrees is one to which is added what these take at the rate at which the circle is driven. What is `along` so many
degrees is a vector's part along that direction in the base's x-y plane. What is `turning` is the sign of a rate, which
is smoothed at zero: rate / sqrt(rate² + number²), as regularised Coulomb friction is. What is a `relay` has two states:
+1 once a column has risen to the higher of two numbers, -1 once it has fallen to the lower, between them the state that
it came with.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

NAME = re.compile(r"(?P<column>\w+)\.(?P<how>lagged|relaxing|after|along|turning)@(?P<constant>[0-9.e+-]+)")
NUMBER = r"-?[0-9.]+(?:e[+-]?[0-9]+)?"
RELAY = re.compile(rf"(?P<column>\w+)\.relay@(?P<low>{NUMBER})/(?P<high>{NUMBER})")
RUN_UP_RAD = np.pi / 4.0
"""Angle along which a circle is run up to before it is captured, where its plan says nothing else."""
LONGEST = 30.0
"""Time constants in one block of a recursion that is summed at once: e to the 30th is far from the largest number."""


def remembered_of(name: str) -> re.Match[str] | None:
    """Return the parts of the name of a column that remembers another; None where it is not of that kind."""
    return NAME.fullmatch(name)


def remembered_column(
    how: str,
    constant: float,
    column: Floats,
    time_s: Floats,
    sweep: NDArray[np.integer[Any]],
    angle_rad: Floats,
) -> Floats:
    """Return a column that remembers another one, of the same shape, or what of it is along a direction, shape (n,).

    Parameters
    ----------
    how : str
        `lagged`, `relaxing`, `after`, `along` or `turning`.
    constant : float
        Its time constant, s; of `after` the run-up, of `along` the direction, degrees; of `turning` a rate.
    column : ndarray, shape (n,) or (n, k)
    time_s, angle_rad : ndarray, shape (n,)
        Times rise within a sweep; polar angles with or without their turns.
    sweep : ndarray of int, shape (n,)
    """
    values = np.asarray(column, np.float64).reshape(len(column), -1)
    if how == "along":
        return np.asarray(values[:, :2] @ np.array([np.cos(np.radians(constant)), np.sin(np.radians(constant))]))
    if how == "turning":
        return np.asarray((values / np.hypot(values, constant)).reshape(column.shape))
    sweeps = _sweeps(sweep)
    if how == "after":
        run_up_s = [np.radians(constant) / _rate_rad_s(time_s[rows], angle_rad[rows]) for rows in sweeps]
        added = np.repeat(run_up_s, [rows.stop - rows.start for rows in sweeps])
        return np.asarray((values + added[:, None]).reshape(column.shape))
    lagged = _followed(
        lambda at_s, given: _lagged(given, (at_s - at_s[0]) / constant, given[0]), values, time_s, sweeps, angle_rad
    )
    found: Floats = lagged if how == "lagged" else values - lagged
    return found.reshape(column.shape)


def relay_of(name: str) -> re.Match[str] | None:
    """Return the parts of the name of a column of two states; None where it is not of that kind."""
    return RELAY.fullmatch(name)


def relay_column(
    low: float,
    high: float,
    column: Floats,
    time_s: Floats,
    sweep: NDArray[np.integer[Any]],
    angle_rad: Floats,
) -> Floats:
    """Return the state of a relay, of a column's shape: +1, -1, or 0 where the column reaches neither number.

    Parameters
    ----------
    low, high : float
        In the column's unit.
    column : ndarray, shape (n,) or (n, k)
    time_s, sweep, angle_rad : ndarray, shape (n,)
        As of `remembered_column`.
    """
    values = np.asarray(column, np.float64).reshape(len(column), -1)
    found = _followed(lambda _, given: two_states(given, low, high), values, time_s, _sweeps(sweep), angle_rad)
    return found.reshape(column.shape)


def two_states(values: Floats, low: float | Floats, high: float | Floats) -> Floats:
    """Return the states of relays over values in order of time, shape (n, k); before the first change the other one."""
    towards = (values >= high).astype(np.int8) - (values <= low).astype(np.int8)
    rows = np.arange(len(values))[:, None]
    last = np.maximum.accumulate(np.where(towards != 0, rows, -1), axis=0)
    first = np.take_along_axis(towards, np.argmax(towards != 0, axis=0)[None, :], axis=0)
    return np.where(last >= 0, np.take_along_axis(towards, np.maximum(last, 0), axis=0), -first).astype(np.float64)


def _sweeps(sweep: NDArray[np.integer[Any]]) -> list[slice]:
    begins = np.flatnonzero(np.diff(sweep, prepend=sweep[0] - 1))
    return [slice(*ends) for ends in zip(begins, np.append(begins[1:], len(sweep)), strict=True)]


def _followed(
    follow: Callable[[Floats, Floats], Floats],
    values: Floats,
    time_s: Floats,
    sweeps: Sequence[slice],
    angle_rad: Floats,
) -> Floats:
    """Return what follows values over time, between the sweeps too: of times (m,) and values (m, k) there."""
    found = np.empty_like(values)
    for chain in _chains(sweeps, time_s):
        at_s, given = _joined([_way(time_s[rows], angle_rad[rows], values[rows]) for rows in chain])
        whole = follow(at_s, given)
        for rows in chain:
            found[rows] = whole[np.searchsorted(at_s, time_s[rows])]
    return found


def _rate_rad_s(time_s: Floats, angle_rad: Floats) -> float:
    """Return at what rate a circle is driven; infinity for one sample."""
    turned_rad, took_s = float(np.ptp(np.unwrap(angle_rad))), float(np.ptp(time_s))
    return turned_rad / took_s if turned_rad * took_s > 0.0 else float("inf")


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


def _way(time_s: Floats, angle_rad: Floats, values: Floats) -> _Way:
    """Return a sweep with run-up and run-out, as it came round a lap later and before; none of less than a lap."""
    turned = np.abs(np.unwrap(angle_rad) - angle_rad[0])
    lap, back = np.searchsorted(turned, [2.0 * np.pi, turned[-1] - 2.0 * np.pi])
    first, last = np.searchsorted(turned, [2.0 * np.pi - RUN_UP_RAD, turned[-1] - 2.0 * np.pi + RUN_UP_RAD])
    if turned[-1] < 2.0 * np.pi:
        first = lap = back = last = 0
    lap = min(int(lap), len(turned) - 1)
    up, out = slice(first, lap), slice(back + 1, last)
    return _Way(
        at_s=time_s,
        values=values,
        up_s=time_s[up] - time_s[lap] + time_s[0],
        up=values[up],
        out_s=time_s[out] - time_s[back] + time_s[-1],
        out=values[out],
    )


def _joined(ways: Sequence[_Way]) -> tuple[Floats, Floats]:
    """Return times and values of all, where there is time between two sweeps with the run-out and the run-up."""
    times, values = [ways[0].up_s], [ways[0].up]
    for way, following in zip(ways, (*ways[1:], None), strict=True):
        times.append(way.at_s)
        values.append(way.values)
        if following is None:
            break
        left, begins = np.max(way.out_s, initial=way.at_s[-1]), np.min(following.up_s, initial=following.at_s[0])
        if left < begins:
            times += [way.out_s, following.up_s]
            values += [way.out, following.up]
    return np.concatenate(times), np.vstack(values)


def _lagged(values: Floats, at: Floats, start: Floats) -> Floats:
    """Return the lag of values, shape (n, k), from a state on; `at` is the time in time constants, shape (n,)."""
    steps = np.maximum(np.diff(at), 0.0)[:, None]
    part = -np.expm1(-steps)
    # The exact response to a line from one sample to the next.
    ramp = np.where(steps > 1e-6, 1.0 - part / np.maximum(steps, 1e-12), 0.5 * steps)
    added = values[:-1] * (part - ramp) + values[1:] * ramp
    found = np.empty_like(values)
    found[0] = state = start
    first = 0
    while first < len(added):
        last = max(int(np.searchsorted(at, at[first] + LONGEST, "right")) - 1, first + 1)
        grown = np.exp(np.minimum(at[first + 1 : last + 1] - at[first], 2.0 * LONGEST))[:, None]
        found[first + 1 : last + 1] = (state + np.cumsum(added[first:last] * grown, axis=0)) / grown
        state, first = found[last], last
    return found
