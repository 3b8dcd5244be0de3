"""An effect at some of its elements: where it has a size, and no sign that it cannot have."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from tests.foreign_records import samples_of

from hexdbb.diagnosis import noise_of
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.some_elements import at_those_seen
from hexdbb.model import new_model
from hexdbb.samples.places import with_set_up_of

SIX = tuple("123456")
SPIKES, LAGS = Member(Known("reversal_spike", SIX, is_whole=True)), Member(Known("servo_lag", SIX, is_whole=True))
BOW = Member(Known("straightness", ("2",)))


def search_in(name: str, effects: Sequence[str]) -> Search:
    samples = samples_of(name)
    model = with_set_up_of(samples, new_model(samples.machine))
    return Search(Engine(samples, model, noise_of(samples), DEFAULT), effects, DEFAULT)


def found_at(name: str, beside: Sequence[Member], effect: Member) -> Node | None:
    known = (each.hypothesis for each in (*beside, effect))
    search = search_in(name, tuple(each.effect for each in known if isinstance(each, Known)))
    return at_those_seen(search, search.node(beside, near=search.root), (*beside, effect))


@pytest.mark.parametrize("beside", [(), (BOW,)], ids=["alone", "beside a bow"])
def test_an_effect_is_told_at_each_element_where_it_is_seen(beside: Sequence[Member]) -> None:
    found = found_at("three-stick-rail-bows", beside, SPIKES)
    assert found is not None
    expected = {*(f"reversal_spike:{each}" for each in "145"), *(each.hypothesis.name for each in beside)}
    assert set(found.trial.names) == expected


def test_an_effect_that_is_seen_at_all_its_elements_is_one_at_all() -> None:
    """The time in which six spikes decay is one for all, and most of a second, whatever their travel."""
    search = search_in("sliders-stick", ("reversal_spike",))
    whole = search.trials.of((SPIKES,))
    values = zip(whole.model.parameters(), whole.model.values, strict=True)
    times = {float(value) for each, value in values if (each.effect, each.name) == ("reversal_spike", "log_time")}
    assert len(times) == 1
    assert 0.5 < 0.05 * np.exp(times.pop()) < 1.5
    assert whole.left < 0.05 * search.root.trial.left
    assert at_those_seen(search, search.root, (SPIKES,)) is None


def test_an_effect_that_explains_little_is_none() -> None:
    """Lags explain little of what sliders do that stick at their reversals."""
    assert found_at("three-stick-rail-bows", (BOW,), LAGS) is None


def test_of_values_that_all_have_the_wrong_sign_the_farthest_off_stands_for_none() -> None:
    found = found_at("drives-lag-apart", (), LAGS)
    assert found is not None
    assert {"servo_lag:3", "servo_lag:6"} <= set(found.trial.names)
    assert not found.trial.refused


def test_what_all_share_is_seen_at_none() -> None:
    """Two drives that lag beside legs that grow were six, of which four lagged by what is a delay as well."""
    grow = Member(Known("leg_thermal", ("1",), is_whole=True))
    found = found_at("two-lag-legs-grow", (grow,), LAGS)
    assert found is not None
    assert set(found.trial.names) == {"leg_thermal", "servo_lag:3", "servo_lag:4"}
