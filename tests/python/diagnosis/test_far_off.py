"""A model that leaves many times the noise: its fit ends where what it leaves is its own error."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hexdbb.diagnosis import noise_of
from hexdbb.diagnosis.fit import evaluate_fit
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE


@pytest.mark.parametrize("name", ["backlash-x30-s1", "backlash-x100-s2", "servo_lag-x100-s1"])
def test_a_hypothesis_far_off_converges_to_the_minimum_of_a_diagnosis(name: str) -> None:
    record = case(name, replace(PACE, rate_hz=PACE.rate_hz / 3.0)).record()
    samples = Samples.of([record])
    model, noise = new_model(record.machine).with_mounts(samples.mounts), noise_of(samples)
    _, hypothesis = evaluate_fit(samples, model, model.free, noise, hypothesis=True)
    _, diagnosis = evaluate_fit(samples, model, model.free, noise)
    assert diagnosis.rms_after_mm > 5.0 * noise.sigma_mm
    assert hypothesis.termination.startswith("Converged")
    assert hypothesis.iterations < 20
    # What a thousandth of its error is worth, no verdict depends on; either may end in the better of several minima.
    assert hypothesis.rms_after_mm < 1.001 * diagnosis.rms_after_mm
