"""What snaps over at one number and back at a lower one is found at its place, with both numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.readings import Linear, Readings, State
from hexdbb.evidence.proposals.two_states import relays
from hexdbb.learned import ALL, Learned, is_directed
from hexdbb.learned.following import is_relay
from hexdbb.learned.further import RELAYS

VECTORS = {"position_mm": 100.0, "gravity_in_platform": 0.3}
"""Columns of which a part along a direction may have two states, and how far they go."""
COLUMNS = {each.column for variables in RELAYS.values() for each in variables if not is_directed(each)} - {"sliders_mm"}
OTHER_STATE = 1.0


class Columns(dict[str, np.ndarray]):
    """Columns by name, and parts of vectors along a direction."""

    def __missing__(self, name: str) -> np.ndarray:
        vector, _, direction_deg = name.partition(".along@")
        return part_along(self[vector], float(direction_deg))


def part_along(vector: np.ndarray, direction_deg: float) -> np.ndarray:
    return vector[:, 0] * np.cos(np.radians(direction_deg)) + vector[:, 1] * np.sin(np.radians(direction_deg))


@pytest.fixture
def varied(readings: Readings) -> Readings:
    """The same rows with forces and angles of joints, each a wave of its own for each element."""
    draw, names = np.random.default_rng(8), readings.state
    turn = 2.0 * np.pi * np.arange(len(readings)) / 120.0
    kept = ("sliders_mm", "time_s", "angle_rad", "travel_direction", "velocity_mm_s")
    columns = Columns((name, names[name]) for name in kept)
    for name in sorted(COLUMNS):
        phase, beat = draw.uniform(0.0, 6.0, (2, 6))
        columns[name] = 0.4 * np.sin(turn[:, None] + phase) + 0.2 * np.sin(0.31 * turn[:, None] + beat)
    # Of one circle any direction tips at the same two points, with other numbers.
    wide = 1.0 + 0.3 * np.sin(0.31 * turn)
    for name, size in VECTORS.items():
        columns[name] = size * np.column_stack([wide * np.cos(turn), wide * np.sin(turn), np.zeros(len(turn))])
    return replace(readings, state=State(columns, readings.state.machine))


def snapped(values: np.ndarray, low: float, high: float) -> np.ndarray:
    """Return the states, row by row: `high` and more is one, `low` and less the other."""
    states, state = [], -OTHER_STATE if np.argmax(values >= high) < np.argmax(values <= low) else OTHER_STATE
    for value in values:
        state = OTHER_STATE if value >= high else -OTHER_STATE if value <= low else state
        states.append(state)
    return np.array(states)


@pytest.mark.parametrize(
    ("name", "column", "element"),
    [
        ("learned:slider:3:drive_load", "drive_load", 3),
        ("learned:leg:5:joint_angle", "slider_joint_angle_rad", 5),
        ("learned:slider_joint:4:joint_angle", "slider_joint_angle_rad", 4),
        ("learned:slider_joint:2:swing_angle", "swing_angle_rad", 2),
        ("learned:platform_joint:2:leg_force", "leg_force", 2),
    ],
)
def test_the_place_and_both_numbers_are_found(
    varied: Readings, linear: Linear, name: str, column: str, element: int
) -> None:
    low, high = -0.13, 0.21
    place, _, variable = name.removeprefix("learned:").split(":")
    at = Learned(place, element, next(each for each in RELAYS[place] if each.name == variable))
    pushes = [push for _, ports in at.pushes(0, varied.state.machine) for push in ports]
    state = snapped(varied.state[column][:, element - 1], low, high)
    residual = linear.residual + 5e-3 * varied.answer(pushes) * state
    best = relays(replace(linear, residual=residual), varied, DEFAULT)[0]
    assert best.hypothesis.name.startswith(f"{name}_relay@")
    numbers = [float(each) for each in best.hypothesis.name.partition("@")[2].split("/")]
    # Between two rows nothing is known of where it snapped.
    between = np.abs(np.diff(varied.state[column][:, element - 1])).max()
    assert numbers == pytest.approx([low, high], abs=between)
    assert best.log_prior < 0.0
    assert is_relay(Learned.parse(best.hypothesis.name).variable)


def test_the_direction_is_found_along_which_the_base_tips(varied: Readings, linear: Linear) -> None:
    true_deg, low, high = 38.0, -21.0, 14.0
    part = part_along(varied.state["position_mm"], true_deg)
    at = Learned("cup", ALL, RELAYS["cup"][0])
    pushes = [push for axis in (0, 1) for _, ports in at.pushes(axis, varied.state.machine) for push in ports]
    residual = linear.residual + 2e-2 * varied.answer(pushes) * snapped(part, low, high)
    best = relays(replace(linear, residual=residual), varied, DEFAULT)[0].hypothesis
    assert best.name.startswith("learned:cup:position_along@")
    found_deg, _, numbers = best.name.partition("@")[2].partition("_relay@")
    assert float(found_deg) == pytest.approx(true_deg, abs=2.0)
    assert [float(each) for each in numbers.split("/")] == pytest.approx([low, high], abs=np.abs(np.diff(part)).max())
    assert is_relay(Learned.parse(best.name).variable)


def test_noise_has_no_states(varied: Readings, linear: Linear) -> None:
    assert relays(linear, varied, DEFAULT) == []


def test_nothing_is_asked_of_what_is_not_measured(varied: Readings, linear: Linear) -> None:
    unmeasured = replace(varied, state=State(varied.state._columns, varied.state.machine, frozenset({"time_s"})))
    assert relays(linear, unmeasured, DEFAULT) == []
