"""A set less one of its effects is fitted near the whole set: nothing of what was left out stays in the model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.diagnosis import noise_of
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE

SPIKE_1, SPIKE_6, PLAY_1, PLAY_6 = (
    Member(Known(effect, (element,))) for effect in ("reversal_spike", "backlash") for element in ("1", "6")
)


def searched() -> Search:
    samples = Samples.of([case("reversal_spike-x10-s1", replace(PACE, rate_hz=0.1 * PACE.rate_hz)).record()])
    engine = Engine(samples, new_model(samples.machine).with_mounts(samples.mounts), noise_of(samples))
    return Search(engine, ("reversal_spike", "backlash"), DEFAULT, learns=False)


@pytest.mark.parametrize("left_out", [SPIKE_1, PLAY_6])
def test_an_effect_left_out_at_one_element_stays_at_the_others_alone(left_out: Member) -> None:
    every = (SPIKE_1, SPIKE_6, PLAY_1, PLAY_6)
    rest = tuple(each for each in every if each is not left_out)
    search = searched()
    fewer = search.trials.of_fewer(rest, search.trials.of(every))
    pushing = {
        (parameter.effect, parameter.element)
        for parameter, value in zip(fewer.model.parameters(), fewer.model.values, strict=True)
        if value != 0.0 and parameter.effect in ("reversal_spike", "backlash")
    }
    assert pushing == {(each.hypothesis.effect, each.hypothesis.elements[0]) for each in rest}
    alone = searched().trials.of(rest)
    np.testing.assert_allclose(fewer.left, alone.left, rtol=0.01)
