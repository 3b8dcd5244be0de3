"""Two elements with functions of one state: compared at once, wherever either stands among all that is listed."""

from __future__ import annotations

from pathlib import Path

import pytest

from hexdbb.diagnosis import noise_of
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.two_elements import best_pairs, or_at_two_elements
from hexdbb.model import new_model
from hexdbb.record import read_record
from hexdbb.samples import Samples
from hexdbb.samples.places import with_set_up_of

FOREIGN = Path(__file__).parents[2] / "data" / "foreign"


def search_in(name: str) -> Search:
    samples = Samples.of([read_record(FOREIGN / f"{name}.parquet")])
    model = with_set_up_of(samples, new_model(samples.machine))
    return Search(Engine(samples, model, noise_of(samples), DEFAULT), (), DEFAULT)


@pytest.mark.parametrize(
    ("name", "pair"),
    [
        ("screws-whip", {"learned:slider:3:velocity", "learned:slider:6:velocity"}),
        ("two-dents", {"learned:vertical:2:position", "learned:lateral:1:position"}),
    ],
)
def test_the_pair_that_is_there_has_the_most_evidence(name: str, pair: set[str]) -> None:
    first, *others = best_pairs(search_in(name))
    assert {each.name for each in first.functions} == pair
    assert all(each.log_evidence <= first.log_evidence for each in others)
    names = [frozenset(one.name for one in each.functions) for each in (first, *others)]
    assert len({*names}) == len(names)


def test_a_finer_pair_is_tried_where_it_may_be() -> None:
    best = best_pairs(search_in("two-dents"))[0]
    assert all(one.variable.count > 24 for one in best.functions)


def test_nothing_changes_where_nothing_is_learned() -> None:
    search = search_in("screws-whip")
    search.learns = False
    assert or_at_two_elements(search, search.root) is search.root
