"""One function that grows by the place stands before several effects of one kind that grow to say it."""

from __future__ import annotations

from pathlib import Path

import pytest

from hexdbb.diagnosis import noise_of
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.by_growth import or_one_that_grows
from hexdbb.learned import Learned, number_of
from hexdbb.model import new_model
from hexdbb.record import read_record
from hexdbb.samples import Samples
from hexdbb.samples.places import with_set_up_of

RECORD = Path(__file__).parents[2] / "data" / "foreign" / "rail-end-lifts.parquet"
SHRINKS, GROWS = (Member(Known("screw_thermal", (each,))) for each in "64")
LAG = Member(Known("servo_lag", ("1",)))


@pytest.fixture(scope="module")
def search() -> Search:
    """A coolant tank under one end of a rail lifts that, by 1 - exp(-t / 522 s)."""
    samples = Samples.of([read_record(RECORD)])
    model = with_set_up_of(samples, new_model(samples.machine))
    return Search(Engine(samples, model, noise_of(samples), DEFAULT), ("screw_thermal", "servo_lag"), DEFAULT)


def test_a_rail_whose_end_lifts_is_no_two_screws(search: Search) -> None:
    screws = search.node((SHRINKS, GROWS), near=search.root)
    assert screws.trial.left < 1.0, "they explain all"
    found = or_one_that_grows(search, screws)
    (rail,) = found.hypotheses
    assert isinstance(rail, Learned)
    assert (rail.place, rail.element) == ("vertical", 3)
    assert number_of(rail.variable) == pytest.approx(522.0, rel=0.03)
    assert found.score > screws.score


def test_one_effect_or_two_kinds_are_left_alone(search: Search) -> None:
    for members in ((SHRINKS,), (SHRINKS, LAG)):
        node = search.node(members, near=search.root)
        assert or_one_that_grows(search, node) is node


def test_where_nothing_is_learned_the_screws_stay(search: Search) -> None:
    screws = search.node((SHRINKS, GROWS), near=search.root)
    search.learns = False
    assert or_one_that_grows(search, screws) is screws
    search.learns = True
