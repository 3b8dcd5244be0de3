"""Bounds of shares, quantiles and detection curves: against tables, and by how often they hold."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.studies.curves import DetectionCurve
from hexdbb.studies.rates import clustered_share, quantile, share


@pytest.mark.parametrize(
    ("good", "number", "low", "high"),
    # Clopper-Pearson, 95 %: Brown, Cai, DasGupta, Statistical Science 16(2), 2001; the rule of three for none of n.
    [
        (0, 10, 0, 0.3085),
        (1, 10, 0.0025, 0.4450),
        (5, 10, 0.1871, 0.8129),
        (10, 10, 0.6915, 1),
        (0, 300, 0, 0.0122),
    ],
)
def test_shares_have_the_exact_bounds(good: int, number: int, low: float, high: float) -> None:
    found = share(good, number)
    assert (found.value, found.number) == (good / number, number)
    assert (found.low, found.high) == pytest.approx((low, high), abs=1e-4)


def test_no_case_has_no_share() -> None:
    assert np.isnan([share(0, 0).value, clustered_share([], []).low, quantile([], 0.5).high]).all()


def test_values_of_one_case_that_go_together_count_as_fewer() -> None:
    independent = clustered_share([9, 10, 9, 8, 9, 10, 9, 8, 9, 9], [10] * 10)
    together = clustered_share([10, 10, 10, 10, 10, 0, 10, 10, 10, 10], [10] * 10)
    assert independent.value == together.value == 0.9
    alone, single = share(90, 100), share(9, 10)
    assert independent.low == pytest.approx(alone.low, abs=0.02)
    # One bad case of ten says no more than one of ten, and less: how far cases scatter is itself known from ten only.
    assert 0.4 < together.low < single.low < 0.6
    # Where nothing varies nothing shows how much values of one case go together.
    assert clustered_share([10] * 10, [10] * 10).low == share(10, 10).low


def test_bounds_of_clustered_shares_hold() -> None:
    draw, held = np.random.default_rng(3), 0
    for _ in range(300):
        good = draw.binomial(15, draw.beta(19.0 * 4, 4, size=60))
        found = clustered_share(good.tolist(), [15] * 60)
        held += found.low <= 0.95 <= found.high
    assert held >= 0.92 * 300


def test_bounds_of_a_median_hold_whatever_the_distribution() -> None:
    draw, held = np.random.default_rng(4), 0
    for _ in range(400):
        found = quantile(draw.lognormal(size=25), 0.5)
        held += found.low <= 1.0 <= found.high
    assert held >= 0.94 * 400
    assert quantile([1.0, 2.0, 3.0], 0.5).value == 2.0
    assert np.isinf([quantile([1.0, 2.0], 0.5).low, quantile([1.0, 2.0], 0.95).high]).all()


def drawn_curve(draw: np.random.Generator, count: int) -> DetectionCurve:
    size = np.exp(draw.uniform(np.log(0.1), np.log(10.0), count))
    return DetectionCurve.of(size, draw.random(count) < 1.0 / (1.0 + size**-4.0))


def test_bounds_of_the_size_that_is_found_hold() -> None:
    """A curve of 50 % at size 1 and 95 % at 19^(1/4) = 2.09, from 40 cases."""
    draw, held = np.random.default_rng(5), np.zeros(2)
    for _ in range(40):
        curve = drawn_curve(draw, 40)
        for place, (level, size) in enumerate(((0.5, 1.0), (0.95, 19.0**0.25))):
            found = curve.size_found(level)
            held[place] += found.low <= size <= found.high
    assert (held >= 35).all()


def test_a_curve_exists_where_all_small_faults_were_missed_and_all_large_ones_found() -> None:
    size = np.geomspace(0.1, 10.0, 40)
    curve = DetectionCurve.of(size, size > 1.0)
    found = curve.size_found(0.5)
    assert 0.8 < found.low < found.value < found.high < 1.25
    low, middle, high = curve.probability([0.1, 1.0, 10.0])
    assert (low <= middle).all() and (middle <= high).all()
    assert middle[0] < 0.02 and middle[2] > 0.98


def test_a_size_beyond_those_tried_is_said_to_be_beyond() -> None:
    size = np.geomspace(0.1, 1.0, 20)
    assert DetectionCurve.of(size, np.zeros(20, bool)).size_found(0.95).value == np.inf
    assert DetectionCurve.of(size, np.ones(20, bool)).size_found(0.5).value == -np.inf
