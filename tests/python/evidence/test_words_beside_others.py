"""Beside other effects: a formula must say what a function does, and six sizes are not told from one."""

from __future__ import annotations

from tests.foreign_records import samples_of

from hexdbb import _core
from hexdbb.diagnosis import noise_of
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.refine import finely_tuned
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.known_words import in_known_words
from hexdbb.evidence.verdict.rivals_of_several import of_one_size
from hexdbb.learned import Learned
from hexdbb.model import new_model
from hexdbb.samples.places import with_set_up_of


def search_in(name: str, effects: list[str]) -> Search:
    samples = samples_of(name)
    model = with_set_up_of(samples, new_model(samples.machine))
    return Search(Engine(samples, model, noise_of(samples), DEFAULT), effects, DEFAULT)


def with_function(search: Search, known: Node, name: str) -> Node:
    (node,) = search.tried(known, [search.screen(known).scored(Learned.parse(name))])
    tuned = finely_tuned(search, node)
    search.nodes.append(tuned)
    return tuned


def test_a_leg_that_a_motor_shakes_is_no_pitch_error_beside_a_ball_that_sits_otherwise() -> None:
    """The pitch error left ten variances of noise, the function less than two, of 222: little beside the ball's."""
    search = search_in("leg-shaken-by-motor", ["ball_eccentricity", "pitch_cyclic"])
    ball = search.node((Member(Known("ball_eccentricity", ("3",))),), near=search.root)
    node = with_function(search, ball, "learned:slider_joint:1:screw_wave_velocity")
    pitch = search.trials.of((Member(Known("ball_eccentricity", ("3",))), Member(Known("pitch_cyclic", ("1",)))))
    assert pitch.left > 2.0 * node.trial.left
    assert in_known_words(search, node).trial.names == node.trial.names


def test_six_screws_that_grow_are_not_told_from_a_gauge_that_drifts_on_circles_of_one_radius() -> None:
    search = search_in("drift-on-one-radius", list(_core.effect_names("catalogue")))
    every = tuple("123456")
    screws = Known("screw_thermal", every, True)
    others = Member(Known("backlash", ("1",))), Member(Known("servo_lag", every, True))
    node = search.node((*others, Member(screws)), near=search.root)
    drift = search.node((*others, Member(Known("bar_drift", ("1",), True))), near=node)
    assert node.score > drift.score  # six sizes, each with its form, have more evidence
    assert of_one_size(search, node, screws) == [" + ".join(drift.trial.names)]
    assert of_one_size(search, node, Known("backlash", ("1",))) == []
