"""Columns that follow others by a number: `leg_force.lagged@12`, `leg_force.relaxing@12`, `time_in_sweep_s.after@45`.

Rubber yields late, grease and warmth follow slowly: what acts is a state as it was some time before. The lag is of
first order, y' = (x - y) / tau, x linear between samples; what relaxes is x - y. Between two sweeps it follows what the
machine is taken to have done (`over_time.py`). A time after a run-up of some degrees is one to which is added what
these take at the rate at which the circle is driven. What is `along` so many degrees is a vector's part along that
direction in the base's x-y plane, and `cosine` and `sine` are those of a position's phase in a period. What is
`slipping` follows a change until it is so far from where it would rest, and
slips beyond: an elastic contact with friction. What is `turning` is the sign of a rate, which is smoothed at zero:
rate / sqrt(rate² + number²), as regularised Coulomb friction is. What is `heated` is the first-order lag of a speed,
whichever way it goes, that is zero while the machine waits: friction heats in proportion to it, and air cools.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.samples.over_time import FAR_RUN_UP_RAD, followed, sweeps_of

Floats = NDArray[np.float64]

FAR = "180"
"""Behind `lagged`, `relaxing` or `slipping`: every circle is run up to along so many degrees."""
HOW = rf"(?:lagged|relaxing|slipping)(?:{FAR})?|after|along|turning|cosine|sine|heated"
NAME = re.compile(rf"(?P<column>\w+)\.(?P<how>{HOW})@(?P<constant>[0-9.e+-]+)")
PHASES = {"cosine": np.cos, "sine": np.sin}
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
        `lagged`, `relaxing`, `slipping`, with `FAR` behind it or not, `after`, `along`, `turning`, `cosine`, `sine` or
        `heated`.
    constant : float
        Its time constant, s; of `after` the run-up, of `along` the direction, degrees; of `slipping` the farthest that
        it yields, in the column's unit; of `turning` a rate; of `cosine` and `sine` the period.
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
    if how in PHASES:
        return np.asarray(PHASES[how](2.0 * np.pi * values / constant).reshape(column.shape))
    if how == "heated":
        speed = np.abs(values)
        cold = np.zeros(speed.shape[1])
        return lingering(speed, constant, cold, time_s, sweep, angle_rad, from_standing=True).reshape(column.shape)
    sweeps = sweeps_of(sweep)
    if how == "after":
        run_up_s = [np.radians(constant) / _rate_rad_s(time_s[rows], angle_rad[rows]) for rows in sweeps]
        added = np.repeat(run_up_s, [rows.stop - rows.start for rows in sweeps])
        return np.asarray((values + added[:, None]).reshape(column.shape))
    kind, run_up_rad = how.removesuffix(FAR), FAR_RUN_UP_RAD if how.endswith(FAR) else _core.RUN_UP_RAD

    def follow(at_s: Floats, given: Floats) -> Floats:
        if kind == "slipping":
            return _slipping(given, constant)
        return _lagged(given, (at_s - at_s[0]) / constant, given[0])

    followed_by = followed(follow, values, time_s, sweeps, angle_rad, run_up_rad)
    found: Floats = values - followed_by if kind == "relaxing" else followed_by
    return found.reshape(column.shape)


def lingering(
    values: Floats,
    constant_s: float,
    standing: Floats | None,
    time_s: Floats,
    sweep: NDArray[np.integer[Any]],
    angle_rad: Floats,
    *,
    from_standing: bool = False,
) -> Floats:
    """Return what is left of values that linger: a first-order lag of them, of their shape (n,) or (n, k).

    A nut that its travel heats, a bar that a fan cools on one side: what acts is a function of a state, and dies away.
    `standing`, shape (k,), are those values while the machine waits between two sweeps; those where the next run-up
    begins if not given. Before the first sweep it moved as it then does, for long, or it stood (`from_standing`): of
    three records of nuts and motors one was better said by the former, one by the latter, one by either; what is in
    proportion to heat is quite another from a cold start, and was cold on the one record that has it.
    """
    given = values.reshape(len(values), -1)

    def follow(at_s: Floats, what: Floats) -> Floats:
        start = what[0] if standing is None or not from_standing else np.ravel(standing)
        return _lagged(what, (at_s - at_s[0]) / constant_s, start)

    def waiting(next_up: Floats) -> Floats:
        return next_up if standing is None else np.reshape(standing, (1, -1))

    found = followed(follow, given, time_s, sweeps_of(sweep), angle_rad, waiting=waiting)
    return found.reshape(values.shape)


def _rate_rad_s(time_s: Floats, angle_rad: Floats) -> float:
    """Return at what rate a circle is driven; infinity for one sample."""
    turned_rad, took_s = float(np.ptp(np.unwrap(angle_rad))), float(np.ptp(time_s))
    return turned_rad / took_s if turned_rad * took_s > 0.0 else float("inf")


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


def _slipping(values: Floats, most: float) -> Floats:
    """Return what values, shape (n, k), strain at most so far before it slips, from rest: Prandtl's stop operator.

    e' = clip(e + dx, -most, most), step by step. Two steps make one of the same kind, clip(e + a, low, high), so that
    all are found by doubling (prefix sums of a semigroup; Blelloch 1990).
    """
    moved = np.diff(values, axis=0, prepend=values[:1])
    low, high = np.full_like(moved, -most), np.full_like(moved, most)
    reach = 1
    while reach < len(moved):
        ahead, before_low, before_high = moved[:-reach], low[:-reach], high[:-reach]
        later, least, largest = moved[reach:], low[reach:], high[reach:]
        new = ahead + later, np.clip(before_low + later, least, largest), np.clip(before_high + later, least, largest)
        moved, low, high = (
            np.concatenate([old[:reach], made]) for old, made in zip((moved, low, high), new, strict=True)
        )
        reach *= 2
    return np.clip(moved, low, high)
