"""Homes: which learned functions contain a form, found by regression."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from hexdbb.evidence.forms.homes import Home, Homes, discrepancy
from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.learned import Learned
from hexdbb.learned import variables as v

Port = Callable[[str], np.ndarray]

HYPOTHESES = [
    Learned("slider", 2, v.POSITION),
    Learned("slider", 3, v.POSITION),
    Learned("slider", 2, v.VELOCITY),
    Learned("leg", 2, v.POSITION),
    Learned("slider", 2, v.DIRECTION),
]


def test_a_form_lives_where_it_acts(linear: Linear, readings: Readings, port: Port) -> None:
    homes = Homes(linear, Thinned(readings), HYPOTHESES)
    position = readings.state["sliders_mm"][:, 1]
    form = port("slider")[:, 1] * np.sin(position / 15.0)
    found = homes.of(form)
    assert found[0].hypothesis.name == "learned:slider:2:position"
    assert {each.hypothesis.element for each in found} == {2}


def test_the_size_of_a_form_is_that_of_its_push(linear: Linear, readings: Readings, port: Port) -> None:
    homes = Homes(linear, Thinned(readings), [Learned("slider", 2, v.DIRECTION)])
    form = port("slider")[:, 1] * readings.state["travel_direction"][:, 1] * 0.004
    assert homes.of(form)[0].rms_mm == pytest.approx(0.004, rel=0.05)


def test_what_geometry_imitates_has_no_home(linear: Linear, readings: Readings) -> None:
    homes = Homes(linear, Thinned(readings), HYPOTHESES)
    assert homes.of(linear.own @ np.arange(1.0, 6.0)) == []


def test_many_at_once_are_as_one_by_one(linear: Linear, readings: Readings, port: Port) -> None:
    homes = Homes(linear, Thinned(readings), HYPOTHESES)
    forms = port("slider")[:, :3] * readings.state["sliders_mm"][:, :3]
    together = [[each.hypothesis.name for each in found] for found in homes.of_each(forms)]
    assert together == [[each.hypothesis.name for each in homes.of(form)] for form in forms.T]


def test_only_what_changes_with_time_lives_in_functions_of_time(linear: Linear, readings: Readings, port: Port) -> None:
    constant, in_time = (
        Learned.parse("learned:platform_joint:2:constant"),
        Learned.parse("learned:platform_joint:2:time"),
    )
    # A geometry of one value, which imitates no offset of a joint.
    one = replace(linear, own=linear.own[:, :1], standing=np.zeros(1))
    homes = Homes(one, Thinned(readings), [constant, in_time, Learned.parse("learned:slider:2:time_position")])
    push = port("platform_joint")[:, 3]
    time_s = readings.state["time_s"]
    assert [each.hypothesis for each in homes.of(push)] == [constant]
    assert [each.hypothesis for each in homes.of(push * np.expm1(-time_s / 10.0))] == [in_time]


def test_each_leg_follows_a_law_of_its_own_in_the_effects_own_variable_alone() -> None:
    """Legs sag by their force; where each leg's place says so too, nearly, it says what a screw may do as well."""
    force, place = (Learned.parse(f"learned:leg:all:{name}") for name in ("leg_force", "position"))
    groups = discrepancy([Home(force, 1.0, 0.01), Home(place, 0.989, 0.01)])
    assert [len(each) for each in groups] == [7, 1]
    assert {each.element for each in groups[0]} == {0, 1, 2, 3, 4, 5, 6}
    assert groups[1] == (place,)


def test_what_is_set_up_has_one_form() -> None:
    """A gauge that is read late is late for every slider, by the same second order of the motion, and by the feed."""
    lag, *others = (Learned.parse(f"learned:slider:all:{e}") for e in ("velocity", "acceleration", "velocity_by_feed"))
    assert [len(each) for each in discrepancy([Home(lag, 1.0, 0.01)])] == [7, 1, 1]
    assert discrepancy([Home(lag, 1.0, 0.01)], is_set_up=True) == [(lag,), *((each,) for each in others)]


def test_a_form_alone_is_near_an_effect_and_no_word_for_it(linear: Linear, readings: Readings, port: Port) -> None:
    position, of_form = (Learned.parse(f"learned:slider:2:{name}") for name in ("position", "fine_position"))
    homes = Homes(linear, Thinned(readings), [position], of_forms=[of_form])
    signature = port("slider")[:, [1]] * np.sin(readings.state["sliders_mm"][:, [1]] / 15.0)
    assert [each.hypothesis for each in homes.of(signature[:, 0])] == [position]
    (near,) = homes.around_each(signature)
    assert {each.hypothesis: each.is_of_forms for each in near} == {position: False, of_form: True}


def test_what_changes_with_time_at_the_ball_may_seat_itself_after_each_fixing() -> None:
    in_time, since = (Learned.parse(f"learned:ball:{name}") for name in ("time", "time_since_fixing"))
    assert discrepancy([Home(in_time, 1.0, 0.01)]) == [(in_time,), (since,)]
    assert in_time.after_each_fixing == since
    assert Learned.parse("learned:leg:2:time").after_each_fixing is None
