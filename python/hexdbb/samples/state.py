"""From the columns of a record's file, or of a plan, to those columns of the engine's state that follow from no others.

Units are converted, time and temperature count from the record's first sample, sweeps are numbered through all records.
A column of records is made when it is first asked for: few questions need them all, and of two million readings each
takes 16 MB. Velocity, reversals, leg forces and nominal readings are derived in the engine (`state.hpp`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.plan import CircleRun
from hexdbb.record import Record
from hexdbb.record.columns import joined
from hexdbb.samples.distinct import distinct_rows
from hexdbb.samples.thermometer import smoothed

Columns = dict[str, NDArray[Any]]
Make = Callable[[], NDArray[Any]]
"""Makes a column."""

SECONDS_PER_MINUTE = 60.0


def state_columns(records: Sequence[Record]) -> dict[str, Make]:
    """Return the columns of the engine's state that records hold, one record after another, each as it is made.

    Parameters
    ----------
    records : sequence of Record

    Returns
    -------
    dict of str to callable
        Each returns its column, shape (n,): times in s, temperatures in °C and K (nan where not measured), angles in
        rad, feeds in mm/s.
    """
    made: dict[str, Make] = {name: partial(_of_all, of_one, records) for name, of_one in OF_RECORD.items()}
    return made | {"sweep": partial(_sweeps, records)}


def planned_columns(runs: Sequence[CircleRun], angle_rad: NDArray[np.floating]) -> Columns:
    """Return the columns of the engine's state of one lap of each run, one after another; temperature is not measured.

    Parameters
    ----------
    runs : sequence of CircleRun
    angle_rad : ndarray, shape (m,)
        Angles from the run's start, rising, the same for every run.

    Returns
    -------
    dict of str to ndarray, each of shape (len(runs) m,)
    """
    count = len(angle_rad)

    def of_runs(values: list[float]) -> NDArray[np.float64]:
        return np.repeat(np.array(values, dtype=np.float64), count)

    feed_mm_s = of_runs([run.feed_mm_min / SECONDS_PER_MINUTE for run in runs])
    lap_s = [2.0 * np.pi * run.circle.radius_mm / run.feed_mm_min * SECONDS_PER_MINUTE for run in runs]
    begins_s = np.cumsum([0.0, *(run.laps * each for run, each in zip(runs, lap_s, strict=True))])[:-1]
    direction = of_runs([run.direction for run in runs])
    unknown = np.full(len(direction), np.nan)
    return {
        "time_s": of_runs(list(begins_s)) + np.outer(lap_s, angle_rad / (2.0 * np.pi)).ravel(),
        "circle": np.repeat(np.array([run.circle.id for run in runs], np.int32), count),
        "sweep": np.repeat(np.arange(len(runs), dtype=np.int32), count),
        "lap": np.zeros(len(direction), np.int32),
        "direction": direction,
        "angle_rad": direction * np.tile(angle_rad, len(runs)),
        "feed_mm_s": feed_mm_s,
        "temperature_c": unknown,
        "warming_k": unknown,
    }


def _of_all(of_one: Callable[[Record], NDArray[Any]], records: Sequence[Record]) -> NDArray[Any]:
    return joined([of_one(record) for record in records])


def _sweeps(records: Sequence[Record]) -> NDArray[Any]:
    """Number the sweeps of all records from 0, in the order of their numbers within each."""
    parts: list[NDArray[Any]] = []
    before = 0
    for record in records:
        _, number = distinct_rows(record.columns["sweep"])
        parts.append((before + number).astype(np.int32))
        before += int(number.max(initial=-1)) + 1
    return joined(parts)


def _first(record: Record) -> tuple[float, float]:
    """Return time (s) and temperature (°C) of the record's first sample."""
    assert record.origin is not None  # a record sets it when it is made
    return record.origin


def _temperature_c(record: Record) -> NDArray[Any]:
    columns = record.columns
    if "temperature_c" not in columns:
        return np.full(len(record), np.nan)
    return smoothed(columns["t_s"], columns["sweep"], columns["temperature_c"])


OF_RECORD: dict[str, Callable[[Record], NDArray[Any]]] = {
    "time_s": lambda record: record.columns["t_s"] - _first(record)[0],
    "circle": lambda record: record.columns["circle"],
    "lap": lambda record: record.columns["lap"],
    "direction": lambda record: record.columns["direction"].astype(np.float64),
    "angle_rad": lambda record: np.radians(record.columns["angle_deg"]),
    "feed_mm_s": lambda record: record.columns["feed_mm_min"] / SECONDS_PER_MINUTE,
    "temperature_c": _temperature_c,
    "warming_k": lambda record: _temperature_c(record) - _first(record)[1],
}
"""Columns of the state that follow from one record alone, shape (n,)."""
