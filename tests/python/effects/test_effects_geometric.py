"""The geometric effects through Python: names, what they do to the machine, and the redundancies among them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from hexdbb import _core
from hexdbb.kinematics import engine_machine, inverse
from hexdbb.machine import shipped_machine

Vector = NDArray[np.float64]

FILE = shipped_machine()
ENGINE = engine_machine(FILE)
BR, UR = FILE.base.inradius_mm, FILE.platform.circumradius_mm
CUP, BALL = np.array([0, 0, 340.0]), np.array([0, 0, 60.0])

# Thesis section 3.2: effect -> number of elements, parameters of one.
THE_33 = {
    "leg_length": (6, ["mm"]),
    "slider_offset": (6, ["mm"]),
    "guideway_translation": (3, ["mm", "mm", "mm"]),
    "guideway_rotation_xy": (3, ["rad"]),
    "guideway_rotation_yz": (3, ["rad"]),
    "guideway_rotation_centre": (3, ["rad"]),
    "platform_side": (3, ["mm"]),
}
SET_UP = {"cup_position": (2, ["mm"] * 3), "ball_offset": (1, ["mm"] * 3), "bar_length": (1, ["mm"])}


@pytest.fixture(scope="module")
def samples() -> _core.Samples:
    """A circle with the platform turned about all three axes, two mounts in turn."""
    angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    rpy = np.array([0.08, -0.1, 0.15])
    ball = CUP + np.column_stack([100 * np.cos(angle), 100 * np.sin(angle), np.zeros(48)])
    sliders, status = inverse(FILE, ball - _core.rotation_from_rpy(*rpy) @ BALL, rpy)
    assert not status.any()
    set_up = _core.SetUp(cup_mm=CUP, ball_offset_mm=BALL, bar_length_mm=100.0)
    mount = np.arange(48, dtype=np.int32) % 2
    return _core.Samples(sliders_mm=sliders, set_up=np.zeros(48, np.int32), mount=mount, set_ups=[set_up])


def sliders_of(samples: _core.Samples) -> Vector:
    """The samples' slider coordinates, back from the nominal machine's poses."""
    poses, _ = _core.forward_table(_core.Model(ENGINE), samples)
    rpy = np.array([_core.rpy_from_rotation(row[3:].reshape(3, 3)) for row in poses])
    return np.asarray(inverse(FILE, poses[:, :3], rpy)[0])


def model_with(**effects: list[float]) -> _core.Model:
    model = _core.Model(ENGINE)
    for name in effects:
        model.add(name, 2)
    model.values = np.concatenate([np.asarray(values, float) for values in effects.values()])
    return model


def reading(samples: _core.Samples, **effects: list[float]) -> Vector:
    predicted = _core.predict(model_with(**effects), samples)
    assert predicted.first_failure == -1
    return np.asarray(predicted.reading_mm)


@pytest.mark.parametrize(("name", "elements", "units"), [(n, *shape) for n, shape in {**THE_33, **SET_UP}.items()])
def test_effect_says_what_it_is(name: str, elements: int, units: list[str]) -> None:
    info = _core.effect_info(ENGINE, 2, name)
    assert (len(info.elements), [parameter.unit for parameter in info.parameters]) == (elements, units)
    assert info.size == elements * len(units)
    assert info.is_set_up == (name in SET_UP)
    assert info.physics.endswith(".") and info.source
    assert set(info.ports) <= set(_core.PORTS)
    for parameter in info.parameters:
        assert 0 < parameter.prior_sigma < parameter.limit


def test_there_are_thirty_three() -> None:
    assert sum(elements * len(units) for elements, units in THE_33.values()) == 33
    assert list(_core.effect_names())[:7] == list(THE_33)


def test_unknown_effect_is_named_with_the_known_ones() -> None:
    with pytest.raises(ValueError, match=r'"leg_lenght" \(known: leg_length, slider_offset'):
        _core.effect_info(ENGINE, 1, "leg_lenght")


@pytest.mark.parametrize("name", [*THE_33, *SET_UP])
def test_derivatives_against_differences(samples: _core.Samples, name: str) -> None:
    info = _core.effect_info(ENGINE, 2, name)
    size = np.array(
        [{"mm": 0.3, "rad": 1e-3}[info.parameters[k % len(info.parameters)].unit] for k in range(info.size)]
    )
    base = size * np.random.default_rng(5).normal(size=info.size)
    jacobian = _core.predict(model_with(**{name: list(base)}), samples, True).jacobian
    for k in range(info.size):
        step = np.zeros(info.size)
        step[k] = 0.01 * size[k]
        slope = (reading(samples, **{name: base + step}) - reading(samples, **{name: base - step})) / (2 * step[k])
        assert np.abs(slope).max() > 0
        np.testing.assert_allclose(jacobian[:, k], slope, atol=1e-6 * np.abs(slope).max())


def test_legs_and_sides_are_as_long_as_said(samples: _core.Samples) -> None:
    """Ball joints rebuilt from the pose: longer legs away from the sliders, longer sides from each other."""
    longer, sides = np.array([0.3, -0.2, 0.1, 0.4, -0.5, 0.2]), np.array([0.2, -0.1, 0.3])
    model = model_with(leg_length=list(longer), platform_side=list(sides))
    poses, status = _core.forward_table(model, samples)
    assert not status.any()
    vertices = np.array([_core.guideway_vertex(ENGINE, k // 2) for k in range(6)])
    directions = np.array([_core.guideway_direction(ENGINE, k // 2) for k in range(6)])
    legs = FILE.legs.length_mm + longer
    for pose, s in zip(poses, sliders_of(samples), strict=True):
        joints = vertices + s[:, None] * directions
        found = [meeting_point(joints[2 * i : 2 * i + 2], legs[2 * i : 2 * i + 2], pose, i) for i in range(3)]
        lengths = [np.linalg.norm(found[i] - found[(i + 1) % 3]) for i in range(3)]
        np.testing.assert_allclose(lengths, np.sqrt(3) * UR + sides, atol=1e-8)


def meeting_point(joints: Vector, legs: Vector, pose: Vector, pair: int) -> Vector:
    """Where two legs meet in the plane of the platform's joints: sides differ from nominal in that plane only."""
    rotation = pose[3:].reshape(3, 3)
    plane_point = pose[:3] + rotation @ _core.platform_joint(ENGINE, pair)
    normal = rotation[:, 2]
    point = plane_point.copy()
    for _ in range(8):  # Newton on: two leg lengths, in the platform's plane
        arms = point - joints
        misses = np.array(
            [arms[0] @ arms[0] - legs[0] ** 2, arms[1] @ arms[1] - legs[1] ** 2, normal @ (point - plane_point)]
        )
        point = point - np.linalg.solve(np.vstack([2 * arms, normal]), misses)
    return point


