"""Screening to a display's resolution: nothing that a display could show is lost."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hexdbb.charts import screened
from hexdbb.charts.screening import KEPT_PER_COLUMN


def test_a_short_line_is_kept_whole() -> None:
    assert screened([0.0, 1.0, 2.0], [5.0, 6.0, 5.0], 1).tolist() == [0, 1, 2]


@given(st.integers(0, 2**32 - 1), st.integers(1, 50))
def test_every_column_keeps_first_last_smallest_and_largest(seed: int, columns: int) -> None:
    rng = np.random.default_rng(seed)
    x, y = np.sort(rng.uniform(0.0, 7.0, 900)), rng.normal(size=900)
    kept = screened(x, y, columns)
    assert len(kept) <= KEPT_PER_COLUMN * columns
    assert (np.diff(kept) > 0).all()
    place = np.minimum(((x - x[0]) / (x[-1] - x[0]) * columns).astype(int), columns - 1)
    for column in range(columns):
        own = np.flatnonzero(place == column)
        mine = np.intersect1d(own, kept)
        if len(own):
            assert {own[0], own[-1], own[y[own].argmin()], own[y[own].argmax()]} == set(mine)


def test_one_spike_among_100000_points_stays() -> None:
    y = np.zeros(100_000)
    y[77_777] = 1.0
    assert 77_777 in screened(np.arange(100_000.0), y, 300)


def test_a_break_of_the_line_stays_a_break() -> None:
    x, y = np.arange(1000.0), np.ones(1000)
    y[400:500] = np.nan
    kept = screened(x, y, 20)
    assert np.isnan(y[kept]).sum() == 1
    assert np.isnan(y[kept][np.searchsorted(kept, 400)])


def test_points_all_at_one_place_and_none_finite() -> None:
    assert len(screened(np.zeros(100), np.arange(100.0), 5)) == 2
    assert len(screened(np.arange(100.0), np.full(100, np.nan), 5)) == 1
