"""Clearances of a circle: against the inverse kinematics' own differences and against plain geometry."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.identifiability.redundancy import LEVER_MM
from hexdbb.kinematics import inverse, rotation_from_rpy
from hexdbb.machine import shipped_machine
from hexdbb.plan import Circle, load_plan
from hexdbb.planning import Clearances, RequiredClearances, circle_clearances
from hexdbb.planning.clearances import pose_condition
from hexdbb.trajectory import plan_programme

MACHINE = shipped_machine()
STANDARD = load_plan("standard")
CUP = STANDARD.mounts[0].cup_mm


def circle(
    plane: tuple[float, float, float] = (0.0, 0.0, 0.0), platform: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> Circle:
    return Circle(
        id=0,
        mount=0,
        radius_mm=100.0,
        ball_offset_mm=(0.0, 0.0, 60.0),
        plane_rpy_deg=plane,
        platform_rpy_deg=platform,
    )


def found(each: Circle) -> Clearances:
    clearances = circle_clearances(MACHINE, each, CUP)
    assert clearances is not None
    return clearances


@pytest.mark.parametrize("rpy_rad", [(0.0, 0.0, 0.0), (0.2, 0.0, 0.0), (-0.1, 0.15, 0.3)])
def test_pose_condition_is_that_of_differences_of_the_inverse_kinematics(rpy_rad: tuple[float, float, float]) -> None:
    position_mm, rotation = np.array([20.0, -35.0, 275.0]), rotation_from_rpy(rpy_rad)
    step = 1e-5
    columns = []
    for axis in np.eye(6):
        moved = []
        for sign in (1.0, -1.0):
            turn = rotation_from_rpy(sign * step * axis[3:]) @ rotation
            rpy = [
                np.arctan2(turn[2, 1], turn[2, 2]),
                -np.arcsin(turn[2, 0]),
                np.arctan2(turn[1, 0], turn[0, 0]),
            ]
            sliders_mm, status = inverse(MACHINE, [position_mm + sign * step * axis[:3]], rpy)
            assert not status.any()
            moved.append(sliders_mm[0])
        columns.append((moved[0] - moved[1]) / (2 * step) / (LEVER_MM if axis[3:].any() else 1.0))
    sliders_mm, _ = inverse(MACHINE, [position_mm], rpy_rad)
    expected = np.linalg.cond(np.column_stack(columns))
    assert pose_condition(MACHINE, position_mm[None], rotation, sliders_mm) == pytest.approx(expected, rel=1e-5)


def test_bar_angle_is_the_larger_of_those_at_cup_and_platform() -> None:
    assert found(circle()).bar_angle_deg == pytest.approx(0.0)
    assert found(circle(plane=(9.0, 0.0, 0.0))).bar_angle_deg == pytest.approx(9.0)
    assert found(circle(platform=(0.0, 7.0, 0.0))).bar_angle_deg == pytest.approx(7.0)
    assert found(circle(plane=(5.0, 0.0, 0.0), platform=(-5.0, 0.0, 0.0))).bar_angle_deg == pytest.approx(10.0)
    assert found(circle(plane=(8.0, 0.0, 0.0), platform=(8.0, 0.0, 0.0))).bar_angle_deg == pytest.approx(8.0)


def test_clearances_hold_for_all_of_the_motion() -> None:
    """No row of the programme, feeding in and out included, comes nearer to an end or to another slider."""
    for each in STANDARD.circles:
        clearances = found(each)
        plan = STANDARD.model_copy(update={"circles": (each,), "feeds_mm_min": (3000.0,), "laps": 1})
        sliders_mm = plan_programme(plan, MACHINE, 0.004, "plan").table.sliders_mm
        low_mm, high_mm = MACHINE.sliders.travel_mm
        nearest_end_mm = min(sliders_mm.min() - low_mm, high_mm - sliders_mm.max())
        nearest_gap_mm = (sliders_mm[:, 1::2] - sliders_mm[:, 0::2]).min() - MACHINE.sliders.min_gap_mm
        # Less than that by what feeding in at the worst angle would take.
        assert nearest_end_mm - 1.0 < clearances.to_end_of_travel_mm < nearest_end_mm + 0.1
        assert nearest_gap_mm - 4.0 < clearances.to_min_gap_mm < nearest_gap_mm + 0.1
        assert RequiredClearances().met_by(clearances)


def test_a_circle_out_of_reach_has_no_clearance() -> None:
    assert circle_clearances(MACHINE, circle(platform=(50.0, 0.0, 0.0)), CUP) is None
    assert circle_clearances(MACHINE, circle(), (0.0, 0.0, 800.0)) is None


@pytest.mark.parametrize(
    "short",
    [
        Clearances(4.9, 50.0, 10.0, 5.0),
        Clearances(50.0, 4.9, 10.0, 5.0),
        Clearances(50.0, 50.0, 25.1, 5.0),
        Clearances(50.0, 50.0, 10.0, 17.0),
    ],
)
def test_each_required_clearance_counts(short: Clearances) -> None:
    assert not RequiredClearances().met_by(short)
    assert RequiredClearances().met_by(Clearances(50.0, 50.0, 10.0, 5.0))
