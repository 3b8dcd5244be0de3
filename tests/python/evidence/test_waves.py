"""What repeats along the travel with an amplitude that changes with how fast or where the slider is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from hexdbb.discovery.words import place_clause
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.proposals.waves import waves
from hexdbb.learned import Learned, number_of
from hexdbb.samples.memory import remembered_column

Port = Callable[[str], np.ndarray]
PERIOD_MM = 9.1


def _found(linear: Linear, readings: Readings, port: Port, amplitude: np.ndarray) -> dict[str, Learned]:
    """Return the waves of slider 4 that are proposed where it errs by so much times a wave."""
    wave = np.sin(2.0 * np.pi * readings.state["sliders_mm"][:, 3] / PERIOD_MM + 0.6)
    pushed = replace(linear, residual=linear.residual + 8e-3 * amplitude * wave * port("slider")[:, 3])
    every = [each.hypothesis for each in waves(pushed, readings, DEFAULT)]
    mine = (each for each in every if (each.place, each.element) == ("slider", 4))
    near = (each for each in mine if number_of(each.variable) == pytest.approx(PERIOD_MM, rel=0.03))
    return {each.variable.name.partition("@")[0]: each for each in near}


def test_what_is_held_down_at_speed_is_found_with_its_period(linear: Linear, readings: Readings, port: Port) -> None:
    speed = np.abs(readings.state["velocity_mm_s"][:, 3])
    found = _found(linear, readings, port, np.exp(-speed / (0.3 * speed.max())))
    assert "velocity_wave" in found
    assert Learned.parse(found["velocity_wave"].name) == found["velocity_wave"]


def test_what_waves_at_one_end_is_found(linear: Linear, readings: Readings, port: Port) -> None:
    place = readings.state["sliders_mm"][:, 3]
    assert "position_wave" in _found(linear, readings, port, (place > np.median(place)).astype(float))


def test_what_waves_alike_everywhere_is_left_to_its_period(linear: Linear, readings: Readings, port: Port) -> None:
    assert not _found(linear, readings, port, np.ones(len(readings)))


def test_its_phase_is_a_column_and_a_clause() -> None:
    learned = Learned.parse("learned:slider:4:velocity_wave@20")
    assert learned.variable.all_times == ("sliders_mm.cosine@20", "sliders_mm.sine@20")
    place, none = np.linspace(0.0, 60.0, 30).reshape(10, 3), np.zeros(10)
    for how, wave in (("cosine", np.cos), ("sine", np.sin)):
        found = remembered_column(how, 20.0, place, none, none.astype(int), none)
        assert found == pytest.approx(wave(np.pi * place / 10.0))
    assert place_clause(learned).endswith(": repeats every 20 mm of travel, more or less by its velocity")
