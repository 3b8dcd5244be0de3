"""From the columns of a record's file, or of a plan, to those columns of the engine's state that follow from no others.

Units are converted, time and temperature count from the record's first sample, sweeps are numbered through all records.
Velocity, reversals, leg forces and nominal readings are derived in the engine (`state.hpp`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.plan import CircleRun
from hexdbb.record import Record
from hexdbb.samples.thermometer import smoothed

Columns = dict[str, NDArray[Any]]

SECONDS_PER_MINUTE = 60.0


def state_columns(records: Sequence[Record]) -> Columns:
    """Return the columns of the engine's state that records hold, one record after another.

    Parameters
    ----------
    records : sequence of Record

    Returns
    -------
    dict of str to ndarray, each of shape (n,)
        Times in s, temperatures in °C and K (nan where not measured), angles in rad, feeds in mm/s.
    """
    parts = [_columns(record) for record in records]
    sweeps = 0
    for part in parts:
        _, number = np.unique(part["sweep"], return_inverse=True)
        part["sweep"] = (sweeps + number).astype(np.int32)
        sweeps += int(number.max(initial=-1)) + 1
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]} if parts else {}


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


def _columns(record: Record) -> Columns:
    columns = record.columns
    assert record.origin is not None  # a record sets it when it is made
    start_s, start_c = record.origin
    temperature_c = np.full(len(record), np.nan)
    if "temperature_c" in columns:
        temperature_c = smoothed(columns["t_s"], columns["sweep"], columns["temperature_c"])
    return {
        "time_s": columns["t_s"] - start_s,
        "circle": columns["circle"],
        "sweep": columns["sweep"],
        "lap": columns["lap"],
        "direction": columns["direction"].astype(np.float64),
        "angle_rad": np.radians(columns["angle_deg"]),
        "feed_mm_s": columns["feed_mm_min"] / SECONDS_PER_MINUTE,
        "temperature_c": temperature_c,
        "warming_k": temperature_c - start_c,
    }
