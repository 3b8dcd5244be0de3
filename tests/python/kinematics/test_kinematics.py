"""Kinematics through Python: round trips over the whole workspace, symmetry, statuses, SciPy as a third solver."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from hexdbb import _core
from hexdbb.kinematics import engine_machine, forward, inverse, status_name
from hexdbb.machine import shipped_machine

Vector = NDArray[np.float64]

FILE = shipped_machine()
ENGINE = engine_machine(FILE)
HOME = np.array([0.0, 0.0, 280.0])
JOINTS = np.array([_core.platform_joint(ENGINE, i) for i in (0, 0, 1, 1, 2, 2)])
VERTICES = np.array([_core.guideway_vertex(ENGINE, i) for i in (0, 0, 1, 1, 2, 2)])
DIRECTIONS = np.array([_core.guideway_direction(ENGINE, i) for i in (0, 0, 1, 1, 2, 2)])


def rotation(rpy: Vector) -> Vector:
    """Rz(yaw) Ry(pitch) Rx(roll), by SciPy."""
    return np.asarray(Rotation.from_euler("xyz", rpy).as_matrix())


def hold(position: Vector, rpy: Vector, sliders: Vector) -> tuple[float, float]:
    """Determinant and smallest singular value of the legs' Jacobian, turns in units of the platform's circumradius."""
    arms = JOINTS @ rotation(rpy).T
    legs = position + arms - (VERTICES + sliders[:, None] * DIRECTIONS)
    legs /= np.linalg.norm(legs, axis=1)[:, None]
    rows = np.hstack([legs, np.cross(arms / FILE.platform.circumradius_mm, legs)])
    return float(np.linalg.det(rows)), float(np.linalg.svd(rows, compute_uv=False)[-1])


def solve(position: Vector, rpy: Vector) -> tuple[Vector, int]:
    sliders, status = inverse(FILE, position[None], rpy)
    return sliders[0], int(status[0])


HOME_SIDE = hold(HOME, np.zeros(3), solve(HOME, np.zeros(3))[0])[0]

poses = st.tuples(
    st.floats(-300, 300), st.floats(-300, 300), st.floats(0, 420),
    st.floats(-0.35, 0.35), st.floats(-0.35, 0.35), st.floats(-0.45, 0.45),
)  # fmt: skip


def reached(pose: tuple[float, ...]) -> tuple[Vector, Vector, Vector]:
    """Sliders of a pose that the machine reaches and holds; any other is left out."""
    position, rpy = np.array(pose[:3]), np.array(pose[3:])
    sliders, status = solve(position, rpy)
    assume(status == 0)
    determinant, smallest = hold(position, rpy, sliders)
    assume(determinant * HOME_SIDE > 0 and smallest > 0.02)
    return position, rpy, sliders


# Poses are drawn around the middle of the workspace towards the drawn one, so that few are thrown away.
shares = st.floats(0.0, 1.0)


@settings(max_examples=400, deadline=None, derandomize=True)
@given(poses, shares)
def test_round_trip_over_the_whole_workspace(pose: tuple[float, ...], share: float) -> None:
    home = np.array([0, 0, 240.0, 0, 0, 0])
    position, rpy, sliders = reached(tuple(home + share * (np.array(pose) - home)))
    found, matrix, status = forward(FILE, sliders[None])
    assert status_name(int(status[0])) == "ok"
    np.testing.assert_allclose(found[0], position, atol=1e-10, rtol=0)
    np.testing.assert_allclose(matrix[0], rotation(rpy), atol=1e-12, rtol=0)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(poses, shares)
def test_a_third_of_a_turn_shifts_the_pairs_by_one(pose: tuple[float, ...], share: float) -> None:
    home = np.array([0, 0, 240.0, 0, 0, 0])
    position, rpy, sliders = reached(tuple(home + share * (np.array(pose) - home)))
    third = np.asarray(Rotation.from_euler("z", 120, degrees=True).as_matrix())
    # Turned with all else about the base's axis, and back by a third in its own frame: ball joints change places.
    turned = Rotation.from_matrix(third @ rotation(rpy) @ third.T).as_euler("xyz")
    shifted, status = solve(third @ position, turned)
    assert status == 0
    np.testing.assert_allclose(shifted, np.roll(sliders, 2), atol=1e-9)


@pytest.mark.parametrize(
    ("position", "rpy", "name"),
    [
        (HOME, (0.0, 0.0, 0.0), "ok"),
        ((0.0, 0.0, 1000.0), (0.0, 0.0, 0.0), "unreachable"),
        ((0.0, 150.0, 150.0), (0.0, 0.0, 0.0), "travel"),
        ((0.0, 0.0, 357.2), (0.0, 0.0, 0.0), "gap"),
        ((0.0, 0.0, np.nan), (0.0, 0.0, 0.0), "unreachable"),
        ((0.0, 0.0, 280.0), (0.0, np.inf, 0.0), "unreachable"),
    ],
)
def test_inverse_status_by_name(position: Vector, rpy: tuple[float, ...], name: str) -> None:
    sliders, status = solve(np.array(position), np.array(rpy))
    assert status_name(status).split(":")[0] == name
    assert np.isfinite(sliders).all()


def test_forward_status_by_name() -> None:
    good = solve(HOME, np.zeros(3))[0]
    apart, together, open_loop = good.copy(), good.copy(), np.array([33.1, 832.9] * 3)
    apart[:2] = 20.0, 840.0
    together[2] = together[3]
    position, matrix, status = forward(FILE, np.array([good, apart, together, open_loop, good]))
    names = [status_name(int(code)).split(":")[0] for code in status]
    assert names[:3] == ["ok", "unreachable", "unreachable"]
    assert names[3] in {"singular", "iteration limit"}
    assert names[4] == "ok"
    np.testing.assert_allclose(position[4], HOME, atol=1e-10)
    assert not position[1:4].any() and not matrix[1:4].any()


def test_order_of_rows_does_not_matter() -> None:
    """A row's pose is its own, however far the rows around it are."""
    rng = np.random.default_rng(7)
    position = np.column_stack([rng.uniform(-100, 100, (300, 2)), rng.uniform(230, 300, 300)])
    rpy = rng.uniform(-0.2, 0.2, (300, 3))
    sliders, status = inverse(FILE, position, rpy)
    ok = status == 0
    assert ok.sum() > 200
    found, _, status = forward(FILE, sliders[ok])
    assert not status.any()
    np.testing.assert_allclose(found, position[ok], atol=1e-10)


