"""Change points: states, slopes and jumps told from scatter."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.trend.segments import segments

DAYS = np.arange(24.0) * 30.0


def drawn(seed: int, sigma: float = 0.1) -> np.ndarray:
    return np.random.default_rng(seed).normal(0.0, sigma, len(DAYS))


@pytest.mark.parametrize("seed", range(5))
def test_scatter_alone_is_one_state(seed: int) -> None:
    (one,) = segments(DAYS, 5.0 + drawn(seed), np.full(24, 0.1))
    assert (one.first, one.last, one.slope) == (0, 23, 0.0)
    assert one.level == pytest.approx(5.0, abs=0.1)


@pytest.mark.parametrize("seed", range(5))
def test_a_jump_and_a_slope_are_found_where_they_begin(seed: int) -> None:
    truth = np.where(DAYS < 240.0, 1.0, 3.0) + np.maximum(DAYS - 480.0, 0.0) * 0.01
    state, after, rising = segments(DAYS, truth + drawn(seed), np.full(24, 0.1))
    assert (state.last, after.first) == (7, 8)
    assert abs(rising.first - 16) <= 1
    assert rising.slope == pytest.approx(0.01, abs=4.0 * rising.slope_sigma)
    assert (state.slope, after.slope) == (0.0, 0.0)


def test_scatter_beyond_the_intervals_makes_no_change_points() -> None:
    assert len(segments(DAYS, 5.0 + drawn(1, 1.0), np.full(24, 0.01))) == 1


@pytest.mark.parametrize("count", [1, 2, 3])
def test_few_records_are_one_segment(count: int) -> None:
    (one,) = segments(DAYS[:count], np.full(count, 2.0), np.full(count, np.nan))
    assert (one.level, one.last) == (2.0, count - 1)


def test_records_of_one_moment_do_no_harm() -> None:
    days = np.array([0.0, 0.0, 0.0, 0.0, 0.0])
    assert len(segments(days, np.array([1.0, 1.1, 0.9, 1.0, 1.05]), np.full(5, 0.1))) == 1
