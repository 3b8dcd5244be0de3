"""How a set predicts the first grouping that it claims: the same figure as among all groupings, for less."""

from __future__ import annotations

import math

import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.learned import Learned
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


@pytest.fixture(scope="module")
def search() -> Search:
    samples = Samples.of([case("bar_gain-d0-x3-calibrate-s1").record()])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    return Search(Engine(samples, model, judging_noise(samples).noise), ("bar_gain", "bar_drift"), DEFAULT)


def trial_of(search: Search, *names: str) -> Trial:
    members = []
    for name in names:
        if name.startswith("learned:"):
            hypothesis = Learned.parse(name)
            signature = search.thinned.signature(hypothesis)
            members.append(Member(hypothesis, signature.prior_factor(30.0), 1e-3))
        else:
            members.append(Member(Known(name, (search.engine.base.info(name).elements[0],), is_whole=True)))
    return search.trials.of(tuple(members))


@pytest.mark.parametrize(
    "names",
    [("bar_gain",), ("bar_gain", "learned:reading:time"), ("learned:reading:time",), ()],
    ids=["known", "known and time", "time alone", "nothing"],
)
def test_it_is_that_of_all_groupings(search: Search, names: tuple[str, ...]) -> None:
    trial = trial_of(search, *names)
    found = search.first_error(trial)
    checked = search.checked_trial(trial)
    claimed = [held.after for grouping, held in checked.heldout.items() if grouping in checked.claimed]
    if claimed:
        assert found == pytest.approx(claimed[0], rel=1e-9)
    else:
        assert math.isnan(found)
    assert bool(claimed) is bool(names)