def test_orientation_is_thesis_2_27() -> None:
    for rpy in np.random.default_rng(8).uniform(-1.2, 1.2, (20, 3)):
        np.testing.assert_allclose(_core.rotation_from_rpy(*rpy), rotation(rpy), atol=1e-15)
        np.testing.assert_allclose(_core.rpy_from_rotation(rotation(rpy)), rpy, atol=1e-13)


@pytest.mark.parametrize("seed", range(5))
def test_scipy_finds_the_same_pose(seed: int) -> None:
    """Least squares on six leg lengths, with pushes; nothing of the engine but the nominal points."""
    rng = np.random.default_rng(seed)
    position = np.array([*rng.uniform(-80, 80, 2), rng.uniform(240, 290)])
    rpy = rng.uniform(-0.15, 0.15, 3)
    sliders, status = solve(position, rpy)
    assert status == 0
    push = np.zeros(55)
    first, count = _core.PORTS["leg"]
    push[first : first + count] = rng.uniform(-0.1, 0.1, count)
    first, count = _core.PORTS["slider_joint"]
    moved = rng.uniform(-0.1, 0.1, (6, 3))
    push[first : first + count] = moved.ravel()
    lengths = FILE.legs.length_mm + push[slice(*np.cumsum(_core.PORTS["leg"]))]

    def misses(x: Vector) -> Vector:
        ends = x[:3] + JOINTS @ rotation(x[3:]).T - (VERTICES + sliders[:, None] * DIRECTIONS + moved)
        return np.linalg.norm(ends, axis=1) - lengths

    wanted = least_squares(
        misses, np.r_[HOME, 0, 0, 0], xtol=1e-15, ftol=1e-15, gtol=1e-15, x_scale=[1, 1, 1, 0.01, 0.01, 0.01]
    )
    assert np.abs(wanted.fun).max() < 1e-9
    for solver in (_core.forward_one, _core.forward_six_one):
        found, matrix, residual, _, code = solver(ENGINE, sliders, push)
        assert status_name(code) == "ok"
        assert residual <= 1e-12
        np.testing.assert_allclose(found, wanted.x[:3], atol=1e-8)
        np.testing.assert_allclose(matrix, rotation(wanted.x[3:]), atol=1e-10)
