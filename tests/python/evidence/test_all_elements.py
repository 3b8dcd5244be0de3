"""An effect at all its elements, of either sign at each: pitch errors of six screws, beside play of every drive."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pytest
from tests.truth.closing import PACE, machine_of

from hexdbb.diagnosis import diagnose, judging_noise
from hexdbb.discovery import AutoStep, discover_all
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.forms.form import _by_variable
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.search.all_elements import _are_apart
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.verdict import Verdict, judge
from hexdbb.learned import Learned
from hexdbb.ledger import add_effect
from hexdbb.model import Model, new_model
from hexdbb.plan import load_plan
from hexdbb.samples import Samples
from hexdbb.samples.places import with_set_up_of
from hexdbb_truth.simulate import simulate

PLAN = Path(__file__).parents[3] / "docs" / "plans" / "best-7.toml"
KNOWN = ("backlash", "gravity_sag", "pitch_cyclic")


@cache
def driven() -> Samples:
    """Return the readings of a machine with play and a pitch error in every drive, and legs that give."""
    return Samples.of([simulate(machine_of(1), load_plan(PLAN), 100, PACE)])


@cache
def fitted() -> Model:
    samples = driven()
    return diagnose(samples, new_model(samples.machine), check_held_out=False).model


def judged(model: Model) -> Verdict:
    model = with_set_up_of(driven(), model)
    return judge(Search(Engine(driven(), model, judging_noise(driven()).noise), KNOWN, DEFAULT, learns=False))


def test_pitch_errors_of_six_screws_are_one_cause() -> None:
    verdict = judged(fitted())
    assert verdict.grade == "effect"
    assert {each.hypothesis.name for each in verdict.found} == {*KNOWN}
    assert verdict.node.trial.left < 1.1


@pytest.mark.long
def test_those_of_four_screws_are_where_the_model_has_two() -> None:
    """They are no form of the play that the model has, though they explain less than a tenth of what that does."""
    model = fitted()
    for effect in ("backlash", "gravity_sag", "pitch_cyclic:3", "pitch_cyclic:6"):
        model = add_effect(driven(), model, effect).model
    verdict = judged(model)
    assert verdict.grade == "effect"
    assert [each.hypothesis.name for each in verdict.found] == ["pitch_cyclic:1:2:4:5"]


@pytest.mark.long
def test_discover_auto_finds_them_all_beside_what_is_learned() -> None:
    *steps, last = discover_all(driven(), fitted())
    assert {step.choice for step in steps if isinstance(step, AutoStep)} == {*KNOWN}
    assert not isinstance(last, AutoStep) and last.verdict == "none"


@pytest.mark.parametrize(
    ("shares", "together", "are_apart"),
    [
        ([0.2, 0.15, 0.2, 0.15, 0.2, 0.1], 1.0, True),
        ([0.2, 0.0, 0.3, 0.2, 0.3, 0.0], 1.0, True),
        # Each says nearly all that six say together: lags of six drives.
        ([0.8, 0.7, 0.9, 0.8, 0.7, 0.8], 1.0, False),
        # Together they say what none says alone: leads that cancel but for a bow.
        ([0.02, 0.05, 0.05, 0.03, 0.05, 0.1], 1.0, False),
        ([0.5, 0.5, 0.0, 0.0, 0.001, 0.0], 1.0, False),
    ],
    ids=["six", "four", "alike", "cancelling", "two"],
)
def test_elements_are_apart_where_what_each_explains_adds_up(
    shares: Sequence[float], together: float, *, are_apart: bool
) -> None:
    assert _are_apart(shares, together, DEFAULT) is are_apart


def test_steps_of_a_form_at_several_elements_stay_as_many() -> None:
    """Steps are functions of time, but their instants are given, so that their number must not be reduced."""
    steps = Learned.parse("learned:ball:step@100/200/300/400/500/600/700/800/900/1000/1100/1200/1300")
    drift = Learned.parse("learned:leg:1:fine_time")
    ((few_steps,), (few_splines,)) = _by_variable([(steps,), (drift,)])
    assert few_steps == steps
    assert few_splines.size < drift.size
