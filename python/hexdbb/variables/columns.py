"""Every sample beside its residual, and what state the machine was in: one column each.

Columns of the record are taken as they are; those of the state (velocities, reversals) are handed in, as prediction
derives them. Where a column is not known for all records it is left out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.record import Record

FloatArray = NDArray[np.float64]
Columns = dict[str, NDArray[Any]]
State = Mapping[str, NDArray[Any]]
"""Columns of a record's state by name, (n,) or (n, 6); `hexdbb.prediction.samples_of` gives them as `.state`."""

UM_PER_MM = 1e3
SLIDERS = range(1, 7)
STRETCH = 4
PER_SLIDER = {"velocity_mm_s": "v{}_mm_s", "since_reversal_s": "since_reversal{}_s", "travel_direction": "side{}"}
"""State that has a column a slider, and what it is called here; `side` is where the slider last moved to, +1 or -1."""


def sample_columns(
    records: Sequence[Record], names: Sequence[str], predicted_mm: Sequence[FloatArray], states: Sequence[State]
) -> Columns:
    """Put the samples of all records one after another.

    Parameters
    ----------
    records : sequence of Record
    names : sequence of str
        What each is called.
    predicted_mm : sequence of (n,) arrays
    states : sequence of mappings
        One a record; empty where nothing is known.

    Returns
    -------
    dict of str to ndarray, shape (n,)
    """
    parts = [_columns(*each) for each in zip(records, names, predicted_mm, states, strict=True)]
    shared = [name for name in parts[0] if all(name in part for part in parts)]
    return {name: np.concatenate([part[name] for part in parts]) for name in shared}


def _columns(record: Record, name: str, predicted_mm: FloatArray, state: State) -> Columns:
    own = record.columns
    columns: Columns = {"record": np.full(len(record), name)}
    columns |= {key: own[key] for key in ("t_s", "circle", "sweep", "direction", "lap", "angle_deg", "feed_mm_min")}
    columns |= {f"s{k}_mm": own[f"s{k}_mm"] for k in SLIDERS}
    if "temperature_c" in own:
        columns["temperature_c"] = own["temperature_c"]
    for key, called in PER_SLIDER.items():
        if key in state:
            columns |= {called.format(k): state[key][:, k - 1] for k in SLIDERS}
    columns["measured_um"] = UM_PER_MM * record.reading_mm
    columns["predicted_um"] = UM_PER_MM * predicted_mm
    columns["residual_um"] = columns["measured_um"] - columns["predicted_um"]
    return columns


def stretches(count: int) -> NDArray[np.bool_]:
    """Deal samples in order, `STRETCH` to either half in turn: both halves then hold every time."""
    second: NDArray[np.bool_] = (np.arange(count) // STRETCH) % 2 == 1
    return second


def halves(columns: Columns) -> NDArray[np.bool_]:
    """Deal the samples into two halves that hold the same circles, directions and feeds.

    Laps of one circle, direction and feed go to either half in turn. Where there is one lap only, stretches of
    `STRETCH` samples do: what is fitted to one half is then judged on readings with noise of their own.
    """
    keys = np.column_stack([codes(columns[key]) for key in ("record", "circle", "feed_mm_min", "direction")])
    group = np.unique(keys, axis=0, return_inverse=True)[1].ravel()
    turn = np.column_stack([group, codes(columns["sweep"]), codes(columns["lap"])])
    turns, turn_of = np.unique(turn, axis=0, return_inverse=True)
    turn_of = turn_of.ravel()
    first = np.searchsorted(turns[:, 0], turns[:, 0])
    place = np.arange(len(turns)) - first
    alone = np.bincount(turns[:, 0])[turns[:, 0]] == 1
    second: NDArray[np.bool_] = np.where(alone[turn_of], stretches(len(group)), place[turn_of] % 2 == 1)
    return second


def sampling_rate_hz(columns: Columns) -> float:
    """Give the usual number of samples a second."""
    steps_s = np.diff(columns["t_s"])
    usual_s = float(np.median(steps_s[steps_s > 0.0])) if (steps_s > 0.0).any() else np.inf
    return 1.0 / usual_s


def codes(values: NDArray[Any]) -> NDArray[np.intp]:
    """Number the distinct values from 0; give each sample's number."""
    return np.unique(values, return_inverse=True)[1].ravel()
