"""What sits otherwise in every circle: steps of ball and cup where one begins, as forms of what is at their place."""

from __future__ import annotations

import pytest

from hexdbb.evidence.linear.readings import Readings
from hexdbb.evidence.proposals.learnable import by_circle
from hexdbb.studies.verdicts.cases import line_of
from hexdbb_truth.forms.cases import case


def test_steps_are_where_circles_begin(readings: Readings) -> None:
    found = by_circle(readings)
    assert [each.place for each in found] == ["ball", "cup"]
    time_s, circle = readings.state["time_s"], readings.groups["circle"]
    assert found[0].variable.instants == pytest.approx([time_s[circle == each].min() for each in (1, 2)])


@pytest.mark.long
def test_a_ball_that_sits_otherwise_in_every_circle_is_named_for_sure() -> None:
    """A tenth of its form, which no other circle tells: functions of time, as free, claimed that they do."""
    line = line_of(case("ball_eccentricity-d10-x30-calibrate-s36"), ())
    assert (line["outcome"], line["grade"], line["after_adding"]) == ("right", "effect", "none")
