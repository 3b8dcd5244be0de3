"""Splines against scipy's, which come from the knots."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BSpline

from hexdbb.learned.splines import DEGREE, design


@pytest.mark.parametrize("count", [4, 5, 12])
@pytest.mark.parametrize("periodic", [False, True])
def test_design_is_that_of_equal_knots(count: int, periodic: bool) -> None:
    low, high = -3.0, 5.0
    values = np.concatenate([np.linspace(low, high, 97), [low - 1.0, high + 2.0, np.nan]])
    intervals = count if periodic else count - DEGREE
    step = (high - low) / intervals
    knots = low + step * np.arange(-DEGREE, intervals + DEGREE + 1)
    inside = low + np.mod(values - low, high - low) if periodic else np.clip(values, low, high)
    inside[-1] = low
    expected = BSpline.design_matrix(inside, knots, DEGREE).toarray()
    if periodic:
        expected[:, :DEGREE] += expected[:, count:]
    expected[-1] = 0.0
    found = design(values, low, high, count, periodic=periodic)
    np.testing.assert_allclose(found, expected[:, :count], rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(found[:-1].sum(axis=1), 1.0, rtol=0.0, atol=1e-13)
