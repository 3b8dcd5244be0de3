"""A linear machine of three circles whose pushes and values are known exactly: no engine."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.evidence.linear.readings import Linear, Readings, State
from hexdbb.learned.places import BY_LOAD
from hexdbb.machine import shipped_machine
from hexdbb.samples.prediction import PORT_COUNT


@pytest.fixture
def readings() -> Readings:
    """Three circles, two laps, two feeds: 720 rows."""
    rows = 720
    time_s = 0.05 * np.arange(rows)
    turn = 2.0 * np.pi * np.arange(rows) / 120.0
    position = 200.0 + 40.0 * np.sin(turn[:, None] + np.arange(6)) + 3.0 * np.cos(0.37 * turn[:, None])
    velocity = np.gradient(position, time_s, axis=0)
    columns = {
        "sliders_mm": position,
        "velocity_mm_s": velocity,
        "acceleration_mm_s2": np.gradient(velocity, time_s, axis=0),
        "travel_direction": np.sign(velocity),
        "time_s": time_s,
        "angle_rad": turn % (2.0 * np.pi),
        "gauge_scale_mm": 0.3 * np.sin(turn + 0.7),
        "direction": np.where(np.arange(rows) // 120 % 2 == 0, 1.0, -1.0),
        "bar_angle_rad": turn % (2.0 * np.pi),
        "mount": np.zeros(rows),
    }
    shares = np.random.default_rng(6).normal(size=(len(BY_LOAD), 6))
    columns |= {name: np.tile(share, (rows, 1)) for name, share in zip(BY_LOAD, shares, strict=True)}
    circle = np.arange(rows) // 240
    columns["sweep"] = circle
    groups = {
        "circle": circle,
        "feed": np.arange(rows) // 60 % 2,
        "direction": np.arange(rows) // 120 % 2,
        "lap": np.arange(rows) // 120 % 2,
        "sweep": circle,
    }
    return Readings(State(columns, shipped_machine()), groups, np.full(rows, 5e-4), _ports(turn))


@pytest.fixture
def linear(readings: Readings) -> Linear:
    """Five values of the model's own, pushes that vary smoothly, a residual of noise."""
    draw = np.random.default_rng(3)
    rows, turn = len(readings), readings.state["angle_rad"]
    return Linear(draw.normal(size=rows), 3.0 * _waves(turn), np.zeros(5))


def _waves(turn: np.ndarray) -> np.ndarray:
    return np.column_stack([np.ones(len(turn)), *(f(k * turn) for k in (1, 2) for f in (np.cos, np.sin))])


def _ports(turn: np.ndarray) -> np.ndarray:
    ports = 2000.0 * (_waves(turn) @ np.random.default_rng(5).normal(size=(5, PORT_COUNT)))
    ports[:, _core.PORTS["reading"][0]] = 2000.0
    return ports


@pytest.fixture
def port(readings: Readings) -> Callable[[str], np.ndarray]:
    """Return the readings' answers at the columns of a port."""

    def of(name: str) -> np.ndarray:
        first, count = _core.PORTS[name]
        return readings.ports[:, first : first + count]

    return of
