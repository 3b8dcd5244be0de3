from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from hexdbb.errors import InputError
from hexdbb.kinematics import inverse, rotation_from_rpy, status_name
from hexdbb.machine import shipped, shipped_machine
from hexdbb.plan import Circle, Plan, load_plan, shipped_plans

TEXT = shipped("plans", "thesis.toml").read_text(encoding="utf-8")
TWO_CIRCLES = TEXT + TEXT[TEXT.index("[[circle]]") :].replace("id = 0\nmount", "id = 1\nmount")


def plan_of(tmp_path: Path, text: str) -> Plan:
    path = tmp_path / "plan.toml"
    path.write_text(text, encoding="utf-8")
    return load_plan(path)


def test_thesis_plan_is_the_thesis_test() -> None:
    plan = load_plan("thesis")
    runs = plan.runs()
    assert [(run.direction, run.feed_mm_min, run.sweep) for run in runs] == [(-1, 753.98, 0), (1, 753.98, 1)]
    assert {run.circle.radius_mm for run in runs} == {100.0}
    assert runs[0].mount.cup_mm == (0.0, 0.0, 340.0)
    assert plan.machine_file() == shipped_machine()


def test_standard_plan_has_the_seven_circles_two_laps_each_way_at_two_feeds() -> None:
    plan = load_plan("standard")
    held = [circle.platform_rpy_deg for circle in plan.circles]
    tilted = [(12.0, 0.0, 0.0), (-12.0, 0.0, 0.0), (0.0, 12.0, 0.0), (0.0, -12.0, 0.0)]
    assert held == [(0.0, 0.0, 0.0), *tilted, (0.0, 0.0, 15.0), (0.0, 0.0, -15.0)]
    assert all(circle.plane_rpy_deg == (0.0, 0.0, 0.0) for circle in plan.circles)
    runs = plan.runs()
    assert len(runs) == 7 * 2 * 2
    assert [run.sweep for run in runs] == list(range(28))
    assert {(run.feed_mm_min, run.direction, run.laps) for run in runs} == {
        (feed, direction, 2) for feed in (753.98, 3000.0) for direction in (1, -1)
    }


def test_every_shipped_plan_loads_by_name() -> None:
    assert shipped_plans() == ["standard", "thesis"]
    for name in shipped_plans():
        assert load_plan(name).runs()


@pytest.mark.parametrize("name", ["standard", "thesis"])
def test_every_shipped_plan_is_within_reach_of_the_shipped_machine(name: str) -> None:
    angles = np.linspace(0.0, 2.0 * np.pi, 721)
    for run in load_plan(name).runs():
        positions = run.circle.poses(angles, run.mount.cup_mm)
        _, status = inverse(shipped_machine(), positions, run.circle.platform_rpy_rad)
        assert not status.any(), f"circle {run.circle.id}: {status_name(status[status != 0][0])}"


def test_circle_overrides_feeds_directions_and_laps(tmp_path: Path) -> None:
    own = "feeds_mm_min = [500, 1000]\ndirections = [1]\nlaps = 3\n"
    runs = plan_of(tmp_path, TWO_CIRCLES + own).runs()
    assert [(run.circle.id, run.feed_mm_min, run.direction, run.laps) for run in runs] == [
        (0, 753.98, -1, 1),
        (0, 753.98, 1, 1),
        (1, 500.0, 1, 3),
        (1, 1000.0, 1, 3),
    ]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("id = 1\n", "id = 0\n", "circle[1].id: 0 (expected an id of its own: circle[0] has this one)"),
        ("[[mount]]", "[[mount]]\nid = 0\ncup_mm = [0, 0, 1]\n[[mount]]", "mount[1].id: 0 (expected an id of its own"),
        ("id = 1\nmount = 0", "id = 1\nmount = 5", "circle[1].mount: 5 (expected the id of a mount: 0)"),
        ("directions = [-1, 1]", "directions = [-1, 2]", "directions[1]: 2 (expected 1 or -1)"),
        ("directions = [-1, 1]", "directions = []", "directions: [] (expected a list of at least 1, not 0)"),
        ("feeds_mm_min = [753.98]", "feeds_mm_min = [0]", "feeds_mm_min[0]: 0 (expected a number > 0)"),
        ("feeds_mm_min", "feeds_mm_s", "feeds_mm_s: unknown key (expected feeds_mm_min: the unit is part of the key)"),
        ("laps = 1", "laps = 0", "laps: 0 (expected a number >= 1)"),
        ("laps = 1", "", "laps: missing (expected this key)"),
        ("overshoot_deg = 45.0", "overshoot_deg = -1", "overshoot_deg: -1 (expected a number >= 0)"),
        ("radius_mm = 100.0", "radius_um = 100000.0", "circle[0].radius_um: unknown key (expected radius_mm: the unit"),
        ("radius_mm = 100.0", "radius_mm = 150.0", "circle[0].radius_mm: 150 (expected the bar's length, 100, within"),
        ("id = 1\n", "id = -1\n", "circle[1].id: -1 (expected a number >= 0)"),
        ("range_um = 1000.0", "range_um = 0", "gauge.range_um: 0 (expected a number > 0)"),
        (
            "hexdbb.plan/1",
            "hexdbb.plan/9",
            'schema: "hexdbb.plan/9" (expected "hexdbb.plan/1"; this is a later version',
        ),
    ],
)
def test_bad_plan_is_refused_with_key_and_value(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in TWO_CIRCLES
    with pytest.raises(InputError) as caught:
        plan_of(tmp_path, TWO_CIRCLES.replace(old, new))
    assert str(caught.value).startswith(f"{tmp_path}/plan.toml: {message}")
    assert "\n" not in str(caught.value)


def test_plan_without_circles_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="circle: missing"):
        plan_of(tmp_path, TEXT[: TEXT.index("[[circle]]")])


