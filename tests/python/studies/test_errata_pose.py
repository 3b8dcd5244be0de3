"""Errata of the thesis' chapter 2: orientation, inverse kinematics, Newton step, pose from three joints.

Each printed formula stands here beside the corrected one and the transform or machine it describes.
docs/errata.md lists them; the loop equations are in test_errata.py.
"""

from __future__ import annotations

from dataclasses import dataclass

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
UR, IH, LEG = FILE.platform.circumradius_mm, FILE.platform.joint_plane_height_mm, FILE.legs.length_mm
SIDE_A = np.sqrt(3) * UR
SIDE_B = 2 * np.sqrt(3) * FILE.base.inradius_mm
UP = np.array([0, 0, 1.0])


@dataclass(frozen=True)
class Reached:
    """A pose, its ball joints as columns, its sliders and the RSSR angles the engine finds for them."""

    p: Vector
    rpy: Vector
    sliders: Vector

    @property
    def rotation(self) -> Vector:
        return np.asarray(Rotation.from_euler("xyz", self.rpy).as_matrix())

    @property
    def joints(self) -> Vector:
        return np.column_stack([self.p + self.rotation @ _core.platform_joint(ENGINE, i) for i in range(3)])

    @property
    def angles(self) -> Vector:
        return np.asarray(_core.rssr_angles(ENGINE, self.sliders))

    @property
    def feet(self) -> Vector:
        """f_1..f_3, the ball joints' feet, from each guideway's own vertex."""
        return np.asarray((self.sliders[0::2] + self.sliders[1::2]) / 2)

    @property
    def radii(self) -> Vector:
        """r_1..r_3."""
        return np.asarray(np.sqrt(LEG**2 - ((self.sliders[1::2] - self.sliders[0::2]) / 2) ** 2))


@pytest.fixture(scope="module")
def poses() -> list[Reached]:
    """Tilted poses all: level ones hide half of the misprints."""
    rng = np.random.default_rng(27)
    position = np.column_stack([rng.uniform(-80, 80, (40, 2)), rng.uniform(250, 290, 40)])
    rpy = rng.uniform(0.05, 0.25, (40, 3)) * rng.choice([-1, 1], (40, 3))
    sliders, status = inverse(FILE, position, rpy)
    found = [Reached(*row) for row in zip(position[status == 0], rpy[status == 0], sliders[status == 0], strict=True)]
    assert len(found) > 25
    return found


def test_2_1_entries(poses: list[Reached]) -> None:
    """(1,2), (1,3), (2,1) and (2,3) are misprinted; the rest, and all of (2.27), is Rz(gamma) Ry(beta) Rx(alpha)."""
    wrong = np.array([[0, 1, 1], [1, 0, 1], [0, 0, 0]], bool)
    misses = np.zeros((3, 3))
    for pose in poses:
        (sa, sb, sg), (ca, cb, cg) = np.sin(pose.rpy), np.cos(pose.rpy)
        printed = np.array(
            [
                [cb * cg, sa * sb * cg, ca * sb * sg],
                [ca * sg, sa * sb * sg + ca * cg, ca * sb * sg * sa * cg],
                [-sb, sa * cb, ca * cb],
            ]
        )
        corrected = np.array(
            [
                [cb * cg, sa * sb * cg - ca * sg, ca * sb * cg + sa * sg],
                [cb * sg, sa * sb * sg + ca * cg, ca * sb * sg - sa * cg],
                [-sb, sa * cb, ca * cb],
            ]
        )
        np.testing.assert_allclose(corrected, pose.rotation, atol=1e-15)
        np.testing.assert_allclose(_core.rotation_from_rpy(*pose.rpy), corrected, atol=1e-15)
        misses = np.maximum(misses, np.abs(printed - pose.rotation))
    assert (misses[wrong] > 1e-3).all() and (misses[~wrong] < 1e-15).all()


