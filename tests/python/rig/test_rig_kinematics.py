"""The true machine's kinematics against the nominal closed forms and the meaning of each error parameter."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hexdbb.errors import RunError
from hexdbb.machine import shipped_machine
from hexdbb.rig.geometry import GeometryErrors, rotation_rpy, rotation_z, true_geometry
from hexdbb.rig.plant import Machine, Mounted, Plant, SetupErrors
from hexdbb.rig.pose_solver import Hexapod, Poses, solve_poses

MACHINE = shipped_machine()
BR, UR = MACHINE.base.inradius_mm, MACHINE.platform.circumradius_mm
IH, LEG = MACHINE.platform.joint_plane_height_mm, MACHINE.legs.length_mm
HOME = np.array([0.0, 0.0, 280.0])
PERFECT = SetupErrors({}, (0.0, 0.0, 0.0), 0.0)
SETUP = Mounted(0, (0.0, 0.0, 340.0), (0.0, 0.0, 60.0), 100.0)
# Within reach in every orientation of `angles`: 90 mm to the side, joints below 330 mm.
position = st.tuples(st.floats(-63, 63), st.floats(-63, 63), st.floats(260, 285)).map(np.array)
angles = st.tuples(*[st.floats(-0.15, 0.15)] * 3)


def inverse(p: np.ndarray, r: np.ndarray) -> np.ndarray:
    """Closed form of the project's geometry page: s = f -+ sqrt(l^2 - r^2)."""
    sliders = []
    for i in range(3):
        turn = rotation_z(math.radians(120 * i))
        vertex, direction = turn @ [BR, math.sqrt(3) * BR, 0.0], turn @ [0.0, -1.0, 0.0]
        joint = p + r @ (turn @ [UR, 0.0, 0.0] + [0.0, 0.0, IH])
        f = (joint - vertex) @ direction
        away = joint - vertex - f * direction
        root = math.sqrt(LEG**2 - away @ away)
        sliders += [f - root, f + root]
    return np.array(sliders)


def solved(errors: GeometryErrors, sliders: np.ndarray, longer: np.ndarray | None = None):
    geometry = true_geometry(MACHINE, errors)
    lengths = geometry.lengths_mm if longer is None else geometry.lengths_mm + longer
    points = Hexapod(geometry.slider_joints_mm(sliders)[None], geometry.joints_mm[None], lengths[None])
    poses = solve_poses(points, Poses(HOME[None], np.eye(3)[None]))
    return poses.position_mm[0], poses.rotation[0]


@settings(max_examples=60, deadline=None)
@given(p=position, rpy=angles)
def test_without_errors_it_inverts_the_nominal_inverse_kinematics(p, rpy):
    r = rotation_rpy(*rpy)
    found_p, found_r = solved(GeometryErrors(), inverse(p, r))
    np.testing.assert_allclose(found_p, p, atol=1e-9)
    np.testing.assert_allclose(found_r, r, atol=1e-11)
    np.testing.assert_allclose(true_geometry(MACHINE).sliders_for(p, r), inverse(p, r), atol=1e-9)


def random_errors(seed: int) -> GeometryErrors:
    draw = np.random.default_rng(seed)
    sizes = {"mm": 0.05, "rad": 2e-4}
    values = {}
    for field in dataclasses.fields(GeometryErrors):
        shape = getattr(GeometryErrors(), field.name).shape
        values[field.name] = draw.normal(0.0, sizes[field.name.rsplit("_", 1)[1]], shape)
    return GeometryErrors(**values)


@settings(max_examples=30, deadline=None)
@given(p=position, rpy=angles, seed=st.integers(0, 1000))
def test_one_instant_has_the_pose_and_the_reading_that_it_has_among_others(p, rpy, seed):
    geometry, sliders = true_geometry(MACHINE, random_errors(seed)), inverse(p, rotation_rpy(*rpy))
    machine = Machine(geometry, PERFECT, ())
    alone = machine.poses(sliders[None], None, Poses(HOME[None], np.eye(3)[None]))
    guess = Poses(np.tile(HOME, (2, 1)), np.tile(np.eye(3), (2, 1, 1)))
    both = machine.poses(np.tile(sliders, (2, 1)), None, guess)
    np.testing.assert_allclose(alone.position_mm[0], both.position_mm[1], rtol=0.0, atol=1e-11)
    np.testing.assert_allclose(alone.rotation[0], both.rotation[1], rtol=0.0, atol=1e-13)
    plant = Plant(machine, HOME, np.eye(3))
    plant.step(sliders.tolist(), 0.004)
    np.testing.assert_allclose(plant.poses.position_mm[0], both.position_mm[1], rtol=0.0, atol=1e-11)
    np.testing.assert_allclose(plant.poses.rotation[0], both.rotation[1], rtol=0.0, atol=1e-13)
    reading_mm = machine.reading_mm(SETUP, None, both)[-1]
    assert plant.reading_mm(SETUP) == pytest.approx(reading_mm, rel=0.0, abs=1e-11)