def test_name_that_is_no_plan_is_answered_with_those_there_are() -> None:
    with pytest.raises(
        InputError, match=r"thesys: no such file \(expected a plan file, or a shipped plan: standard, the"
    ):
        load_plan("thesys")


def test_missing_machine_names_plan_and_key(tmp_path: Path) -> None:
    plan = plan_of(tmp_path, TEXT.replace('"sp120"', '"mine.toml"'))
    with pytest.raises(InputError, match=r'plan.toml: machine: "mine.toml": no such file'):
        plan.machine_file()


def test_level_circle_at_the_quarters() -> None:
    circle = load_plan("thesis").circles[0]
    poses = circle.poses(np.radians([0.0, 90.0, 180.0, 270.0]), (0.0, 0.0, 340.0))
    expected = [[100, 0, 280], [0, 100, 280], [-100, 0, 280], [0, -100, 280]]
    np.testing.assert_allclose(poses, expected, atol=1e-12)


angles = st.floats(-180.0, 180.0)
orientations = st.tuples(angles, st.floats(-80.0, 80.0), angles)


@given(orientation=orientations)
def test_rotation_is_yaw_after_pitch_after_roll(orientation: tuple[float, float, float]) -> None:
    expected = Rotation.from_euler("xyz", orientation, degrees=True).as_matrix()
    np.testing.assert_allclose(rotation_from_rpy(np.radians(orientation)), expected, atol=1e-14)


@given(plane=orientations, held=orientations, angle_deg=st.floats(-720.0, 720.0))
def test_ball_runs_on_its_circle_however_plane_and_platform_stand(
    plane: tuple[float, float, float], held: tuple[float, float, float], angle_deg: float
) -> None:
    cup, offset = np.array([10.0, -20.0, 340.0]), (5.0, -7.0, 60.0)
    circle = Circle(id=0, mount=0, radius_mm=80.0, ball_offset_mm=offset, plane_rpy_deg=plane, platform_rpy_deg=held)
    angle = math.radians(angle_deg)
    (position,) = circle.poses(angle, cup)
    ball = position + rotation_from_rpy(circle.platform_rpy_rad) @ np.array(offset) - cup
    in_plane = rotation_from_rpy(np.radians(plane)).T @ ball
    np.testing.assert_allclose(in_plane, [80.0 * math.cos(angle), 80.0 * math.sin(angle), 0.0], atol=1e-11)


def test_a_plan_shows_its_runs() -> None:
    plan = load_plan("standard")
    assert repr(plan) == "<Plan standard.toml: machine sp120, 7 circles, 1 mount, 28 runs, 45° overshoot>"
    shown = plan._repr_html_()
    assert shown.count("<tr>") == 1 + 28
    assert "<td>7</td><td>1</td><td>0</td><td>100</td><td>3000</td><td>+1</td><td>2</td><td>12, 0, 0</td>" in shown


def test_a_plan_on_a_machine_at_hand_reads_no_file(tmp_path: Path) -> None:
    plan = load_plan("standard").model_copy(update={"machine": "nowhere.toml"})
    machine = load_plan("standard").machine_file()
    longer = machine.model_copy(update={"name": "another"})
    here, other = plan.with_machine(machine), plan.with_machine(longer)
    assert here.machine_file() is machine
    assert here.model_copy(update={"laps": 3}).machine_file() is machine
    assert here != other
    assert pickle.loads(pickle.dumps(other)).machine_file() == longer
