"""Trajectories: the ball on its circle to rounding, laps captured exactly, limits kept, refusals with their place."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hexdbb.errors import InputError, RunError
from hexdbb.kinematics import forward, inverse, rotation_from_rpy, rpy_from_rotation
from hexdbb.plan import Plan, load_plan
from hexdbb.trajectory import Phase, Programme, approach, plan_programme
from hexdbb.trajectory import programme as programme_module
from hexdbb.trajectory.extent import FEED_IN_MM
from hexdbb.trajectory.time_law import PathLimits, feed_law, rest_to_rest

CYCLE_S = 0.004
TARGETS = Path(__file__).parents[2] / "data" / "trajectory" / "thesis_targets.csv"


def changed(name: str = "thesis", **circle: object) -> Plan:
    """A shipped plan with its first circle changed, and nothing but this circle, fast and in both directions."""
    plan = load_plan(name)
    first = plan.circles[0].model_copy(update={"feeds_mm_min": (6000.0,), **circle})
    return plan.model_copy(update={"circles": (first,)})


def programme_of(plan: Plan, cycle_s: float = CYCLE_S) -> Programme:
    return plan_programme(plan, plan.machine_file(), cycle_s, "plan")


def ball_from_cup_mm(programme: Programme, plan: Plan) -> np.ndarray:
    """Vector from the cup to the ball at every row, by forward kinematics of the targets."""
    position, rotation, status = forward(plan.machine_file(), programme.table.sliders_mm)
    assert not status.any()
    offset = np.array(plan.circles[0].ball_offset_mm)
    return position + rotation @ offset - np.array(plan.mounts[0].cup_mm)


positive = st.floats(0.5, 300.0)


@settings(max_examples=60, deadline=None)
@given(length_mm=st.floats(1e-6, 500.0), v=positive, a=st.floats(5.0, 3000.0), j=st.floats(50.0, 50000.0))
def test_rest_to_rest_keeps_its_limits_and_arrives(length_mm: float, v: float, a: float, j: float) -> None:
    u = rest_to_rest(length_mm, PathLimits(v, a, j), CYCLE_S).u_mm()
    assert u[0] == 0.0
    assert u[-1] == pytest.approx(length_mm, abs=1e-9)
    # Differences are averages of the derivatives, so they keep the same limits; padded by the rest before and after.
    padded = np.concatenate([np.zeros(3), u, np.full(3, u[-1])])
    for order, limit in ((1, v), (2, a), (3, j)):
        assert np.abs(np.diff(padded, n=order) / CYCLE_S**order).max() <= limit * (1 + 1e-6) + 1e-12 / CYCLE_S**order


@settings(max_examples=40, deadline=None)
@given(overshoot_mm=st.floats(0.0, 200.0), laps=st.integers(1, 2), feed=st.floats(5.0, 150.0))
def test_feed_law_captures_from_zero_at_constant_feed(overshoot_mm: float, laps: int, feed: float) -> None:
    turn_mm = 2 * math.pi * 100.0
    law = feed_law(overshoot_mm, laps * turn_mm, PathLimits(feed, 300.0, 5000.0), CYCLE_S)
    u_mm = law.u_mm()
    capture = law.capture(0, u_mm)
    captured = u_mm[capture]
    assert law.captured == len(captured)
    step_mm = feed * CYCLE_S
    assert captured[0] == pytest.approx(0.0, abs=1e-8)
    assert np.diff(captured) == pytest.approx(step_mm, abs=1e-8)
    assert laps * turn_mm - step_mm - 1e-8 <= captured[-1] < laps * turn_mm
    first = int(capture.argmax())
    assert u_mm[0] == pytest.approx(-law.lead_mm, abs=1e-9)
    at_feed = np.isclose(np.diff(u_mm[: first + 1]), step_mm, atol=1e-8)
    assert at_feed.sum() * step_mm >= overshoot_mm - 2 * step_mm


@pytest.mark.parametrize("tilt_deg", [(0.0, 0.0, 0.0), (8.0, -5.0, 20.0)])
@pytest.mark.parametrize("platform_deg", [(0.0, 0.0, 0.0), (5.0, -4.0, 10.0)])
def test_ball_runs_on_its_circle(tilt_deg: tuple[float, ...], platform_deg: tuple[float, ...]) -> None:
    plan = changed(plane_rpy_deg=tilt_deg, platform_rpy_deg=platform_deg)
    programme = programme_of(plan)
    table = programme.table
    bar = ball_from_cup_mm(programme, plan)
    arc = table.phase == Phase.ARC
    angle = np.radians(table.angle_deg[arc])
    plane = rotation_from_rpy(np.radians(tilt_deg))
    circle = 100.0 * np.column_stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)]) @ plane.T
    assert np.abs(bar[arc] - circle).max() < 1e-9
    # Off the circle the bar is never shorter than it, nor longer than where it is mounted.
    length = np.linalg.norm(bar, axis=1)
    assert length.min() > 100.0 - 1e-9
    assert length.max() < 100.0 + FEED_IN_MM + 1e-9


@pytest.mark.parametrize("laps", [1, 2])
def test_captured_angles_cover_the_laps_in_the_right_sense(laps: int) -> None:
    plan = changed(laps=laps)
    table = programme_of(plan).table
    for index, run in enumerate(plan.runs()):
        rows = table.capture & (table.run == index)
        travelled = np.unwrap(np.radians(table.angle_deg[rows])) * run.direction
        travelled -= travelled[0]
        step = np.diff(travelled).mean()
        assert table.angle_deg[rows][0] == pytest.approx(0.0, abs=1e-6)
        assert laps * 2 * math.pi - step * 1.001 < travelled[-1] < laps * 2 * math.pi
        assert ((table.angle_deg[rows] >= 0.0) & (table.angle_deg[rows] < 360.0)).all()
        assert table.lap[rows].tolist() == np.floor(travelled / (2 * math.pi) + 1e-9).astype(int).tolist()
    assert (table.lap[~table.capture] == -1).all()


def test_counter_clockwise_is_seen_from_above_the_plane() -> None:
    plan = changed(directions=(1,))
    programme = programme_of(plan)
    bar = ball_from_cup_mm(programme, plan)[programme.table.capture]
    assert (np.cross(bar[:-1], bar[1:])[:, 2] > 0).all()


@pytest.mark.parametrize("name", ["thesis", "standard"])
def test_shipped_plans_keep_every_slider_limit(name: str) -> None:
    plan = load_plan(name)
    limits = plan.machine_file().can_setup.limits
    rate = programme_of(plan).table.sliders_mm
    for limit in (limits.velocity_mm_s, limits.acceleration_mm_s2, limits.jerk_mm_s3):
        rate = np.diff(rate, axis=0) / CYCLE_S
        assert np.abs(rate).max() <= limit


def test_between_circles_of_one_mount_the_bar_may_stay() -> None:
    plan = load_plan("standard").model_copy(update={"feeds_mm_min": (6000.0,), "laps": 1, "directions": (1,)})
    programme = programme_of(plan, 0.02)
    transfer = programme.table.phase == Phase.TRANSFER
    length = np.linalg.norm(ball_from_cup_mm(programme, plan), axis=1)
    assert transfer.sum() > 100
    assert np.abs(length[transfer] - 100.0 - FEED_IN_MM).max() < 1e-9


def test_approach_begins_where_the_sliders_stand_and_ends_at_rest_at_the_first_row() -> None:
    plan = changed()
    machine, programme = plan.machine_file(), programme_of(plan)
    stand, status = inverse(machine, np.array([[10.0, -20.0, 260.0]]), np.radians([[3.0, -2.0, 5.0]]))
    assert status[0] == 0
    way = approach(stand[0], programme, machine, "plan")
    assert np.abs(way.sliders_mm[0] - stand[0]).max() < 1e-9
    assert np.abs(way.sliders_mm[-10:] - programme.table.sliders_mm[0]).max() < 1e-9
    assert not way.capture.any()
    velocity = np.diff(way.sliders_mm, axis=0) / CYCLE_S
    assert np.abs(velocity).max() <= machine.can_setup.limits.velocity_mm_s
    assert np.abs(velocity[0]).max() < 1.0


def test_approach_from_where_no_pose_is_is_refused() -> None:
    plan = changed()
    with pytest.raises(InputError, match=r"sliders stand at 20\.000.*expected a pose"):
        approach(np.array([20.0, 846.0, 20.0, 846.0, 400.0, 470.0]), programme_of(plan), plan.machine_file(), "plan")


@pytest.mark.parametrize("block_rows", [7, 1000])
def test_targets_do_not_depend_on_how_their_rows_are_divided(block_rows: int, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = changed(laps=2)
    monkeypatch.setattr(programme_module, "BLOCK_ROWS", 10**6)
    whole = programme_of(plan, 0.02)
    monkeypatch.setattr(programme_module, "BLOCK_ROWS", block_rows)
    parts = programme_of(plan, 0.02)
    for name in ("sliders_mm", "phase", "run", "angle_deg", "lap", "capture"):
        np.testing.assert_array_equal(getattr(parts.table, name), getattr(whole.table, name))
    assert parts.captured.tolist() == np.bincount(whole.table.run[whole.table.capture]).tolist()
    feeds_in = whole.table.phase == Phase.FEED_IN
    assert parts.feeds_in.tolist() == [int((feeds_in & (whole.table.run == k)).argmax()) for k in range(2)]


def test_too_fast_a_row_is_named_across_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    plan, messages = changed(), []
    machine = plan.machine_file()
    limits = machine.can_setup.limits.model_copy(update={"jerk_mm_s3": 150.0})
    slow = machine.model_copy(update={"can": machine.can_setup.model_copy(update={"limits": limits})})
    for block_rows in (10**6, 100):
        monkeypatch.setattr(programme_module, "BLOCK_ROWS", block_rows)
        with pytest.raises(InputError, match=r"arc at \d.* deg: jerk of slider") as caught:
            plan_programme(plan, slow, 0.02, "plan")
        messages.append(str(caught.value))
    assert messages[0] == messages[1]


def test_targets_are_those_of_the_version_that_computed_them_at_once() -> None:
    """Every 97th row of the plan `thesis` at 250 Hz, computed as one table in memory."""
    rows, *sliders_mm = np.loadtxt(TARGETS, delimiter=",", unpack=True)
    table = plan_programme(load_plan("thesis"), load_plan("thesis").machine_file(), CYCLE_S, "thesis").table
    assert len(table) == 32096
    np.testing.assert_allclose(table.sliders_mm[rows.astype(int)], np.column_stack(sliders_mm), rtol=0, atol=1e-9)


def test_a_full_disk_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.pwrite", full)
    with pytest.raises(RunError, match=r"^targets: cannot be written in .*: No space left on device \(exp"):
        programme_of(changed(), 0.02)


@pytest.mark.parametrize("rpy", [(0.1, -0.2, 0.3), (-1.0, 1.2, 3.0), (0.0, 0.0, 0.0)])
def test_rpy_undoes_the_rotation(rpy: tuple[float, float, float]) -> None:
    assert rpy_from_rotation(rotation_from_rpy(rpy)) == pytest.approx(rpy, abs=1e-12)


@pytest.mark.parametrize(
    ("circle", "named"),
    [
        ({"platform_rpy_deg": (40.0, 0.0, 0.0)}, r"plan: circle 0, 6000 mm/min, direction -1, arc at .* deg: "),
        (
            {"feeds_mm_min": (90000.0,)},
            r"plan: circle 0, 90000 mm/min, .* of slider \d: .* \(expected at most 2\d+ mm/s",
        ),
    ],
)
def test_what_cannot_be_driven_is_refused_by_circle_angle_and_limit(circle: dict[str, object], named: str) -> None:
    with pytest.raises(InputError, match=named):
        programme_of(changed(**circle))
