"""What is asked for twice is made once: the fit that a search begins with, and signatures about one model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.diagnosis import noise_of
from hexdbb.evidence.engine import Engine
from hexdbb.evidence.fitted_model import FittedModel
from hexdbb.model import Model, new_model
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE

EFFECTS = ("backlash", "servo_lag")


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of([case("backlash-x3-s1", replace(PACE, rate_hz=0.1 * PACE.rate_hz)).record()])


@pytest.fixture(scope="module")
def model(samples: Samples) -> Model:
    return new_model(samples.machine).with_mounts(samples.mounts)


@pytest.fixture(scope="module")
def fitted(samples: Samples, model: Model) -> FittedModel:
    return FittedModel.of(samples, model, noise_of(samples))


@pytest.fixture(scope="module")
def engine(samples: Samples, model: Model, fitted: FittedModel) -> Engine:
    return Engine(samples, model, noise_of(samples), fitted=fitted)


def test_a_fit_serves_the_model_it_is_of(engine: Engine, samples: Samples, model: Model, fitted: FittedModel) -> None:
    assert engine.base is fitted.model
    alone = Engine(samples, model, noise_of(samples))
    assert np.array_equal(alone.base.values, fitted.model.values)
    assert np.array_equal(alone.residual_mm, fitted.residual_mm)


@pytest.mark.parametrize("differs", ["free", "values", "effects"])
def test_a_fit_of_another_model_does_not(differs: str, samples: Samples, model: Model, fitted: FittedModel) -> None:
    held = model.free.copy()
    held[0] = False
    other = {
        "free": model.with_free(held),
        "values": model.with_values(model.values + 0.01 * model.prior_sigma),
        "effects": replace(model, terms=model.terms[:-1]),
    }[differs]
    assert not fitted.is_of(other)
    assert Engine(samples, other, noise_of(samples), fitted=fitted).base is not fitted.model


def test_signatures_about_one_model_are_made_once(engine: Engine) -> None:
    table, whose = engine.signatures(engine.start, EFFECTS)
    assert engine.signatures(engine.start, EFFECTS)[0] is table
    assert {each[0] for each in whose} == set(EFFECTS)
    moved = engine.start.with_values(engine.start.values + 0.5 * engine.start.prior_sigma * engine.start.free)
    assert not np.array_equal(engine.signatures(moved, EFFECTS)[0], table)
    assert engine.signatures(engine.start, EFFECTS, 1.0)[0] is not table
    for effect in ("gravity_sag", "joint_offset", "sample_delay", "lead_error"):
        engine.signatures(engine.start, (effect,))
    again, _ = engine.signatures(engine.start, EFFECTS)
    assert again is not table
    assert np.array_equal(again, table)
