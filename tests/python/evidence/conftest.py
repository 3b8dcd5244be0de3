"""A linear machine of three circles whose pushes and values are known exactly: no engine."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.evidence.readings import Linear, Readings, State


@pytest.fixture
def readings() -> Readings:
    """Three circles, two laps, two feeds: 720 rows."""
    rows = 720
    time_s = 0.05 * np.arange(rows)
    turn = 2.0 * np.pi * np.arange(rows) / 120.0
    position = 200.0 + 40.0 * np.sin(turn[:, None] + np.arange(6)) + 3.0 * np.cos(0.37 * turn[:, None])
    velocity = np.gradient(position, time_s, axis=0)
    state = State(
        {
            "position": position,
            "velocity": velocity,
            "speed": np.abs(velocity),
            "acceleration": np.gradient(velocity, time_s, axis=0),
            "direction": np.sign(velocity),
            "time": time_s,
            "elapsed": time_s / time_s[-1] - 0.5,
            "polar_angle": turn % (2.0 * np.pi),
            "circle_direction": np.where(np.arange(rows) // 120 % 2 == 0, 1.0, -1.0),
        }
    )
    circle = np.arange(rows) // 240
    groups = {
        "circle": circle,
        "feed": np.arange(rows) // 60 % 2,
        "direction": np.arange(rows) // 120 % 2,
        "lap": np.arange(rows) // 120 % 2,
        "sweep": circle,
    }
    return Readings(state, groups, np.full(rows, 5e-4))


@pytest.fixture
def linear(readings: Readings) -> Linear:
    """Five values of the model's own, pushes that vary smoothly, a residual of noise."""
    draw = np.random.default_rng(3)
    rows, turn = len(readings), readings.state["polar_angle"]
    waves = np.column_stack([np.ones(rows), *(f(k * turn) for k in (1, 2) for f in (np.cos, np.sin))])
    widths = {"slider": 6, "leg": 6, "lateral": 6, "vertical": 6, "ball": 3, "cup": 3, "platform_joint": 18}
    pushes = {place: 2000.0 * (waves @ draw.normal(size=(5, width))) for place, width in widths.items()}
    pushes["reading"] = np.full((rows, 1), 2000.0)
    return Linear(draw.normal(size=rows), 3.0 * waves, np.zeros(5), pushes)