@pytest.mark.parametrize(
    ("name", "local_axis", "about_midpoint"),
    [("guideway_rotation_xy", 2, True), ("guideway_rotation_yz", 0, True), ("guideway_rotation_centre", 2, False)],
)
def test_turned_guideway_is_a_rigid_turn(
    samples: _core.Samples, name: str, local_axis: int, about_midpoint: bool
) -> None:
    """Slider joints turned as one body about the effect's axis are a leg's length from the ball joints of the pose."""
    angles = np.array([4e-3, -2e-3, 3e-3])
    poses, status = _core.forward_table(model_with(**{name: list(angles)}), samples)
    assert not status.any()
    for pose, s in zip(poses, sliders_of(samples), strict=True):
        for k in range(6):
            i = k // 2
            centre = _core.guideway_midpoint(ENGINE, i) if about_midpoint else np.zeros(3)
            turn = Rotation.from_rotvec(angles[i] * _core.guideway_axes(ENGINE, i)[:, local_axis])
            slider = _core.guideway_vertex(ENGINE, i) + s[k] * _core.guideway_direction(ENGINE, i)
            ball = pose[:3] + pose[3:].reshape(3, 3) @ _core.platform_joint(ENGINE, i)
            length = np.linalg.norm(ball - centre - turn.apply(slider - centre))
            assert length == pytest.approx(FILE.legs.length_mm, abs=1e-9)


def test_translation_along_y_is_a_common_slider_offset(samples: _core.Samples) -> None:
    moved = reading(samples, guideway_translation=[0, 0.6, 0, 0, -0.4, 0, 0, 0.2, 0])
    offset = reading(samples, slider_offset=[-0.6, -0.6, 0.4, 0.4, -0.2, -0.2])
    assert np.abs(moved).max() > 0.1
    np.testing.assert_allclose(moved, offset, atol=1e-10)


def test_turn_about_base_centre_is_a_turn_about_the_midpoint_and_a_translation(samples: _core.Samples) -> None:
    angle = 2e-3
    about_centre = reading(samples, guideway_rotation_centre=[angle, 0, 0])
    first_order = reading(samples, guideway_rotation_xy=[angle, 0, 0], guideway_translation=[0, BR * angle, *[0] * 7])
    shift = [BR * (np.cos(angle) - 1), BR * np.sin(angle)]
    exact = reading(samples, guideway_rotation_xy=[angle, 0, 0], guideway_translation=[*shift, *[0] * 7])
    np.testing.assert_allclose(about_centre, exact, atol=1e-10)
    assert 1e-6 < np.abs(about_centre - first_order).max() < 4 * BR * angle**2


def test_all_guideways_turned_and_cup_with_them_reads_the_same(samples: _core.Samples) -> None:
    """A rigid turn of the whole base about z, the cup on that axis: nothing to see."""
    angle = 3e-3
    turned = reading(samples, guideway_rotation_centre=[angle] * 3)
    np.testing.assert_allclose(turned, reading(samples, leg_length=[0.0] * 6), atol=1e-9)


def test_cup_position_belongs_to_its_mount(samples: _core.Samples) -> None:
    only_second = reading(samples, cup_position=[0, 0, 0, 0.5, 0, 0])
    np.testing.assert_allclose(only_second[0::2], 0.0, atol=1e-11)
    assert np.abs(only_second[1::2]).max() > 0.4


def test_mount_beyond_the_model_is_refused(samples: _core.Samples) -> None:
    model = _core.Model(ENGINE)
    model.add("cup_position", 1)
    with pytest.raises(ValueError, match=r"mount\[1\] is 1, expected 0 to 0"):
        _core.predict(model, samples)