@settings(max_examples=30, deadline=None)
@given(p=position, rpy=angles, seed=st.integers(0, 1000))
def test_with_errors_every_leg_has_its_length(p, rpy, seed):
    geometry, sliders = true_geometry(MACHINE, random_errors(seed)), inverse(p, rotation_rpy(*rpy))
    found_p, found_r = solved(random_errors(seed), sliders)
    ends = geometry.joints_mm @ found_r.T + found_p
    lengths = np.linalg.norm(ends - geometry.slider_joints_mm(sliders), axis=1)
    np.testing.assert_allclose(lengths, geometry.lengths_mm, atol=1e-10)
    np.testing.assert_allclose(found_r @ found_r.T, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(geometry.sliders_for(found_p, found_r), sliders, atol=1e-9)


def test_following_a_path_stays_on_its_branch_and_orthonormal():
    machine = Machine(true_geometry(MACHINE, random_errors(3)), PERFECT, [])
    followed = Plant(machine, HOME, np.eye(3))
    for k in range(2000):
        angle = 2.0 * math.pi * k / 2000
        p = HOME + 100.0 * np.array([math.cos(angle), math.sin(angle), 0.0])
        followed.step(inverse(p, np.eye(3)), 0.004)
        assert np.abs(followed.poses.position_mm[0] - p).max() < 1.0
    rotation = followed.poses.rotation[0]
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-14)


def test_sliders_that_tear_the_machine_apart_are_a_named_error():
    with pytest.raises(RunError, match=r"no pose for sliders \[20.0, 846.0, "):
        plant(PERFECT).step(np.array([20.0, 846.0] * 3), 0.004)


def test_slider_offset_is_a_slider_that_stands_further():
    sliders = inverse(HOME, np.eye(3))
    offset = np.array([0.03, -0.05, 0.02, 0.04, -0.01, 0.06])
    with_offset, moved = (
        solved(GeometryErrors(slider_offset_mm=offset), sliders),
        solved(GeometryErrors(), sliders + offset),
    )
    np.testing.assert_allclose(with_offset[0], moved[0], atol=1e-10)


def test_guideway_translation_along_y_is_minus_a_common_slider_offset():
    """Structural redundancy of the geometry page, exact in the transforms."""
    translation = np.zeros((3, 3))
    translation[:, 1] = [0.05, -0.03, 0.02]
    one = true_geometry(MACHINE, GeometryErrors(guideway_translation_mm=translation))
    other = true_geometry(MACHINE, GeometryErrors(slider_offset_mm=-np.repeat(translation[:, 1], 2)))
    np.testing.assert_allclose(one.anchors_mm, other.anchors_mm, atol=1e-12)


def test_translation_is_outward_towards_the_vertex_and_up():
    translation = np.array([[0.1, 0.2, 0.3]] * 3)
    moved = true_geometry(MACHINE, GeometryErrors(guideway_translation_mm=translation)).anchors_mm
    shift = moved - true_geometry(MACHINE).anchors_mm
    for i in range(3):
        np.testing.assert_allclose(shift[2 * i], rotation_z(math.radians(120 * i)) @ translation[i], atol=1e-12)


