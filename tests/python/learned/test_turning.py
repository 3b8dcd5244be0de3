"""What turns over with a direction, but gradually: names, values, words, and what a controller takes of it."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.errors import InputError
from hexdbb.learned import Curve, Learned, Space, describe, turning, turns_with
from hexdbb.machine import shipped_machine
from hexdbb.samples.memory import remembered_column, remembered_of

NAME = "learned:slider:5:direction_position"
TURNING = f"{NAME}_turning@0.5"
LEAD_MM = 5.0


def columns() -> dict[str, np.ndarray]:
    time_s = np.linspace(0.0, 120.0, 2400)
    phase = 0.2 * time_s[:, None] + np.arange(6)
    velocity = 20.0 * np.cos(phase)
    turned = remembered_column("turning", 0.5, velocity, time_s, np.zeros(len(time_s), np.int32), time_s)
    return {
        "time_s": time_s,
        "sliders_mm": 200.0 + 100.0 * np.sin(phase),
        "velocity_mm_s": velocity,
        "velocity_mm_s.turning@0.5": turned,
        "travel_direction": np.sign(velocity),
    }


def test_the_name_says_within_which_rate_and_of_what_it_is_the_sign() -> None:
    learned, sharp = Learned.parse(TURNING), Learned.parse(NAME)
    assert learned.variable.times == "velocity_mm_s.turning@0.5"
    assert learned.variable.needs == {"sliders_mm", "velocity_mm_s", "time_s"}
    assert learned.variable == turning(sharp.variable, 0.5)
    assert learned.with_number(0.25).name == f"{NAME}_turning@0.25"
    assert (turns_with(sharp.variable), turns_with(learned.variable)) == ("velocity_mm_s", None)
    assert learned.parts == sharp.parts
    joint = Learned.parse("learned:leg:2:joint_angle_direction_turning@0.005").variable
    assert joint.times == "slider_joint_rate_rad_s.turning@0.005"
    assert "its sign change smoothed over about 0.005 rad/s" in joint.words


def test_it_is_the_same_as_the_sign_but_for_where_the_motion_is_slow() -> None:
    samples = columns()
    assert remembered_of("velocity_mm_s.turning@0.5") is not None
    gradual, sharp = (Space.of(Learned.parse(name), samples, LEAD_MM) for name in (TURNING, NAME))
    one, other = gradual.design(samples, 4), sharp.design(samples, 4)
    speed = np.abs(samples["velocity_mm_s"][:, 4])
    assert np.allclose(one, other * (speed / np.hypot(speed, 0.5))[:, None], atol=1e-12)
    slow = speed < 0.1
    assert slow.any() and np.abs(one[slow]).max() < 0.2 < np.abs(other[slow]).max()


@pytest.mark.parametrize("name", ["learned:slider:5:position_turning@0.5", "learned:slider:5:nothing_turning@0.5"])
def test_only_what_turns_over_at_once_may_turn_over_gradually(name: str) -> None:
    with pytest.raises(InputError, match="variable"):
        Learned.parse(name)


def test_words_say_so_and_a_controller_turns_it_over_at_once() -> None:
    learned = Learned.parse(TURNING)
    space = Space.of(learned, columns(), LEAD_MM)
    values = np.linspace(1e-3, 2e-3, space.size)
    (table,) = space.tables(values, shipped_machine())
    assert (table.column, table.times) == ("sliders_mm", "travel_direction")
    at = space.points()
    known = np.full(len(at), 1e-9)
    curve = Curve(
        "position", "mm", "sliders_mm", learned.variable.times, at, space.functions(at) @ values, known, known
    )
    assert describe(curve).text.endswith("its sign changing smoothly with the direction of motion")
