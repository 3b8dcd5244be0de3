"""A model with more values than a part of the readings can determine: its fits end at the minimum of all of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.diagnosis import Noise, evaluate_fit, fit_free, learned_effect, noise_of
from hexdbb.model import Choice, Model, new_model
from hexdbb.samples import Samples, linearise, predict
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE

NAME = "learned:vertical:1:fine_position"
ENOUGH = 0.1
"""Chi-square by which two ends of a fit may differ: five times what each takes for nothing."""
LAST_FALL = 1e-3
"""Fall of chi-square that a step from the end of a diagnosis is predicted to bring, at most."""


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of([case("backlash-x3-s1", replace(PACE, rate_hz=0.25 * PACE.rate_hz)).record()])


@pytest.fixture(scope="module")
def noise(samples: Samples) -> Noise:
    return noise_of(samples)


@pytest.fixture(scope="module")
def model(samples: Samples, noise: Noise) -> Model:
    found = fit_free(samples, new_model(samples.machine)).model
    wider = found.knowing_effects([learned_effect(samples, found, NAME)]).with_effect(Choice.parse(NAME))
    return evaluate_fit(samples, wider, wider.free, noise, hypothesis=True)[0]


def test_steps_from_a_minimum_end_where_a_descent_does(samples: Samples, noise: Noise, model: Model) -> None:
    others = samples.part(samples["circle"] != samples["circle"][0])
    assert len(others) > 2048  # fewer are no part of themselves
    (near, _), (far, _) = (
        evaluate_fit(others, model, model.free, noise, hypothesis=True, from_minimum=each) for each in (True, False)
    )
    assert _chi_square(others, near, noise) < _chi_square(others, far, noise) + ENOUGH


def test_a_further_step_would_bring_nothing(samples: Samples, noise: Noise, model: Model) -> None:
    fitted, _ = evaluate_fit(samples, model, model.free, noise)
    there, free = linearise(samples, fitted), fitted.free
    own = there.jacobian[:, free] * fitted.prior_sigma[free] / noise.sigma_mm
    standing = ((fitted.values - fitted.start) / fitted.prior_sigma)[free]
    downhill = own.T @ (there.residual_mm / noise.sigma_mm) - standing
    assert downhill @ np.linalg.solve(own.T @ own + np.eye(len(standing)), downhill) < LAST_FALL


def _chi_square(samples: Samples, model: Model, noise: Noise) -> float:
    standing = ((model.values - model.start) / model.prior_sigma)[model.free]
    residual = predict(samples, model).residual_mm / noise.sigma_mm
    return float(residual @ residual + standing @ standing)