@pytest.mark.parametrize("name", ["guideway_rotation_xy_rad", "guideway_rotation_yz_rad"])
def test_rotations_leave_the_guideways_midpoint_where_it_is(name):
    errors = GeometryErrors(**{name: np.array([1e-3, -2e-3, 3e-3])})
    middle = np.full(6, math.sqrt(3.0) * BR)
    turned, nominal = true_geometry(MACHINE, errors), true_geometry(MACHINE)
    np.testing.assert_allclose(turned.slider_joints_mm(middle), nominal.slider_joints_mm(middle), atol=1e-10)
    angle = np.arccos(np.einsum("ij,ij->i", turned.directions, nominal.directions))
    np.testing.assert_allclose(angle, np.repeat([1e-3, 2e-3, 3e-3], 2), rtol=1e-4)
    if name.endswith("xy_rad"):  # about local z: positive turns y towards -x, so the far end (-y) moves to +x, outward
        far = turned.slider_joints_mm(middle + 100.0) - nominal.slider_joints_mm(middle + 100.0)
        assert far[0] @ [1.0, 0.0, 0.0] == pytest.approx(0.1, rel=1e-3)
    else:  # about local x: positive turns y up, so the far end goes down
        far = turned.slider_joints_mm(middle + 100.0) - nominal.slider_joints_mm(middle + 100.0)
        assert far[0] @ [0.0, 0.0, 1.0] == pytest.approx(-0.1, rel=1e-3)


def test_rotation_about_the_base_centre_of_all_guideways_turns_the_platform():
    angle = 5e-4
    p, r = solved(GeometryErrors(guideway_rotation_centre_rad=np.full(3, angle)), inverse(HOME, np.eye(3)))
    np.testing.assert_allclose(p, HOME, atol=1e-9)
    np.testing.assert_allclose(r, rotation_z(angle), atol=1e-11)


def test_platform_sides_have_their_lengths_and_the_triangle_stays_put():
    longer = np.array([0.08, -0.05, 0.03])
    joints = true_geometry(MACHINE, GeometryErrors(platform_side_mm=longer)).joints_mm[::2]
    nominal = true_geometry(MACHINE).joints_mm[::2]
    sides = [np.linalg.norm(joints[a] - joints[b]) for a, b in ((0, 1), (1, 2), (2, 0))]
    np.testing.assert_allclose(sides, math.sqrt(3.0) * UR + longer, atol=1e-12)
    np.testing.assert_allclose(joints.mean(axis=0), nominal.mean(axis=0), atol=1e-12)
    turn = np.sum(np.cross(nominal - nominal.mean(axis=0), joints - joints.mean(axis=0)), axis=0)
    np.testing.assert_allclose(turn, 0.0, atol=1e-9)


def plant(errors: SetupErrors = PERFECT) -> Plant:
    return Plant(Machine(true_geometry(MACHINE), errors, []), HOME, np.eye(3))


def reading(machine: Plant, p: np.ndarray) -> float:
    machine.step(inverse(p, np.eye(3)), 0.004)
    return machine.reading_mm(SETUP)


@given(angle=st.floats(0.0, 6.28))
@settings(max_examples=20, deadline=None)
def test_perfect_circle_reads_zero(angle):
    p = HOME + 100.0 * np.array([math.cos(angle), math.sin(angle), 0.0])
    assert reading(plant(), p) == pytest.approx(0.0, abs=1e-9)


def test_set_up_errors_shift_the_reading_as_geometry_says():
    p = HOME + np.array([100.0, 0.0, 0.0])
    assert reading(plant(SetupErrors({}, (0.0, 0.0, 0.0), 0.005)), p) == pytest.approx(-0.005, abs=1e-9)
    cup = (0.02, 0.0, 0.0)
    assert reading(plant(SetupErrors({0: cup}, (0.0, 0.0, 0.0), 0.0)), p) == pytest.approx(-0.02, abs=1e-9)
    assert reading(plant(SetupErrors({1: cup}, (0.0, 0.0, 0.0), 0.0)), p) == pytest.approx(0.0, abs=1e-9)
    assert reading(plant(SetupErrors({}, (0.03, 0.0, 0.0), 0.0)), p) == pytest.approx(0.03, abs=1e-9)


def test_legs_grown_by_mechanisms_act_as_leg_errors():
    sliders, longer = inverse(HOME, np.eye(3)), np.array([0.01, 0.02, -0.03, 0.0, 0.05, -0.02])
    one, other = solved(GeometryErrors(leg_length_mm=longer), sliders), solved(GeometryErrors(), sliders, longer)
    np.testing.assert_allclose(one[0], other[0], atol=1e-12)
