"""Which way a quantity moves, and how far it has come since it turned: what hysteresis depends on.

A gauge sticks and a bolted joint slips by what acts on them now and since it last turned over, at whatever rate.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.samples.loads import LOADS

Floats = NDArray[np.float64]

NOT_YET = 1e6
"""As the engine writes a travel since a reversal that has not been."""
TURNS_OF_LOADS = {f"{load}_{what}": load for load in ("leg_force", *LOADS) for what in ("direction", "since_turn")}
"""Columns of directions, and of changes since the load turned, each with the load that they follow from."""
LEAST_TURN_OF_LOAD = 1e-4
"""Per newton of vertical load: what comes back by that has turned. A hundred times the encoders' steps (0.1 µm of the
slider turn a leg of 400 mm by less than 1e-6), a thousandth of what a circle changes."""


def turns_of_load(
    load: str, values: Floats, time_s: Floats, sweep: NDArray[np.integer[Any]], angle_rad: Floats
) -> dict[str, Floats]:
    """Return the two columns of `TURNS_OF_LOADS` of a load, each shape (n, 6).

    Parameters
    ----------
    load : str
    values : ndarray, shape (n, 6)
    time_s, angle_rad : ndarray, shape (n,)
    sweep : ndarray of int, shape (n,)
    """
    found = [direction_and_travel(each, time_s, sweep, angle_rad, LEAST_TURN_OF_LOAD) for each in values.T]
    names = (f"{load}_direction", f"{load}_since_turn")
    return {name: np.column_stack(each) for name, each in zip(names, zip(*found, strict=True), strict=True)}


def direction_and_travel(
    values: Floats, time_s: Floats, sweep: NDArray[np.integer[Any]], angle_rad: Floats, least: float
) -> tuple[Floats, Floats]:
    """Return the direction in which a quantity moves, and its travel since it turned.

    Parameters
    ----------
    values, time_s, angle_rad : ndarray, shape (n,)
        Polar angles with or without their turns.
    sweep : ndarray of int, shape (n,)
    least : float
        It turns over where it has come back by that much from the farthest that it was: noise does not show in it.

    Returns
    -------
    direction : ndarray, shape (n,)
        +1, -1, 0 where it has moved neither in its sweep yet nor along the run-up.
    travel : ndarray, shape (n,)
        From the farthest that it was before; 1e6 where it has turned neither in its sweep yet nor along the run-up.
    """
    order = np.lexsort((time_s, sweep))
    found, since = np.zeros(len(values)), np.full(len(values), NOT_YET)
    for rows in np.split(order, np.flatnonzero(np.diff(sweep[order])) + 1):
        first, end, _ = _core.run_up(time_s[rows], angle_rad[rows])
        whole = np.concatenate([values[rows[first:end]], values[rows]])
        found[rows], since[rows] = (each[end - first :] for each in _turning(whole, least))
    return found, since


def _turning(values: Floats, least: float) -> tuple[Floats, Floats]:
    """Return direction and travel since the last turn, of one sweep in order of time."""
    found, since = np.zeros(len(values)), np.full(len(values), NOT_YET)
    direction, farthest, turned = 0.0, float(values[0]), None
    for place, value in enumerate(values.tolist()):
        ahead = value - farthest
        if abs(ahead) > least or ahead * direction > 0.0:
            if ahead * direction < 0.0:
                turned = farthest
            direction, farthest = float(np.sign(ahead)), value
        found[place] = direction
        if turned is not None:
            since[place] = abs(value - turned)
    return found, since
