"""Hypotheses fitted beside each other are those fitted one after another; what cannot be fitted is told in its turn."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis import judging_noise
from hexdbb.errors import RunError
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.engine import Engine, Fitted
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.model import Model, new_model
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.simulate import Pace

EVERY = [
    (Member(Known(name, (element,))),) for name, element in (("backlash", "4"), ("servo_lag", "2"), ("backlash", "1"))
]


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of([case("backlash-x3-s1", Pace(rate_hz=2.0, instants_per_sample=4, travel_s=10.0)).record()])


def search_of(samples: Samples) -> Search:
    model = new_model(samples.machine).with_mounts(samples.mounts)
    return Search(
        Engine(samples, model, judging_noise(samples).noise), _core.effect_names("catalogue"), DEFAULT, learns=False
    )


def test_the_same_as_one_after_another(samples: Samples) -> None:
    beside, after = search_of(samples).trials, search_of(samples).trials
    found = [fitted() for fitted in beside.each_of(EVERY)]
    assert [each.log_evidence for each in found] == [after.of(each).log_evidence for each in EVERY]
    assert [beside.of(each) for each in EVERY] == found


def test_one_that_cannot_be_fitted(samples: Samples, monkeypatch: pytest.MonkeyPatch) -> None:
    search, fit = search_of(samples), Engine.fit

    def refusing(engine: Engine, model: Model, less: NDArray[np.float64] | None = None) -> Fitted:
        if model.term("servo_lag") is not None:
            raise RunError("no usable solution")
        return fit(engine, model, less=less)

    monkeypatch.setattr(Engine, "fit", refusing)
    first, second, third = search.trials.each_of(EVERY)
    with pytest.raises(RunError, match="no usable solution"):
        second()
    assert (first().members, third().members) == (EVERY[0], EVERY[2])
