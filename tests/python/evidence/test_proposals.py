"""Instants and periods that the readings tell."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.readings import Linear, Readings, State
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.evidence.proposals.periods import vibrations
from hexdbb.evidence.proposals.proposals import proposals
from hexdbb.learned import Learned

Port = Callable[[str], np.ndarray]


def _of(linear: Linear, readings: Readings, name: str) -> list:
    found = proposals(linear, readings, Thinned(readings, 200), DEFAULT)
    return [each for each in found if each.hypothesis.name.partition("@")[0] == name]


@pytest.mark.parametrize("place", ["slider", "cup", "reading"])
def test_a_step_is_found_at_its_reading(linear: Linear, readings: Readings, port: Port, place: str) -> None:
    time_s = readings.state["time_s"]
    shift = port(place)[:, 0] * 3e-3 * (time_s >= time_s[431])
    name = f"learned:{place}:1:step" if place == "slider" else f"learned:{place}:step"
    (found,) = _of(replace(linear, residual=linear.residual + shift), readings, name)
    assert found.hypothesis.variable.instants == (pytest.approx(time_s[431], abs=0.051),)
    assert found.log_prior < 0.0


def test_two_steps_of_one_thing_are_both_found(linear: Linear, readings: Readings) -> None:
    time_s = readings.state["time_s"]
    shift = 8.0 * (time_s >= time_s[200]) - 8.0 * (time_s >= time_s[500])
    (found,) = _of(replace(linear, residual=linear.residual + shift), readings, "learned:reading:step")
    assert found.hypothesis.variable.instants == (
        pytest.approx(time_s[200], abs=0.051),
        pytest.approx(time_s[500], abs=0.051),
    )


@pytest.mark.parametrize(("period_s", "other", "found"), [(0.83, 0.0, 1), (0.83, 0.8, 0), (9.7, 0.0, 0)])
def test_what_shakes_at_one_feed_is_told_from_what_does_at_both(
    linear: Linear, readings: Readings, period_s: float, other: float, found: int
) -> None:
    """Not what swings slower than a sweep lasts: by chance it does so at one feed or another."""
    at_feed = np.where(readings.groups["feed"] == 1, 1.0, other)
    shaken = 6.0 * at_feed * np.sin(2.0 * np.pi * readings.state["time_s"] / period_s)
    shaking = replace(linear, residual=linear.residual + shaken)
    assert len(_of(shaking, readings, "learned:reading:time_period_by_feed")) == found
    periods = [each.hypothesis.variable.period for each in _of(shaking, readings, "learned:reading:time_period")]
    assert periods[0] == pytest.approx(period_s, rel=0.01)


def test_readings_without_noise_have_steps(linear: Linear, readings: Readings, port: Port) -> None:
    """What is pushed is then far above a reading's noise, by which sums of squares are lost to rounding."""
    pushes = replace(readings, ports=1e4 * readings.ports)
    shift = 1e4 * port("cup")[:, 0] * 3e-3 * (readings.state["time_s"] >= readings.state["time_s"][431])
    found = _of(replace(linear, residual=shift, own=1e4 * linear.own), pushes, "learned:cup:step")
    assert found[0].hypothesis.variable.instants[0] == pytest.approx(readings.state["time_s"][431], abs=0.051)


def test_noise_proposes_no_step(linear: Linear, readings: Readings) -> None:
    found = proposals(linear, readings, Thinned(readings, 200), DEFAULT)
    assert not [each for each in found if each.hypothesis.variable.instants]


def test_a_period_of_a_slider_is_found(linear: Linear, readings: Readings, port: Port) -> None:
    wave = port("slider")[:, 3] * 3e-3 * np.sin(2.0 * np.pi * readings.state["sliders_mm"][:, 3] / 7.3)
    found = _of(replace(linear, residual=linear.residual + wave), readings, "learned:slider:4:position_period")
    # It may be the second or third overtone of something narrow.
    assert [each.hypothesis.variable.period for each in found] == pytest.approx([7.3, 14.6, 21.9], rel=0.01)