def test_2_3_to_2_5_joints(poses: list[Reached]) -> None:
    """Ball joints of a frame in the joint plane: (2.3) has one sign wrong in z, (2.5) is garbled, (2.4) is right."""
    for pose in poses:
        u, v, w = pose.rotation.T
        p = pose.p + IH * w  # the thesis' top frame lies in the joint plane in chapter 2-2
        corrected = np.column_stack(
            [
                p + SIDE_A / np.sqrt(3) * u,
                p - np.sqrt(3) / 6 * SIDE_A * u + SIDE_A / 2 * v,
                p - np.sqrt(3) / 6 * SIDE_A * u - SIDE_A / 2 * v,
            ]
        )
        np.testing.assert_allclose(corrected, pose.joints, atol=1e-12)
        printed_z = p[2] - np.sqrt(3) / 3 * SIDE_A * u[2]
        assert abs(printed_z - pose.joints[2, 0]) > 1.0


def test_2_6_to_2_8_sliders(poses: list[Reached]) -> None:
    """Right once read as: t from the vertex, subscripts 2i-1 throughout, S_2i from the guideway's other end."""
    for pose in poses:
        for i in range(3):
            vertex = _core.guideway_vertex(ENGINE, i)
            other = vertex + SIDE_B * _core.guideway_direction(ENGINE, i)
            t, t_other = np.linalg.norm(pose.joints[:, i] - vertex), np.linalg.norm(pose.joints[:, i] - other)
            cosine = (t**2 - t_other**2 + SIDE_B**2) / (2 * t * SIDE_B)  # (2.6)
            root = np.sqrt(LEG**2 - t**2 * (1 - cosine**2))
            assert t * cosine - root == pytest.approx(pose.sliders[2 * i], abs=1e-10)  # (2.7)
            assert (SIDE_B - t * cosine) - root == pytest.approx(SIDE_B - pose.sliders[2 * i + 1], abs=1e-10)  # (2.8)


def loop(angle_i: float, angle_j: float, f: float, g: float, r: float, q: float) -> float:
    """F* of corrected (2.12), its arguments in the order of (2.22)."""
    s, t = np.sin(angle_j), np.sin(angle_i)
    cosines = np.cos(angle_i) * np.cos(angle_j)
    lever = np.sqrt(3) * (f * q * s + g * r * t)
    return float(f**2 + g**2 + q**2 + r**2 - SIDE_A**2 - f * g - lever + q * r * s * t - 2 * q * r * cosines)


def test_2_22_third_loop(poses: list[Reached]) -> None:
    """The engine's angles close F*(theta, delta), F*(delta, phi) and F*(phi, theta), not the printed F*(phi, delta).

    f_i is measured from the vertex which guideways i and i+1 share, where guideway i+1 ends: g_i = b - f_(i+1).
    """
    for pose in poses:
        f, r, angles = pose.feet, pose.radii, pose.angles
        for i in range(3):
            j = (i + 1) % 3
            assert loop(angles[i], angles[j], f[i], SIDE_B - f[j], r[i], r[j]) == pytest.approx(0, abs=1e-7)
    printed = [loop(p.angles[2], p.angles[1], p.feet[2], SIDE_B - p.feet[0], p.radii[2], p.radii[0]) for p in poses]
    assert np.median(np.abs(printed)) > 1e3


def test_2_16_third_row(poses: list[Reached]) -> None:
    """Each partial derivative belongs to its own angle; the printed third row has them exchanged."""
    h, step = 1e-6, np.array([2e-4, -3e-4, 5e-4])
    printed = []
    for pose in poses:
        f, r, (theta, _, phi) = pose.feet, pose.radii, pose.angles

        def third(phi_at: float, theta_at: float, f: Vector = f, r: Vector = r) -> float:
            return loop(phi_at, theta_at, f[2], SIDE_B - f[0], r[2], r[0])

        by_theta = (third(phi, theta + h) - third(phi, theta - h)) / (2 * h)
        by_phi = (third(phi + h, theta) - third(phi - h, theta)) / (2 * h)
        change = third(phi + step[2], theta + step[0]) - third(phi, theta)
        assert by_theta * step[0] + by_phi * step[2] == pytest.approx(change, abs=0.1)
        printed.append(by_theta * step[2] + by_phi * step[0] - change)
    assert np.median(np.abs(printed)) > 2.0


