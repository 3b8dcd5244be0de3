"""Columns that are vectors: the platform's course, gravity, and what all carriages' accelerations add up to."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.kinematics import engine_machine, rotation_from_rpy
from hexdbb.plan import load_plan
from hexdbb.samples.course import courses
from hexdbb.samples.lean import leans
from hexdbb.samples.memory import remembered_column
from hexdbb.samples.reaction import carriages_acceleration_mm_s2

VELOCITY_MM_S = np.array([[3.0, 4.0, 0.0], [0.0, -0.005, 0.0], [0.0, 0.0, -20.0]])
RPY_RAD = np.array([[0.1, -0.2, 0.3], [0.0, 0.0, 0.0], [0.0, 0.5, 0.0]])


def test_a_course_is_the_direction_of_motion_and_none_where_the_platform_stands() -> None:
    found = courses(VELOCITY_MM_S, RPY_RAD)
    assert found["course"] == pytest.approx(np.array([[0.6, 0.8, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, -1.0]]))
    back = np.einsum("nij,nj->ni", rotation_from_rpy(RPY_RAD), found["course_in_platform"])
    assert back == pytest.approx(found["course"])
    assert np.column_stack([found["course_x"], found["course_y"]]) == pytest.approx(found["course"][:, :2])


def test_carriages_that_all_go_one_way_have_six_times_ones_acceleration() -> None:
    machine = engine_machine(load_plan("standard").machine_file())
    along = np.array([_core.guideway_direction(machine, each // 2) for each in range(6)])
    wanted = np.array([[7.0, -2.0, 0.0]])
    found = carriages_acceleration_mm_s2(machine, wanted @ along.T)
    # Three directions 120 degrees apart, two carriages each: the sum of a a' is three times the plane's identity.
    assert found == pytest.approx(3.0 * wanted)


@pytest.mark.parametrize(("direction_deg", "part"), [(90.0, 4.0), (180.0, -3.0), (53.130102, 5.0)])
def test_the_part_along_a_direction_is_a_projection(direction_deg: float, part: float) -> None:
    time_s, sweep = np.zeros(3), np.zeros(3, np.int32)
    found = remembered_column("along", direction_deg, VELOCITY_MM_S, time_s, sweep, time_s)
    assert found.shape == (3,)
    assert found[0] == pytest.approx(part)


def test_gravity_acts_along_the_vertical_in_the_platform() -> None:
    found = leans(np.array([[0.0, 0.0, 0.3], [0.2, 0.0, 0.0], [0.0, 0.3, 1.0]]))
    down = np.array([[0.0, 0.0, -1.0], [0.0, -np.sin(0.2), -np.cos(0.2)], [np.sin(0.3), 0.0, -np.cos(0.3)]])
    assert found["gravity_in_platform"] == pytest.approx(down)
    assert found["tilt_rad"] == pytest.approx([0.0, 0.2, 0.3])
    assert found["downhill_in_platform"] == pytest.approx(
        np.array([[0.0, 0.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
    )