def test_a_period_of_one_carriage_is_found(linear: Linear, readings: Readings, port: Port) -> None:
    turn = 2.0 * np.pi * readings.state["sliders_mm"][:, 1] / 16.7
    wave = port("slider_joint")[:, 3 + 2] * 3e-3 * np.sin(turn)
    found = _of(replace(linear, residual=linear.residual + wave), readings, "learned:slider_joint:2:position_period")
    assert found[0].hypothesis.variable.period == pytest.approx(16.7, rel=0.01)


@pytest.mark.parametrize("part", [1.0, 0.5])
def test_what_repeats_with_the_screw_is_no_carriage_s(
    linear: Linear, readings: Readings, port: Port, part: float
) -> None:
    period_mm = part * readings.state.machine.sliders.screw_lead_mm
    wave = port("slider_joint")[:, 3 + 2] * 3e-3 * np.sin(2.0 * np.pi * readings.state["sliders_mm"][:, 1] / period_mm)
    assert not _of(replace(linear, residual=linear.residual + wave), readings, "learned:slider_joint:2:position_period")


def test_a_period_of_the_gauge_s_scale_is_found(linear: Linear, readings: Readings) -> None:
    lines = 4.0 * np.sin(2.0 * np.pi * readings.state["gauge_scale_mm"] / 0.053)
    (found,) = _of(replace(linear, residual=linear.residual + lines), readings, "learned:reading:scale_period")
    assert found.hypothesis.variable.period == pytest.approx(0.053, rel=0.01)


def test_a_period_in_time_is_found_of_a_leg_that_swings(linear: Linear, readings: Readings, port: Port) -> None:
    swing = port("leg")[:, 1] * 3e-3 * np.sin(2.0 * np.pi * readings.state["time_s"] / 2.3)
    (found,) = _of(replace(linear, residual=linear.residual + swing), readings, "learned:leg:2:time_period")
    assert found.hypothesis.variable.period == pytest.approx(2.3, rel=0.01)


def test_a_period_in_time_is_found_of_what_pulls_at_the_platform(
    linear: Linear, readings: Readings, port: Port
) -> None:
    borne = np.sum(readings.state["force_by_pull_z"] * port("leg"), axis=1)
    pull = 3e-3 * borne * np.sin(2.0 * np.pi * readings.state["time_s"] / 2.3)
    (found,) = _of(replace(linear, residual=linear.residual + pull), readings, "learned:load:time_period")
    assert found.hypothesis.variable.period == pytest.approx(2.3, rel=0.01)


def test_of_readings_at_one_rate_no_period_is_told_from_what_it_aliases_to(linear: Linear, readings: Readings) -> None:
    assert not [*vibrations(linear, readings)]


@pytest.mark.parametrize(("place", "period_s"), [("reading", 1.0 / 49.963), ("cup", 1.0 / 4.63)])
def test_what_shakes_faster_than_readings_are_taken_is_found(
    linear: Linear, readings: Readings, port: Port, place: str, period_s: float
) -> None:
    """At 3 Hz and at 11 Hz, as slow and fast feeds have it: at one rate it cannot be told from what it aliases to."""
    is_slow = (readings.groups["feed"] == 0) | (readings.groups["circle"] == 0)
    gap_s = np.where(is_slow, 1.0 / 3.1, 1.0 / 11.3)
    time_s = np.cumsum(gap_s)
    other = replace(readings, state=State({"time_s": time_s}, readings.state.machine))
    wave = 4.0 * np.sin(2.0 * np.pi * time_s / period_s) * port(place)[:, 0] / np.abs(port(place)[:, 0]).max()
    found = {
        each.hypothesis.place: each for each in vibrations(replace(linear, residual=linear.residual + wave), other)
    }
    turns = np.ptp(time_s) / period_s
    assert found[place].hypothesis.variable.period == pytest.approx(period_s, rel=0.02 / turns)
    assert found[place].log_prior < -5.0
    assert found[place].hypothesis == Learned.parse(found[place].hypothesis.name)
