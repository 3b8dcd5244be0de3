"""What a learned function claims to predict: groups in whose range of its variable other readings lie."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.evidence.linear.covered import is_covered
from hexdbb.evidence.linear.readings import Readings, State
from hexdbb.evidence.linear.screen import Known
from hexdbb.learned import Learned


@pytest.fixture
def two_feeds(readings: Readings) -> Readings:
    """The second half of the rows at four times the feed: accelerations are sixteen times as large."""
    fast = np.arange(len(readings)) >= len(readings) // 2
    names = ("sliders_mm", "velocity_mm_s", "acceleration_mm_s2", "time_s", "angle_rad")
    columns = {name: readings.state[name].copy() for name in names}
    columns["velocity_mm_s"] *= np.where(fast, 4.0, 1.0)[:, None]
    columns["acceleration_mm_s2"] *= np.where(fast, 16.0, 1.0)[:, None]
    return replace(readings, state=State(columns, readings.state.machine))


@pytest.mark.parametrize(
    ("name", "slow", "fast"),
    [
        ("learned:slider:1:acceleration", True, False),
        ("learned:slider:all:acceleration", True, False),
        ("learned:slider:1:position", True, True),
        ("learned:reading:angle", True, True),
        ("learned:leg:3:time", False, False),
    ],
)
def test_a_function_claims_the_range_that_others_have(two_feeds: Readings, name: str, slow: bool, fast: bool) -> None:
    is_fast = np.arange(len(two_feeds)) >= len(two_feeds) // 2
    assert is_covered([Learned.parse(name)], two_feeds, ~is_fast) is slow
    assert is_covered([Learned.parse(name)], two_feeds, is_fast) is fast


def test_a_function_of_time_claims_what_lies_between_its_readings(readings: Readings) -> None:
    turn = np.arange(len(readings)) // 60
    assert is_covered([Learned.parse("learned:leg:3:time")], readings, turn % 2 == 1)
    lap = np.arange(len(readings)) // 120
    assert not is_covered([Learned.parse("learned:leg:3:fine_time")], readings, lap % 2 == 1)
    assert not is_covered([Learned.parse("learned:cup:step@12.5")], readings, turn % 2 == 1)


def test_a_formula_claims_everything(two_feeds: Readings) -> None:
    is_fast = np.arange(len(two_feeds)) >= len(two_feeds) // 2
    assert is_covered([Known("servo_lag", ("1",), False)], two_feeds, is_fast)
