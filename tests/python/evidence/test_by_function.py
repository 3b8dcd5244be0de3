"""Functions in place of what only fits: of an effect's form, and of a position that repeats."""

from __future__ import annotations

from functools import cache

import pytest
from tests.truth.learned_closing import case_of

from hexdbb.diagnosis import diagnose, judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.refine import finely_tuned
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import predicts
from hexdbb.evidence.verdict.by_function import or_by_functions
from hexdbb.evidence.verdict.by_period import with_periods
from hexdbb.learned import Learned
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb.samples.places import with_set_up_of

LAG = Member(Known("servo_lag", ("1",)))
SAG = Member(Known("gravity_sag", tuple("123456"), is_whole=True))


@cache
def search_in(seed: int, *effects: str) -> Search:
    """Return the search for what is missing on a machine with a known fault and one outside the catalogue."""
    record = case_of(seed, 0.1, "judge").record()
    samples = Samples.of([record])
    model = diagnose(samples, new_model(record.machine), check_held_out=False).model
    return Search(Engine(samples, with_set_up_of(samples, model), judging_noise(samples).noise), effects, DEFAULT)


def with_learned(search: Search, base: Node, name: str) -> Node:
    (node,) = search.tried(base, [search.screen(base).scored(Learned.parse(name))])
    search.nodes.append(node)
    return node


def test_a_function_takes_the_place_of_an_effect_that_fits_by_its_form() -> None:
    """A plate bends as it is tilted; a ball that sits otherwise in one set-up follows it by a step in every circle."""
    search = search_in(19, "servo_lag", "ball_eccentricity")
    base = search.node((LAG,), near=search.root)
    learned = with_learned(search, base, "learned:ball:roll")
    node = search.node((LAG, Member(Known("ball_eccentricity", ("3",)))), near=search.root)
    assert node.trial.left < learned.trial.left < 1.5
    assert node.score > learned.score
    assert predicts(search, learned)
    assert or_by_functions(search, node) is learned
    assert or_by_functions(search, learned) is learned


def test_a_waving_guideway_repeats_in_place_of_free_functions() -> None:
    search = search_in(1, "gravity_sag")
    base = search.node((SAG,), near=search.root)
    free = finely_tuned(search, with_learned(search, base, "learned:guideway:3:position"))
    assert free.trial.left < 1.1
    found = with_periods(search, free)
    (waves,) = (each for each in found.hypotheses if isinstance(each, Learned))
    assert (waves.place, waves.element) == ("guideway", 3)
    assert waves.variable.period == pytest.approx(48.03, abs=0.05)
    assert found.score > free.score


@pytest.mark.parametrize("name", ["learned:slider:2:velocity", "learned:slider:2:position_period@8"])
def test_nothing_but_a_free_function_of_a_position_is_asked(name: str) -> None:
    search = search_in(1, "gravity_sag")
    node = with_learned(search, search.node((SAG,), near=search.root), name)
    assert with_periods(search, node) is node