def test_2_17_to_2_20_are_right() -> None:
    """Cramer's rule for the cyclic system, as printed in expanded form, against a linear solution."""
    rng = np.random.default_rng(17)
    for _ in range(50):
        a, b, f = rng.normal(size=(3, 3))  # dF_i / d own angle, dF_i / d next angle, F_i
        matrix = np.array([[a[0], b[0], 0], [0, a[1], b[1]], [b[2], 0, a[2]]])
        determinant = a[0] * a[1] * a[2] + b[0] * b[1] * b[2]  # (2.17)
        assert determinant == pytest.approx(np.linalg.det(matrix))
        step = [
            -f[0] * a[1] * a[2] - f[2] * b[0] * b[1] + f[1] * b[0] * a[2],  # (2.18)
            -f[1] * a[2] * a[0] - f[0] * b[1] * b[2] + f[2] * b[1] * a[0],  # (2.19)
            -f[2] * a[0] * a[1] - f[1] * b[2] * b[0] + f[0] * b[2] * a[1],  # (2.20)
        ]
        np.testing.assert_allclose(np.array(step) / determinant, np.linalg.solve(matrix, -f), rtol=1e-9)


def test_2_23_to_2_25_are_right(poses: list[Reached]) -> None:
    for pose in poses:
        for i in range(3):
            turn = Rotation.from_euler("z", 120 * i, degrees=True).as_matrix()
            lean = Rotation.from_euler("y", -pose.angles[i]).as_matrix() @ [0, 0, pose.radii[i]]
            foot = [FILE.base.inradius_mm, np.sqrt(3) * FILE.base.inradius_mm - pose.feet[i], 0]
            np.testing.assert_allclose(turn @ (foot + lean), pose.joints[:, i], atol=1e-9)


def test_2_26_platform_point(poses: list[Reached]) -> None:
    """IH is to be taken off along the platform's own normal; along base z it is right for a level platform only."""
    for pose in poses:
        centroid = pose.joints.mean(axis=1)
        np.testing.assert_allclose(centroid - IH * pose.rotation @ UP, pose.p, atol=1e-12)
        found = _core.forward_one(ENGINE, pose.sliders, np.zeros(55))[0]
        np.testing.assert_allclose(found, pose.p, atol=1e-10)
        assert np.linalg.norm(centroid - IH * UP - pose.p) > IH * 0.05
    level = Reached(np.array([20.0, -30.0, 270.0]), np.array([0, 0, 0.2]), np.zeros(6))
    np.testing.assert_allclose(level.joints.mean(axis=1) - IH * UP, level.p, atol=1e-12)


def test_2_28_to_2_30_lack_the_joint_plane_height(poses: list[Reached]) -> None:
    """U_i = p + UR (...) u + ... holds with p in the joint plane, so with p + IH w for the p of (2.26)."""
    for pose in poses:
        u, v, w = pose.rotation.T
        offsets = UR * np.column_stack([u, -u / 2 + np.sqrt(3) / 2 * v, -u / 2 - np.sqrt(3) / 2 * v])
        np.testing.assert_allclose(pose.p[:, None] + IH * w[:, None] + offsets, pose.joints, atol=1e-12)
        assert np.abs(pose.p[:, None] + offsets - pose.joints).max() > 0.9 * IH


def test_2_31_to_2_33_orientation(poses: list[Reached]) -> None:
    """(2.32) has its sign reversed; all three take the centroid of the ball joints for p + (0, 0, IH)."""
    for pose in poses:
        u1, u2, u3 = pose.joints.T
        p = pose.joints.mean(axis=1) - IH * UP  # as (2.26) prints it
        alpha, beta, gamma = pose.rpy
        printed_beta = np.arcsin((u1[2] - IH - p[2]) / UR)
        corrected_beta = np.arcsin((IH + p[2] - u1[2]) / UR)
        assert corrected_beta == pytest.approx(beta, abs=1e-12)
        assert printed_beta == pytest.approx(-beta, abs=1e-12)
        assert np.arctan((u1[1] - p[1]) / (u1[0] - p[0])) == pytest.approx(gamma, abs=1e-12)  # (2.31)
        assert np.arcsin((u2[2] - u3[2]) / (np.sqrt(3) * UR * np.cos(beta))) == pytest.approx(
            alpha, abs=1e-12
        )  # (2.33)
        # With the true platform point even the corrected sign is not enough on a tilted platform.
        assert abs(np.arcsin((IH + pose.p[2] - u1[2]) / UR) - beta) > 1e-5
        np.testing.assert_allclose(
            _core.rpy_from_rotation(_core.forward_one(ENGINE, pose.sliders, np.zeros(55))[1]), pose.rpy, atol=1e-12
        )
