"""Faults far larger than their effects' priors expect: a joint millimetres off its place is still one off its place."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.discovery import discover
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.engine import Engine
from hexdbb.ledger import add_effect
from hexdbb.model import Model, new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case

JOINT_OFF_BY = (0.3, 27.0, -21.0)
"""Error of a joint's place along x, y and z, in multiples of its prior standard deviation of 0.05 mm."""


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of([case("joint_offset-d0-x30-calibrate-s6").record()])


@pytest.fixture(scope="module")
def engine(samples: Samples) -> Engine:
    return Engine(samples, new_model(samples.machine).with_mounts(samples.mounts), judging_noise(samples).noise)


def moved(engine: Engine, sigmas: tuple[float, ...]) -> Model:
    """Return a model whose joint 3 is off its place by so many prior standard deviations."""
    model = engine.with_effect(engine.start, "joint_offset", ["3"])
    mine = [each.effect == "joint_offset" and each.element == "3" for each in model.parameters()]
    values = model.values.copy()
    values[mine] = np.array(sigmas) * model.prior_sigma[mine]
    return model.with_values(values)


def test_what_is_as_expected_keeps_its_normal_prior(engine: Engine) -> None:
    assert (engine.prior_scale(moved(engine, (1.0, -1.5, 0.5))) == 1.0).all()


def test_what_is_larger_has_a_wider_prior(engine: Engine) -> None:
    model = moved(engine, JOINT_OFF_BY)
    scale = engine.prior_scale(model)
    mine = [each.effect == "joint_offset" and each.element == "3" for each in model.parameters()]
    tail = DEFAULT.prior_tail
    expected = ((tail + sum(each**2 for each in JOINT_OFF_BY)) / (tail + 3.0)) ** 0.5
    assert scale[mine] == pytest.approx(np.full(3, expected))
    assert (np.delete(scale, np.flatnonzero(mine)) == 1.0).all()
    fitted = engine.linearised(model)
    assert np.sum(fitted.linear.standing**2) == pytest.approx(
        np.sum((fitted.model.values[fitted.free] / fitted.prior_sigma) ** 2)
    )


def test_a_joint_far_off_its_place_is_named_for_sure(samples: Samples) -> None:
    found = discover(samples, new_model(samples.machine), with_tables=False)
    assert found.verdict == "effect"
    (cause,) = found.causes
    assert cause.effect == "joint_offset"
    assert {each.element for each in cause.values} == {"3"}
    assert max(abs(each.value) for each in cause.values) > 1.0  # millimetres, where some hundredths are expected


def test_what_is_learned_already_keeps_the_prior_that_it_was_learned_with(samples: Samples) -> None:
    """However far from it: a learned function alone in a model is not the effect that is tried."""
    model = add_effect(samples, new_model(samples.machine), "learned:slider:2:position").model
    mine = [each.effect == "learned:slider:2:position" for each in model.parameters()]
    far = model.with_values(np.where(mine, 10.0 * model.prior_sigma, model.values))
    engine = Engine(samples, far.with_mounts(samples.mounts), judging_noise(samples).noise)
    assert np.sqrt(np.mean((engine.base.values[mine] / engine.base.prior_sigma[mine]) ** 2)) > 1.5
    assert (engine.prior_scale(engine.base) == 1.0).all()
    assert np.isfinite(engine.linearised(engine.base).linear.log_evidence)
