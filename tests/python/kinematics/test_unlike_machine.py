"""Kinematics, joints and error model of a machine whose guideways, legs and travels are not alike.

The points of the simulated rig, which shares no code with the engine, are the oracle.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from hexdbb import _core
from hexdbb.kinematics import engine_machine, forward, guideway_ends, inverse, rotation_from_rpy, slider_points
from hexdbb.kinematics.legs import Legs
from hexdbb.machine import load_machine
from hexdbb.rig.geometry import GeometryErrors, true_geometry

Floats = NDArray[np.float64]

MACHINE = load_machine(Path(__file__).parents[2] / "data" / "machines" / "unlike.toml")
ENGINE = engine_machine(MACHINE)


@pytest.fixture(scope="module")
def poses() -> tuple[Floats, Floats, Floats, Floats]:
    """Position, roll-pitch-yaw, rotation and sliders of poses within reach."""
    draw = np.random.default_rng(7)
    position = draw.uniform([-90.0, -90.0, 180.0], [90.0, 90.0, 310.0], (400, 3))
    rpy = draw.uniform(-0.2, 0.2, (400, 3))
    sliders, status = inverse(MACHINE, position, rpy)
    reached = status == 0
    assert reached.sum() > 100
    return position[reached], rpy[reached], rotation_from_rpy(rpy[reached]), sliders[reached]


def test_inverse_is_that_of_points_computed_elsewhere(poses: tuple[Floats, Floats, Floats, Floats]) -> None:
    position, rpy, _, sliders = poses
    expected = true_geometry(MACHINE).sliders_for(position, Rotation.from_euler("xyz", rpy).as_matrix())
    np.testing.assert_allclose(sliders, expected, atol=1e-9)


def test_forward_undoes_inverse(poses: tuple[Floats, Floats, Floats, Floats]) -> None:
    position, _, rotation, sliders = poses
    found, turned, status = forward(MACHINE, sliders)
    assert not status.any()
    np.testing.assert_allclose(found, position, atol=1e-9)
    np.testing.assert_allclose(turned, rotation, atol=1e-11)


def test_sliders_stop_at_travels_of_their_own() -> None:
    draw = np.random.default_rng(3)
    position = draw.uniform([-150.0, -150.0, 100.0], [150.0, 150.0, 330.0], (3000, 3))
    free = MACHINE.model_copy(update={"sliders": MACHINE.sliders.model_copy(update={"travel_mm": (-1e4, 1e4)})})
    sliders, _ = inverse(free, position, np.zeros(3))
    _, status = inverse(MACHINE, position, np.zeros(3))
    low, high = np.array(MACHINE.sliders.travels_mm).T
    beyond = ((sliders < low) | (sliders > high)).any(axis=1)
    solved = np.isin(status, (0, 4)) & (sliders != 0.0).any(axis=1)
    assert (beyond & solved).sum() > 20
    np.testing.assert_array_equal((status == 4)[solved], beyond[solved])


def test_guideways_are_drawn_over_both_travels() -> None:
    ends = guideway_ends(MACHINE)
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    np.testing.assert_allclose(lengths, [820.0, 855.0, 840.0])
    directions = np.degrees(np.arctan2(*(ends[:, 1] - ends[:, 0])[:, 1::-1].T)) % 360.0
    np.testing.assert_allclose(directions, [270.0, 10.0, 140.0])


def test_legs_have_their_lengths(poses: tuple[Floats, Floats, Floats, Floats]) -> None:
    position, _, rotation, sliders = poses
    legs = Legs.at(MACHINE, position, rotation, sliders)
    np.testing.assert_allclose(np.linalg.norm(legs.unit, axis=2), 1.0, atol=1e-12)
    vector = slider_points(MACHINE, sliders) + legs.unit * np.array(MACHINE.legs.lengths_mm)[:, None]
    np.testing.assert_allclose(vector, position[:, None] + legs.lever_mm, atol=1e-9)


def test_joint_angles_of_the_samples_are_those_of_points(poses: tuple[Floats, Floats, Floats, Floats]) -> None:
    position, _, rotation, sliders = poses
    legs = Legs.at(MACHINE, position, rotation, sliders)
    slope = np.einsum("nki,ki->nk", legs.unit, legs.along)
    assert (slope[:, 0::2] > 0.0).all()
    assert (slope[:, 1::2] < 0.0).all()
    np.testing.assert_allclose(np.degrees(legs.guideway_angle_rad()), np.degrees(np.arccos(np.abs(slope))))
    # The swing is the thesis' RSSR angle: with it and the pair's circle the ball joint is where it stands.
    swing, joints = legs.swing_rad(), position[:, None] + legs.lever_mm
    for leg in range(6):
        axes = _core.guideway_axes(ENGINE, leg // 2)
        reach = joints[:, leg] - _core.guideway_vertex(ENGINE, leg // 2)
        local = reach @ axes
        np.testing.assert_allclose(np.tan(swing[:, leg]), -local[:, 0] / local[:, 2], atol=1e-9)


@pytest.mark.parametrize("name", [each for each in _core.effect_names() if each.startswith("guideway_")])
def test_geometric_errors_move_the_joints_as_elsewhere(name: str) -> None:
    """Guideway errors act in each guideway's own axes, wherever it stands."""
    info = _core.effect_info(ENGINE, 1, name)
    size = len(info.elements) * len(info.parameters)
    values = 1e-4 * np.random.default_rng(1).normal(size=size)
    sliders = np.array([[200.0, 600.0, 150.0, 620.0, 180.0, 610.0]])
    field = {
        "guideway_translation": "guideway_translation_mm",
        "guideway_rotation_xy": "guideway_rotation_xy_rad",
        "guideway_rotation_yz": "guideway_rotation_yz_rad",
        "guideway_rotation_centre": "guideway_rotation_centre_rad",
    }[name]
    shape = (3, 3) if name == "guideway_translation" else (3,)
    ahead, behind = (
        true_geometry(MACHINE, GeometryErrors(**{field: sign * values.reshape(shape)})).slider_joints_mm(sliders)
        for sign in (1.0, -1.0)
    )
    anywhere = _core.SetUp(cup_mm=np.zeros(3), ball_offset_mm=np.zeros(3), bar_length_mm=0.0)
    rows = np.zeros(1, dtype=np.int32)
    samples = _core.Samples(sliders_mm=sliders, set_up=rows, mount=rows, set_ups=[anywhere])
    per_value = np.asarray(_core.effect_pushes(ENGINE, 1, name, samples, np.zeros(size)))
    first, count = _core.PORTS["slider_joint"]
    pushed = (per_value[0, first : first + count] @ values).reshape(6, 3)
    np.testing.assert_allclose(pushed, (ahead - behind)[0] / 2.0, atol=1e-9)
