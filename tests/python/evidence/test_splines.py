"""Splines: partition of unity, periods, and the prior's smoothness."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.evidence import splines


@pytest.mark.parametrize("periodic", [False, True])
def test_splines_sum_to_one(periodic: bool) -> None:
    values = np.linspace(-1.0, 3.0, 301)
    assert splines.design(values, -1.0, 3.0, 9, periodic=periodic).sum(axis=1) == pytest.approx(1.0)


def test_a_periodic_spline_repeats() -> None:
    values = np.linspace(0.0, 2.0, 50)
    one = splines.design(values, 0.0, 2.0, 8, periodic=True)
    assert splines.design(values + 6.0, 0.0, 2.0, 8, periodic=True) == pytest.approx(one, abs=1e-12)


def test_rows_that_are_not_known_are_zero_and_those_beyond_are_at_the_end() -> None:
    found = splines.design(np.array([np.nan, 1.0, 7.0]), 0.0, 1.0, 6)
    assert not found[0].any()
    assert found[2] == pytest.approx(found[1])


def test_a_rougher_prior_bends_more() -> None:
    second = np.diff(np.eye(12), 2, axis=0)
    smooth, rough = (splines.prior_factor(12, each) for each in (1000.0, 1.0))

    def bending(factor: np.ndarray) -> float:
        covariance = factor @ factor.T
        return float(np.trace(second @ covariance @ second.T) / np.trace(covariance))

    assert bending(rough) > 30.0 * bending(smooth)


def test_the_prior_is_that_of_its_precision() -> None:
    factor = splines.prior_factor(7, 5.0)
    second = np.diff(np.eye(7), 2, axis=0)
    assert factor @ factor.T == pytest.approx(np.linalg.inv(5.0 * second.T @ second + np.eye(7)))
