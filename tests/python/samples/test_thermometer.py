"""A thermometer's noise is taken out, what it shows is kept, and sweeps do not look into one another."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.samples.thermometer import smoothed

TIME_S = np.arange(0.0, 200.0, 0.125)
ONE = np.zeros(len(TIME_S), dtype=int)


def test_noise_falls_and_an_even_rise_stays() -> None:
    true_c = 20.0 + 0.01 * TIME_S
    noisy_c = true_c + np.random.default_rng(3).normal(0.0, 0.02, len(TIME_S))
    error_c = smoothed(TIME_S, ONE, noisy_c) - true_c
    middle = (TIME_S > 30.0) & (TIME_S < 170.0)
    assert np.sqrt(np.mean(error_c[middle] ** 2)) < 0.02 / 15.0  # 480 neighbours
    assert np.abs(error_c).max() < 0.02 / 4.0
    np.testing.assert_allclose(smoothed(TIME_S, ONE, true_c), true_c, rtol=0, atol=1e-9)


def test_another_sweep_is_another_time() -> None:
    sweep = (TIME_S >= 100.0).astype(int)
    step_c = np.where(sweep == 1, 25.0, 20.0)
    np.testing.assert_allclose(smoothed(TIME_S, sweep, step_c), step_c, rtol=0, atol=1e-9)


def test_a_single_reading_and_one_that_is_missing() -> None:
    assert smoothed(np.array([5.0]), np.array([0]), np.array([21.0])) == pytest.approx(21.0)
    missing = np.where(TIME_S < 50.0, np.nan, 20.0)
    assert np.isnan(smoothed(TIME_S, ONE, missing)).any()
