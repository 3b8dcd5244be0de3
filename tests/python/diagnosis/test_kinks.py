"""Many readings with play: the cost has a kink wherever a reading's travel since the reversal equals the play."""

from __future__ import annotations

import numpy as np
import pytest
from tests.fleet.made import Fleet, play_model

from hexdbb.diagnosis import diagnose
from hexdbb.model import Model
from hexdbb.samples import Samples, predict

OFF = 0.1
"""Part of a standard deviation by which a value is moved to find where the cost is lowest."""


@pytest.mark.parametrize("number", [0, 5])
def test_a_fit_comes_to_rest_at_its_minimum_whose_gradient_does_not_vanish(number: int) -> None:
    samples = Samples.of([Fleet(8, 8, "standard").record(number)])
    found = diagnose(samples, play_model(), check_held_out=False)
    # Otherwise Ceres began anew on all readings, which takes three times as long.
    assert found.termination.startswith("Converged")
    information = np.linalg.inv(found.covariance[np.ix_(found.model.free, found.model.free)])
    alone = np.zeros(len(found.model.values))
    alone[found.model.free] = 1.0 / np.sqrt(np.diag(information))
    plays = [k for k, each in enumerate(found.model.parameters()) if each.effect == "backlash"]
    assert len(plays) == 6
    for play in plays:
        step = OFF * alone[play] * (np.arange(len(alone)) == play)
        below, here, above = (
            cost(found.samples, found.model.with_values(found.model.values + way * step), found.noise.sigma_mm)
            for way in (-1.0, 0.0, 1.0)
        )
        assert abs(OFF * (below - above) / (2.0 * (below + above - 2.0 * here))) < 0.03


def cost(samples: Samples, model: Model, noise_mm: float) -> float:
    prior = ((model.values - model.start) / model.prior_sigma)[model.free]
    return float(np.sum((predict(samples, model).residual_mm / noise_mm) ** 2) + prior @ prior)
