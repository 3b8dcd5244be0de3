"""How much work a discovery does, counted: times depend on the machine, passes over the readings do not."""

from __future__ import annotations

import numpy as np
import pytest
from tests.truth.cases import case

from hexdbb import _core
from hexdbb.diagnosis import noise_of
from hexdbb.discovery import discover
from hexdbb.discovery.trial import Base, fitted_base, try_effect
from hexdbb.model import new_model
from hexdbb.samples import Samples, whole

MOST_STEPS = 20


@pytest.fixture(scope="module")
def base() -> Base:
    record = case("joint_offset-x3-s1").record()
    samples = Samples.of([record])
    return fitted_base(samples, new_model(record.machine).with_mounts(samples.mounts), noise_of(samples))


@pytest.mark.parametrize("effect", ["joint_offset", "lead_error", "straightness", "bar_drift"])
def test_a_trial_takes_few_passes_and_ends_no_higher_than_a_long_fit(base: Base, effect: str) -> None:
    elements = base.model.info(effect).elements[:1]
    candidate, result = try_effect(base, effect, elements)
    assert result.iterations <= MOST_STEPS
    free = [bool(each) for each in candidate.model.free]
    long = _core.fit(
        base.samples.engine(candidate.model),
        base.samples.block(candidate.model),
        base.samples.reading_mm,
        noise_mm=base.noise.sigma_mm,
        free=free,
        max_iterations=200,
    )
    scale = candidate.model.prior_sigma[candidate.model.free]

    def cost(residual_mm: np.ndarray, values: np.ndarray) -> float:
        prior = values[candidate.model.free] / scale
        return float(residual_mm @ residual_mm) / base.noise.sigma_mm**2 + float(prior @ prior)

    assert cost(result.residual_mm, candidate.model.values) - cost(long.residual_mm, long.values) < 0.5


def test_records_are_prepared_once_for_all_fits(monkeypatch: pytest.MonkeyPatch) -> None:
    record = case("none-s1").record()
    derived: list[int] = []
    complete = whole.state_columns

    def counted(records):
        derived.append(len(records))
        return complete(records)

    monkeypatch.setattr(whole, "state_columns", counted)
    discover(Samples.of([record]), new_model(record.machine))
    assert derived == [1]
