"""Learned functions among the values of a fit: against the engine's own derivatives of the same functions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.diagnosis import fit_free, learned_effect, noise_of
from hexdbb.evidence.linear.engine import Engine, Fitted
from hexdbb.evidence.linear.readings import Linear
from hexdbb.model import Choice, Model, new_model
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE

NAMES = ("learned:vertical:2:position", "learned:leg:all:leg_force", "learned:ball:time", "learned:load:angle")
"""One of two sliders that share a guideway, one of six legs alike, one with a function for each axis, one that legs
share by their forces."""


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of([case("backlash-x3-s1", replace(PACE, rate_hz=0.2 * PACE.rate_hz)).record()])


@pytest.fixture(scope="module")
def model(samples: Samples) -> Model:
    """Return a model with learned functions, their values drawn."""
    found = fit_free(samples, new_model(samples.machine)).model
    for name in NAMES:
        found = found.knowing_effects([learned_effect(samples, found, name)]).with_effect(Choice.parse(name))
    drawn = np.random.default_rng(7).normal(size=len(found.values)) * 0.1 * found.prior_sigma
    is_learned = np.array([each.effect in NAMES for each in found.parameters()])
    return found.with_values(np.where(is_learned, drawn, found.values))


@pytest.fixture(scope="module")
def engine(samples: Samples, model: Model) -> Engine:
    return Engine(samples, model, noise_of(samples))


def test_linearised_as_the_engine_does(engine: Engine, samples: Samples, model: Model) -> None:
    linear = engine.linearised(model).linear
    expected = _core.predict(samples.engine(model), engine.part.block(model), want_jacobian=True)
    scaled = (expected.jacobian * model.prior_sigma)[:, model.free] / engine.row_noise_mm[:, None]
    assert linear.own == pytest.approx(scaled, rel=1e-5, abs=1e-5 * float(np.abs(scaled).max()))
    residual = (engine.reading_mm - expected.reading_mm) / engine.row_noise_mm
    assert linear.residual == pytest.approx(residual, abs=1e-4)


def test_what_readings_do_not_see_of_the_base_changes_no_evidence(engine: Engine) -> None:
    whole, fewer = engine.linearised(engine.base), engine.linearised(engine.start)
    assert len(fewer.model.values) < len(whole.model.values)
    assert _most(fewer.linear) == pytest.approx(_most(whole.linear), abs=0.05)
    assert fewer.linear.residual == pytest.approx(whole.linear.residual, abs=0.02)


def _most(linear: Linear) -> float:
    """Log evidence at the minimum."""
    information = linear.normal[:-1, :-1] + np.eye(linear.own.shape[1])
    change = np.linalg.solve(information, linear.normal[:-1, -1] - linear.standing).astype(np.float64)
    return linear.moved(change).log_evidence


def test_the_spread_is_that_of_the_information(engine: Engine) -> None:
    fitted: Fitted = engine.linearised(engine.start)
    own = fitted.linear.own
    covariance = np.linalg.inv(own.T @ own + np.eye(own.shape[1]))
    assert fitted.spread == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-6)


def test_sums_of_a_wider_and_of_a_moved_linearisation(linear: Linear) -> None:
    columns = np.random.default_rng(2).normal(size=(len(linear.residual), 3))
    change = np.random.default_rng(4).normal(size=8)
    found = linear.wider(columns).moved(change)
    own = np.hstack([linear.own, columns])
    table = np.column_stack([own, linear.residual - own @ change])
    assert found.normal == pytest.approx(table.T @ table, rel=1e-9, abs=1e-8)
    assert found.standing == pytest.approx(change)
