"""A fit to some circles that begins where all have their minimum ends where one from the nominal machine does."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.diagnosis import evaluate_fit, fit_free
from hexdbb.diagnosis.heldout import folds
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.simulate import Pace

PACE = Pace(rate_hz=6.0, instants_per_sample=4, travel_s=10.0)
"""10,500 readings of the seven circles, 9,000 of six: enough for the way from the minimum of all."""
APART = 0.3
"""Standard deviations over all values: both fits end where a step would lower chi-square by less than 0.02, each within
0.14 of the minimum."""


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of([case("none-s1", PACE).record()])


def test_a_fit_from_the_minimum_of_all_ends_where_one_from_nominal_does(samples: Samples) -> None:
    whole = fit_free(samples, new_model(samples.machine))
    training = samples.part(~folds(whole.samples, "circle", 7)[0])
    assert len(training) > 8192  # fewer are fitted in the same way from anywhere
    free = whole.model.free
    from_minimum, _ = evaluate_fit(training, whole.model, free, whole.noise, hypothesis=True, from_minimum=True)
    from_nominal, result = evaluate_fit(training, whole.known, free, whole.noise, hypothesis=True)
    apart = (from_minimum.values - from_nominal.values)[free]
    assert np.sqrt(apart @ np.linalg.solve(result.covariance[np.ix_(free, free)], apart)) < APART
    moved = (from_minimum.values - whole.model.values)[free]
    assert np.sqrt(moved @ np.linalg.solve(result.covariance[np.ix_(free, free)], moved)) > APART


def test_a_fit_without_uncertainties_has_the_same_values(samples: Samples) -> None:
    model = new_model(samples.machine).with_mounts(samples.mounts)
    with_them, without = (
        _core.fit(
            samples.engine(model),
            samples.block(model),
            samples.reading_mm,
            noise_mm=0.5e-3,
            sweep=samples["sweep"],
            hypothesis=True,
            covariance=wanted,
        )
        for wanted in (True, False)
    )
    assert np.array_equal(without.values, with_them.values)
    assert np.array_equal(without.residual_mm, with_them.residual_mm)
    assert without.noise_mm == with_them.noise_mm
    assert (without.covariance.size, without.correlation) == (0, 1.0)
