"""Reach, limits and singular poses over a workspace: against inverse and forward kinematics and plain geometry."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hexdbb.errors import InputError
from hexdbb.kinematics import inverse
from hexdbb.machine import Joints, MachineFile, Workspace, load_machine, shipped_machine
from hexdbb.plots.machine import machine_figure
from hexdbb.workspace import (
    CONDITION_MAX,
    assess,
    level_map,
    plan_template,
    require_reach,
    suggested_workspace,
    workspace_poses,
)

SP120 = shipped_machine()
UNLIKE = load_machine(Path(__file__).parents[2] / "data" / "machines" / "unlike.toml")
STANDARD = Workspace(centre_mm=(0.0, 0.0, 265.0), radius_mm=100.0, tilt_deg=10.0)


def test_poses_cover_the_workspace_to_its_edge() -> None:
    space = Workspace(centre_mm=(5.0, -3.0, 250.0), radius_mm=60.0, height_mm=40.0, tilt_deg=8.0)
    poses = workspace_poses(SP120, space)
    from_centre = poses.position_mm - np.array(space.centre_mm)
    assert np.hypot(*from_centre[:, :2].T).max() == pytest.approx(60.0)
    assert (from_centre[:, 2].min(), from_centre[:, 2].max()) == (-20.0, 20.0)
    assert np.degrees(np.hypot(*poses.rpy_rad[:, :2].T)).max() == pytest.approx(8.0)
    assert (poses.rpy_rad == 0.0).all(axis=1).any()


def test_margins_are_the_least_of_all_poses() -> None:
    found, poses = assess(SP120, STANDARD), workspace_poses(SP120, STANDARD)
    sliders = poses.sliders_mm
    assert found.reached == found.poses == len(poses)
    assert found.to_end_of_travel_mm == pytest.approx(min(sliders.min() - 20.0, 846.0 - sliders.max()))
    assert found.to_min_gap_mm == pytest.approx((sliders[:, 1::2] - sliders[:, ::2]).min() - 60.0)
    assert found.condition < CONDITION_MAX
    assert found.findings == ()


def test_what_is_near_a_limit_is_said_with_slider_and_pose() -> None:
    low = STANDARD.model_copy(update={"centre_mm": (0.0, 0.0, 236.0), "tilt_deg": 12.0})
    (finding,) = assess(SP120, low).findings
    assert finding.startswith("slider ")
    assert "end of travel" in finding
    assert "expected 5 mm or more" in finding
    assert "z 236 mm" in finding


def test_two_sliders_of_a_guideway_that_meet_are_said() -> None:
    high = Workspace(centre_mm=(0.0, 0.0, 356.9), radius_mm=0.1)
    findings = " ".join(assess(SP120, high).findings)
    assert "beyond the smallest gap of 60 mm" in findings


def test_a_singular_pose_has_a_large_condition() -> None:
    """Where legs stand across their guideways sliders move and the platform does not."""
    free = SP120.sliders.model_copy(update={"min_gap_mm": 0.01})
    machine = SP120.model_copy(update={"sliders": free})
    poses = [
        assess(machine, Workspace(centre_mm=(0.0, 0.0, z), radius_mm=0.1)).condition for z in (280.0, 350.0, 358.2)
    ]
    assert poses[0] < poses[1] < poses[2]
    assert poses[2] > CONDITION_MAX


def test_limits_of_joints_count() -> None:
    loose, tight = Joints(swing_deg=(0.0, 60.0)), Joints(swing_deg=(0.0, 20.0))
    steep = Joints(leg_to_guideway_min_deg=60.0)
    assert assess(SP120.model_copy(update={"joints": loose}), STANDARD).findings == ()
    for limits in (tight, steep, Joints(leg_to_normal_max_deg=40.0)):
        found = assess(SP120.model_copy(update={"joints": limits}), STANDARD)
        assert found.to_joint_limit_deg < 0.0
        assert any("[joints]" in each for each in found.findings)


@pytest.mark.parametrize(
    ("key", "value"), [("radius_mm", 300.0), ("tilt_deg", 50.0), ("height_mm", 500.0), ("centre_mm", (0.0, 0.0, 500.0))]
)
@pytest.mark.parametrize("machine", [SP120, UNLIKE], ids=["sp120", "unlike"])
def test_what_is_out_of_reach_names_the_key_and_what_is_reached(machine: MachineFile, key: str, value: object) -> None:
    small = {"radius_mm": 60.0, "height_mm": 10.0, "tilt_deg": 5.0} if key == "radius_mm" else {"radius_mm": 0.01}
    wanted = Workspace(centre_mm=(0.0, 0.0, 255.0), **small)
    require_reach(machine, wanted, "m.toml")
    too_much = wanted.model_copy(update={key: value})
    with pytest.raises(InputError, match=rf"^m\.toml: workspace\.{key}: .* \(expected ") as error:
        require_reach(machine, too_much, "m.toml")
    if key == "centre_mm":
        low, high = (float(each) for each in str(error.value).rpartition("z = ")[2].rstrip(")").split(" to "))
        _, status = inverse(machine, np.array([[0, 0, low], [0, 0, high], [0, 0, high + 1.5]]), np.zeros(3))
        assert (status == 0).tolist() == [True, True, False]
    else:
        most = float(str(error.value).partition("at most ")[2].partition(":")[0])
        require_reach(machine, wanted.model_copy(update={key: most}), "m.toml")


@pytest.mark.parametrize("machine", [SP120, UNLIKE], ids=["sp120", "unlike"])
def test_the_workspace_suggested_is_reached_and_near_nothing(machine: MachineFile) -> None:
    space = suggested_workspace(machine)
    require_reach(machine, space, "m.toml")
    assert assess(machine, space).findings == ()


def test_the_template_is_a_level_circle_in_the_middle() -> None:
    plan = plan_template(UNLIKE, STANDARD, 50.0)
    position = plan.circles[0].poses(np.linspace(0.0, 6.0, 7), plan.mounts[0].cup_mm)
    np.testing.assert_allclose(position.mean(axis=0)[2], 265.0)
    np.testing.assert_allclose(np.hypot(*position[:, :2].T), 50.0)
    with pytest.raises(InputError, match="bar length 150 mm: no circle of it fits"):
        plan_template(UNLIKE, STANDARD, 150.0)


def test_the_picture_shows_the_machine_to_scale() -> None:
    space = UNLIKE.workspace
    assert space is not None
    level = level_map(UNLIKE, space)
    inside = np.hypot(*(each - 0.0 for each in np.meshgrid(level.x_mm, level.y_mm))) <= space.radius_mm
    assert np.isfinite(level.condition[inside]).all()
    assert np.isnan(level.condition).any()
    figure = machine_figure(UNLIKE, space, level)
    above = figure.axes[1]
    assert above.get_aspect() == 1.0
    drawn = [np.array(line.get_data()).T for line in above.lines[:3]]
    np.testing.assert_allclose([np.linalg.norm(ends[1] - ends[0]) for ends in drawn], [820.0, 855.0, 840.0])
    names = [text.get_text() for text in above.texts]
    assert names[:3] == ["guideway 1, 0°", "guideway 2, 100°", "guideway 3, 230°"]
