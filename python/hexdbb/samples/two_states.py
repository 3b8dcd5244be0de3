"""Columns of two states, as `leg_force.relay@7.1/14.5`: what snaps over at one value of a column, and back at a lower.

The column may be a vector's part along a direction: `position_mm.along@35.relay@-8/11`.

+1 once the column has risen to the higher of two numbers, -1 once it has fallen to the lower; between them the state
that it came with.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.samples.over_time import followed, sweeps_of

Floats = NDArray[np.float64]

NUMBER = r"-?[0-9.]+(?:e[+-]?[0-9]+)?"
RELAY = re.compile(rf"(?P<column>\w+(?:\.along@{NUMBER})?)\.relay@(?P<low>{NUMBER})/(?P<high>{NUMBER})")


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
        Times rise within a sweep; polar angles with or without their turns.
    """
    values = np.asarray(column, np.float64).reshape(len(column), -1)
    found = followed(lambda _, given: two_states(given, low, high), values, time_s, sweeps_of(sweep), angle_rad)
    return found.reshape(column.shape)


def two_states(values: Floats, low: float | Floats, high: float | Floats) -> Floats:
    """Return the states of relays over values in order of time, shape (n, k); before the first change the other one."""
    towards = (values >= high).astype(np.int8) - (values <= low).astype(np.int8)
    rows = np.arange(len(values))[:, None]
    last = np.maximum.accumulate(np.where(towards != 0, rows, -1), axis=0)
    first = np.take_along_axis(towards, np.argmax(towards != 0, axis=0)[None, :], axis=0)
    return np.where(last >= 0, np.take_along_axis(towards, np.maximum(last, 0), axis=0), -first).astype(np.float64)
