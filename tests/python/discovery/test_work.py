"""How much work a discovery does, counted: times depend on the machine, passes over the readings do not."""

from __future__ import annotations

import numpy as np
import pytest
from tests.truth.cases import case

from hexdbb import _core, measured
from hexdbb.diagnosis import noise_of
from hexdbb.discovery import discover
from hexdbb.discovery.trial import Base, fitted_base, try_effect
from hexdbb.model import new_model
from hexdbb.samples import Samples

MOST_STEPS = 20


@pytest.fixture(scope="module")
def base() -> Base:
    record = case("joint_offset-x3-s1").record()
    return fitted_base(
        Samples.of([record]),
        new_model(record.machine).with_mounts(Samples.of([record]).mounts),
        noise_of(Samples.of([record])),
    )


@pytest.mark.parametrize("effect", ["joint_offset", "lead_error", "straightness", "bar_drift"])
def test_a_trial_takes_few_passes_and_ends_no_higher_than_a_long_fit(base: Base, effect: str) -> None:
    elements = base.model.info(effect).elements[:1]
    candidate, result = try_effect(base, effect, elements)
    assert result.iterations <= MOST_STEPS
    free = [bool(each) for each in candidate.model.free]
    long = _core.fit(
        base.measured.engine(candidate.model),
        base.measured.samples,
        base.measured.reading_mm,
        noise_mm=base.noise.sigma_mm,
        free=free,
        max_iterations=200,
    )
    scale = np.array([each.prior_sigma for each in candidate.model.parameters()])[candidate.model.free]

    def cost(residual_mm: np.ndarray, values: np.ndarray) -> float:
        prior = values[candidate.model.free] / scale
        return float(residual_mm @ residual_mm) / base.noise.sigma_mm**2 + float(prior @ prior)

    assert cost(result.residual_mm, candidate.model.values) - cost(long.residual_mm, long.values) < 0.5


def test_records_are_prepared_once_for_all_fits(monkeypatch: pytest.MonkeyPatch) -> None:
    record = case("none-s1").record()
    prepared: list[int] = []
    prepare = measured.samples_of

    def counted(records, model):
        prepared.append(len(records))
        return prepare(records, model)

    monkeypatch.setattr(measured, "samples_of", counted)
    discover(Samples.of([record]), new_model(record.machine))
    assert prepared == [1]
