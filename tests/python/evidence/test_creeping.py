"""What creeps towards an end at ball or cup is one law, not a free function of time, nor a rail that warms."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.evidence.linear.readings import Readings
from hexdbb.evidence.linear.signatures import signature_of
from hexdbb.learned import Learned
from hexdbb.learned.following import creeps
from hexdbb.learned.listed import further_hypotheses, hypotheses
from hexdbb.studies.verdicts.cases import line_of
from hexdbb_truth.forms.cases import case


def test_it_is_sought_at_ball_cup_and_joints_alone() -> None:
    places = {each.place for each in further_hypotheses() if creeps(each.variable)}
    assert places == {"ball", "cup", "slider_joint", "platform_joint"}
    assert not any(creeps(each.variable) for each in hypotheses())


def test_its_function_is_the_step_response_of_a_lag(readings: Readings) -> None:
    creep = Learned.parse("learned:cup:growth_settling@12")
    assert not creep.is_of_time
    assert not creep.variable.of_forms
    time_s = readings.state["time_s"]
    (column,) = signature_of(creep, readings).space.design(readings.state, 0).T
    assert column == pytest.approx((1.0 - np.exp(-time_s / 12.0)) / (1.0 - np.exp(-time_s[-1] / 12.0)))


@pytest.mark.parametrize("name", ["cup_settles-d0-x10-judge-s49", "cup_settles-d0-x1.5-judge-s48"])
def test_a_cup_that_creeps_is_found_at_its_place(name: str) -> None:
    """A rail that warms, by a law with a number, was named: a function of time claims to predict no other circle."""
    line = line_of(case(name), ())
    (found,) = line["found"]
    assert line["outcome"] == "right"
    assert found["name"].partition(":growth_settling@")[0] in ("learned:cup", "learned:ball")
