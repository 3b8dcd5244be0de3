"""Six elements with functions of one state: where all of them are at fault, and where one of them alone is."""

from __future__ import annotations

from pathlib import Path

import pytest

from hexdbb.diagnosis import noise_of
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.each_element import or_at_each_element
from hexdbb.learned import Learned
from hexdbb.model import new_model
from hexdbb.record import read_record
from hexdbb.samples import Samples
from hexdbb.samples.places import with_set_up_of

FOREIGN = Path(__file__).parents[2] / "data" / "foreign"


def search_in(name: str) -> Search:
    samples = Samples.of([read_record(FOREIGN / f"{name}.parquet")])
    model = with_set_up_of(samples, new_model(samples.machine))
    return Search(Engine(samples, model, noise_of(samples), DEFAULT), (), DEFAULT)


@pytest.fixture(scope="module")
def lobed() -> Search:
    return search_in("balls-lobed")


def test_six_lobed_balls_are_six_functions_of_the_angle(lobed: Search) -> None:
    found = or_at_each_element(lobed, lobed.root)
    (function,) = found.hypotheses
    assert isinstance(function, Learned)
    assert function.name == "learned:leg:each:joint_angle"
    assert function.variable.count > Learned.parse(function.name).variable.count, "thirteen lobes need more splines"
    assert found.trial.left < 1.02


def test_nothing_changes_where_nothing_is_learned_or_all_is_explained(lobed: Search) -> None:
    found = or_at_each_element(lobed, lobed.root)
    assert or_at_each_element(lobed, found) is found
    lobed.learns = False
    assert or_at_each_element(lobed, lobed.root) is lobed.root
    lobed.learns = True


def test_one_leg_is_not_six_though_six_functions_explain_as_much() -> None:
    search = search_in("socket-ridged")
    assert or_at_each_element(search, search.root) is search.root
