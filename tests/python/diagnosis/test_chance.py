"""Tail probabilities of the engine against SciPy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import special

from hexdbb import _core


@pytest.mark.parametrize("freedom", [(100, 19_000), (37, 35_000), (5, 10), (440, 34_000), (1, 1), (17, 40)])
@pytest.mark.parametrize("value", [0.0, 0.3, 0.999, 1.2, 1.7, 5.0])
def test_f(freedom: tuple[int, int], value: float) -> None:
    assert _core.f_tail(*freedom, value) == pytest.approx(special.fdtrc(*freedom, value), rel=1e-9, abs=1e-280)


@pytest.mark.parametrize("freedom", [1, 5, 27, 200])
@pytest.mark.parametrize("value", [0.0, 1e-3, 3.0, 40.0, 400.0])
def test_chi_square(freedom: int, value: float) -> None:
    assert _core.chi_square_tail(freedom, value) == pytest.approx(special.chdtrc(freedom, value), rel=1e-12)


@pytest.mark.parametrize("value", [-500.0, -38.0, -30.001, -29.999, -10.0, -1.0, 0.0, 0.5, 3.0, 8.0, 20.0])
def test_logarithm_of_the_normal_distribution(value: float) -> None:
    assert _core.log_normal_below(value) == pytest.approx(float(special.log_ndtr(value)), rel=1e-12)


def test_no_probability_of_what_is_none() -> None:
    assert np.isnan(_core.chi_square_tail(3.0, float("nan")))
