"""Signatures that are asked for twice about one model are made once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.diagnosis import noise_of
from hexdbb.evidence.linear.engine import Engine
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE

EFFECTS = ("backlash", "servo_lag")


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of([case("backlash-x3-s1", replace(PACE, rate_hz=0.1 * PACE.rate_hz)).record()])


@pytest.fixture(scope="module")
def engine(samples: Samples) -> Engine:
    return Engine(samples, new_model(samples.machine).with_mounts(samples.mounts), noise_of(samples))


def test_signatures_about_one_model_are_made_once(engine: Engine) -> None:
    table, whose = engine.absent.signatures(engine.start, EFFECTS)
    assert engine.absent.signatures(engine.start, EFFECTS)[0] is table
    assert {each[0] for each in whose} == set(EFFECTS)
    moved = engine.start.with_values(engine.start.values + 0.5 * engine.start.prior_sigma * engine.start.free)
    assert not np.array_equal(engine.absent.signatures(moved, EFFECTS)[0], table)
    assert engine.absent.signatures(engine.start, EFFECTS, 1.0)[0] is not table
    for effect in ("gravity_sag", "joint_offset", "sample_delay", "lead_error"):
        engine.absent.signatures(engine.start, (effect,))
    again, _ = engine.absent.signatures(engine.start, EFFECTS)
    assert again is not table
    assert np.array_equal(again, table)
