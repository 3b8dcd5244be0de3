"""The orthonormal harmonics span what a Fourier series of the angle spans."""

import numpy as np
import pytest

from hexdbb.diagnosis.harmonics import orthonormal_harmonics


@pytest.mark.parametrize(("turns", "highest"), [(2.0, 8), (1.0, 3), (0.6, 2), (1.0, 0)])
def test_residual_is_that_of_least_squares(turns: float, highest: int) -> None:
    random = np.random.default_rng(4)
    angle_rad = np.sort(random.uniform(0.0, 2.0 * np.pi * turns, 500))
    multiples = np.outer(angle_rad, np.arange(highest + 1))
    series = np.hstack([np.cos(multiples), np.sin(multiples[:, 1:])])
    values = series @ random.normal(size=series.shape[1]) + 0.01 * random.normal(size=500)
    basis = orthonormal_harmonics(angle_rad, highest)
    assert basis.shape == (500, 2 * highest + 1)
    expected = values - series @ np.linalg.lstsq(series, values, rcond=None)[0]
    np.testing.assert_allclose(values - basis @ (values @ basis), expected, atol=1e-6)
