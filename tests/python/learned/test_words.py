"""Words for functions: each synthetic form is named with its numbers, and no form is named where there is none."""

from __future__ import annotations

import re

import numpy as np
import pytest

from hexdbb.learned import Curve, Learned, describe

AT = np.linspace(100.0, 500.0, 41)
RATE = np.linspace(-0.02, 0.02, 41)


def curve(at: np.ndarray, value_um: np.ndarray, *, column: str = "sliders_mm", unit: str = "mm", times: str = ""):
    rng = np.random.default_rng(3)
    noisy_mm = 1e-3 * (value_um + rng.normal(0.0, 0.05, len(at)))
    return Curve("position", unit, column, times, at, noisy_mm, np.full(len(at), 5e-5), np.full(len(at), 10.0))


def numbers(text: str) -> list[float]:
    return [float(each) for each in re.findall(r"-?\d+\.?\d*(?:e[+-]?\d+)?", text)]


@pytest.mark.parametrize(("height", "name"), [(12.0, "bump"), (-7.0, "dip")])
def test_a_bump_is_named_with_place_height_and_width(height: float, name: str) -> None:
    width = 60.0
    bell = height * np.exp(-4.0 * np.log(2.0) * ((AT - 262.0) / width) ** 2) + 3.0
    form = describe(curve(AT, bell))
    assert form.kind == "bump" and f"a {name} of" in form.text
    assert numbers(form.text) == pytest.approx([abs(height), 262.0, width], rel=0.03)


def test_a_sine_is_named_with_period_and_amplitude() -> None:
    form = describe(curve(AT, 4.0 * np.sin(2.0 * np.pi * AT / 87.0 + 0.7) - 2.0))
    assert form.kind == "sine"
    assert numbers(form.text) == pytest.approx([87.0, 4.0], rel=0.03)


def test_a_sine_of_a_periodic_variable_has_a_part_of_its_period() -> None:
    at = np.linspace(0.0, 5.0, 41)
    form = describe(curve(at, 2.0 * np.cos(2.0 * np.pi * at / 2.5)), period=5.0)
    assert form.kind == "sine"
    assert numbers(form.text) == pytest.approx([2.5, 2.0], rel=0.03)


def test_a_step_is_named_with_the_sign_of_its_variable() -> None:
    form = describe(curve(RATE, 3.0 * np.sign(RATE) + 1.0, column="slider_joint_rate_rad_s", unit="rad/s"))
    assert form.kind == "step" and "with the sign of the position" in form.text
    assert numbers(form.text) == pytest.approx([6.0], rel=0.03)


@pytest.mark.parametrize(
    ("below", "above", "ends", "words"),
    [
        (0.03, 0.05, (220.0, 330.0), r"constant from .* mm to .* mm; .* below, .* above"),
        (0.0, 0.05, (330.0,), r"constant up to .* mm, then .* µm per mm"),
        (-0.03, 0.0, (220.0,), r".* µm per mm up to .* mm, then constant"),
    ],
)
def test_a_dead_band_is_named_with_its_ends_and_slopes(
    below: float, above: float, ends: tuple[float, ...], words: str
) -> None:
    low, high = 220.0, 330.0
    bent = below * np.minimum(AT - low, 0.0) + above * np.maximum(AT - high, 0.0)
    form = describe(curve(AT, bent))
    assert form.kind == "dead band" and re.fullmatch(words, form.text)
    assert sorted(numbers(form.text)) == pytest.approx(sorted([*ends, *filter(None, (below, above))]), rel=0.04)


def test_a_change_of_slope_is_named_with_its_place() -> None:
    form = describe(curve(AT, 0.02 * np.minimum(AT - 300.0, 0.0) + 0.07 * np.maximum(AT - 300.0, 0.0)))
    assert re.fullmatch(r".* µm per mm up to .* mm, then .* µm per mm", form.text)
    assert numbers(form.text) == pytest.approx([0.02, 300.0, 0.07], rel=0.04)


@pytest.mark.parametrize("power", [2, 3])
def test_a_smooth_curve_has_no_dead_band(power: int) -> None:
    assert describe(curve(AT, 9.0 * ((AT - 300.0) / 200.0) ** power)).kind != "dead band"


def test_a_line_and_a_drift() -> None:
    line = describe(curve(RATE, 400.0 * RATE, column="slider_joint_rate_rad_s", unit="rad/s"))
    assert line.kind == "linear" and "µm per deg/s" in line.text
    assert numbers(line.text) == pytest.approx([400.0 * np.pi / 180.0], rel=0.03)
    hours = np.linspace(0.0, 3600.0, 41)
    drift = describe(curve(hours, 5.0 * hours / 3600.0, column="time_s", unit="s"))
    assert drift.kind == "drift" and drift.text.endswith("µm/h")
    assert numbers(drift.text) == pytest.approx([5.0], rel=0.03)


def test_no_form_is_named_where_there_is_none() -> None:
    rng = np.random.default_rng(5)
    knots = rng.normal(0.0, 5.0, 9)
    wild = np.interp(AT, np.linspace(100.0, 500.0, 9), knots)
    form = describe(curve(AT, wild))
    assert form.kind == "varies" and form.fit is None
    assert numbers(form.text) == pytest.approx([knots.min(), knots.max()], abs=0.5)


def test_what_lies_within_its_band_is_nothing() -> None:
    flat = Curve("time", "s", "time_s", "", AT, np.full(41, 1e-4), np.full(41, 1e-3), np.ones(41))
    assert describe(flat).kind == "nothing"


def test_what_multiplies_the_function_is_said() -> None:
    form = describe(curve(AT, 0.05 * AT, times="travel_direction"))
    assert form.text.endswith("turning over with the direction of travel")


def test_two_states_are_told_by_how_far_they_are_apart() -> None:
    ends = np.array([-1.0, 1.0])
    form = describe(curve(ends, 6.0 * ends, column="leg_force.relay@7.1/14.5", unit=""))
    assert form.kind == "two states"
    assert numbers(form.text) == pytest.approx([12.0], rel=0.02)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("slider_3_position", "position of slider 3"),
        ("slider_1_since_reversal_travel", "travel since the reversal of slider 1"),
        ("slider_6_direction", "direction of travel of slider 6"),
        ("slider_2_leg_force", "axial force of leg 2 per load"),
    ],
)
def test_what_is_mounted_goes_by_a_drive_that_is_named(name: str, words: str) -> None:
    assert Learned.parse(f"learned:cup:{name}").variable.words == words


@pytest.mark.parametrize("at", [100.0, 692.2, 1400.0])
def test_a_step_in_time_is_described_wherever_it_is(at: float) -> None:
    """Four points say all of it; the search for a bump between them had no end where it is in the middle of a test."""
    points = np.array([0.0, at - 5e-5, at, 1471.7])
    step = Curve("step", "s", "time_s", "", points, 5e-3 * (points >= at), np.full(4, 5e-5), np.full(4, 300.0))
    assert describe(step, 0.0).kind != "nothing"
