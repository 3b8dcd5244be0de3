"""Marginal likelihood against the density of the readings written out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy import stats
from scipy.special import logsumexp

from hexdbb.evidence.linear.marginal import marginal, solved
from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.linear.sums import Sums

Port = Callable[[str], np.ndarray]


def _density(linear: Linear, signature: np.ndarray, factor: np.ndarray, size: float) -> float:
    part = signature @ factor * size
    covariance = np.eye(len(signature)) + linear.own @ linear.own.T + part @ part.T
    mean = -linear.own @ linear.standing
    return float(stats.multivariate_normal(mean, covariance).logpdf(linear.residual))


def test_evidence_is_the_ratio_of_densities(linear: Linear, readings: Readings) -> None:
    rows = np.arange(0, len(readings), 6)
    few = Linear(linear.residual[rows], linear.own[rows], np.full(5, 0.3))
    part = Readings(readings.state, {}, readings.noise_mm[rows], readings.ports[rows])
    signature = readings.ports[rows, :3]
    sums = Sums(few, part, ())
    projected = sums.whole.project(sums.block(signature))
    factors, sizes = [np.eye(3), np.diag([1.0, 2.0, 0.5])], np.array([1e-4, 1e-3, 1e-2])
    found = marginal(projected.information, projected.gradient, factors, sizes)
    base = _density(few, signature, np.zeros((3, 3)), 0.0)
    every = [_density(few, signature, factor, size) - base for factor in factors for size in sizes]
    assert found.log_evidence == pytest.approx(float(logsumexp(every)) - np.log(6.0), abs=1e-6)
    assert found.best == divmod(int(np.argmax(every)), 3)


def test_coefficients_are_those_of_the_best_prior(linear: Linear, readings: Readings, port: Port) -> None:
    sums = Sums(linear, readings, ())
    projected = sums.whole.project(sums.block(port("cup")))
    found = marginal(projected.information, projected.gradient, [np.eye(3)], np.array([1e-4, 1e-3]))
    again = solved(projected.information, projected.gradient, found.factor, found.size)
    assert found.coefficients == pytest.approx(again, rel=1e-8)


def test_laplace_evidence_of_a_linear_model_is_its_density(linear: Linear) -> None:
    # The fit has moved the values to `standing` and left `residual`; the density is that before the fit, but for the
    # constant of the readings.
    own, at = linear.own[:60], np.array([0.5, -1.0, 0.2, 0.0, 2.0])
    before = linear.residual[:60] + own @ at
    information = own.T @ own + np.eye(5)
    best = np.linalg.solve(information, own.T @ before)
    fitted = Linear(before - own @ best, own, best)
    density = stats.multivariate_normal(np.zeros(60), np.eye(60) + own @ own.T).logpdf(before)
    assert fitted.log_evidence == pytest.approx(density + 30.0 * np.log(2.0 * np.pi))
