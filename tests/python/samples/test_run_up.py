"""What a machine did along the run-up to a circle: as it comes round a lap later, also where a lap is not closed."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.samples.deflection import LEAST_TURN_MM
from hexdbb.samples.memory import remembered_column
from hexdbb.samples.since_turn import direction_and_travel

LAP_S, READINGS = 8.0, 200


def swept(laps: float) -> tuple[np.ndarray, np.ndarray]:
    """Return times and angles of a sweep whose last reading is one step before its end."""
    time_s = np.arange(round(laps * READINGS)) * LAP_S / READINGS
    return time_s, 2.0 * np.pi * time_s / LAP_S


@pytest.mark.parametrize("laps", [1.0, 1.3, 2.0])
def test_a_run_up_lies_a_lap_behind(laps: float) -> None:
    time_s, angle_rad = swept(laps)
    first, end, lap_s = _core.run_up(time_s, angle_rad % (2.0 * np.pi))
    assert lap_s == pytest.approx(LAP_S)
    assert time_s[first:end] - lap_s == pytest.approx(np.arange(first - end, 0) * LAP_S / READINGS)
    assert end - first == READINGS // 8
    first, end, _ = _core.run_up(time_s, angle_rad, np.pi)
    assert end - first == READINGS // 2


def test_less_than_a_lap_has_no_run_up() -> None:
    first, end, _ = _core.run_up(*swept(0.9))
    assert first == end


def test_times_and_angles_of_other_numbers_are_refused() -> None:
    with pytest.raises(ValueError, match="differ in number"):
        _core.run_up(np.arange(3.0), np.arange(4.0))


def test_a_gauge_has_turned_along_the_run_up() -> None:
    """It turned 30 degrees before the first reading."""
    time_s, angle_rad = swept(1.0)
    moved_mm = np.cos(angle_rad + np.radians(30.0))
    sweep = np.zeros(len(time_s), np.int32)
    direction, since_mm = direction_and_travel(moved_mm, time_s, sweep, angle_rad, LEAST_TURN_MM)
    assert direction[0] == -1.0
    assert since_mm[0] == pytest.approx(1.0 - moved_mm[0], abs=1e-3)


@pytest.mark.parametrize("laps", [1.0, 2.0])
def test_what_lags_has_followed_the_run_up(laps: float) -> None:
    """With a time constant of a tenth of the run-up's time, it has settled when a sweep begins: laps are alike."""
    time_s, angle_rad = swept(3.0)
    values = np.sin(angle_rad)
    expected = remembered_column("lagged", 0.1, values, time_s, np.zeros(len(time_s), np.int32), angle_rad)[-READINGS:]
    time_s, angle_rad = swept(laps)
    found = remembered_column("lagged", 0.1, np.sin(angle_rad), time_s, np.zeros(len(time_s), np.int32), angle_rad)
    assert found[:READINGS] == pytest.approx(expected, abs=1e-3)
