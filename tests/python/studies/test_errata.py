"""Errata of the thesis' loop equations (2.11-2.22, chapter 3), each against the point transform it comes from.

The frame is that of Figure 2.4: origin at the vertex which guideways 1 and 2 share, x outward across guideway 1, z up.
Guideway 1 runs along -y, guideway 2 along Rot(z, -60 deg)(0, -1, 0). f and g are the distances of the ball joints'
feet from the vertex, r and q the ball joints' distances from the guideways, theta and delta their lean inward. b in
(2.11) is the platform's side.

A linear term is right where it is the derivative of |U1 U2|^2 at no error, and where the engine's machine, with that
guideway moved, obeys it. docs/errata.md lists the findings.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from hexdbb import _core
from hexdbb.kinematics import engine_machine, inverse
from hexdbb.machine import shipped_machine

Vector = NDArray[np.float64]
Move = Callable[[Vector, float], Vector]

SQRT3 = np.sqrt(3.0)
BR = shipped_machine().base.inradius_mm
M = SQRT3 * BR  # from the vertex to a guideway's midpoint
STEP = 1e-5


def rot(axis: str, angle_rad: float) -> Vector:
    return np.asarray(Rotation.from_euler(axis, angle_rad).as_matrix())


TO_GUIDEWAY_2 = rot("z", -np.pi / 3)


def squared(v: Vector) -> float:
    return float(v @ v)


@dataclass(frozen=True)
class Loop:
    """Two ball joints by the thesis' variables, mm and rad."""

    f: float
    g: float
    q: float
    r: float
    theta: float
    delta: float

    @property
    def u1(self) -> Vector:
        """(2.9)."""
        return np.array([0, -self.f, 0]) + rot("y", -self.theta) @ [0, 0, self.r]

    @property
    def u2(self) -> Vector:
        """(2.10)."""
        return TO_GUIDEWAY_2 @ (np.array([0, -self.g, 0]) + rot("y", self.delta) @ [0, 0, self.q])

    @property
    def st(self) -> float:
        return float(np.sin(self.theta))

    @property
    def ct(self) -> float:
        return float(np.cos(self.theta))

    @property
    def sd(self) -> float:
        return float(np.sin(self.delta))

    @property
    def cd(self) -> float:
        return float(np.cos(self.delta))

    def common(self) -> float:
        """(2.11) without its term in q r cos cos, which is misprinted there."""
        squares = self.f**2 + self.g**2 + self.q**2 + self.r**2
        lever = SQRT3 * (self.f * self.q * self.sd + self.g * self.r * self.st)
        return squares - self.f * self.g - lever + self.q * self.r * self.sd * self.st

    def printed_2_11(self) -> float:
        return self.common() - 2 * self.q * self.r * self.sd * self.st

    def corrected_2_11(self) -> float:
        return self.common() - 2 * self.q * self.r * self.cd * self.ct


@pytest.fixture(scope="module")
def loops() -> list[Loop]:
    rng = np.random.default_rng(33)
    low, high = [200, 200, 250, 250, -0.7, -0.7], [650, 650, 400, 400, 0.9, 0.9]
    return [Loop(*(float(value) for value in rng.uniform(low, high))) for _ in range(100)]


def misses(loops: list[Loop], found: Callable[[Loop], float], wanted: Callable[[Loop], float]) -> Vector:
    return np.array([found(loop) - wanted(loop) for loop in loops])


# --- the loop equation ----------------------------------------------------------------------------------------------


def distance_squared(loop: Loop) -> float:
    return squared(loop.u1 - loop.u2)


@pytest.mark.parametrize("equation", ["2.11", "2.12", "3.3"])
def test_loop_equation_has_a_product_of_cosines(equation: str, loops: list[Loop]) -> None:
    np.testing.assert_allclose(misses(loops, Loop.corrected_2_11, distance_squared), 0, atol=1e-8)
    if equation != "3.3":  # (3.3) prints it as it should be
        assert np.abs(misses(loops, Loop.printed_2_11, distance_squared)).min() > 1e3


# --- first-order terms of displaced guideways (3.2-3.37) ------------------------------------------------------------


def shift(x: float, y: float, z: float) -> Move:
    return lambda u, error: u + error * np.array([x, y, z])


def turn(axis: Vector, centre: Vector) -> Move:
    """A turn about an axis through a point."""
    return lambda u, error: centre + Rotation.from_rotvec(error * axis).as_matrix() @ (u - centre)


X, Z = np.eye(3)[0], np.eye(3)[2]
MIDPOINT_1, MIDPOINT_2 = np.array([0, -M, 0]), TO_GUIDEWAY_2 @ [0, -M, 0]
BASE_CENTRE = np.array([-BR, -M, 0])


@dataclass(frozen=True)
class Case:
    """One displaced guideway: its linear term as printed and as it should be, and the same error in the engine."""

    equation: str
    guideway: int  # 1: U1 moves (Type I), 2: U2 moves (Type II)
    move: Move
    printed: Callable[[Loop], float]
    correct: Callable[[Loop], float]
    effect: str
    value: int  # which value of the effect
    sign: float = 1.0  # of the effect's value for a positive error of the thesis
    small: float = 0.05  # size to try in the engine, mm or rad

    @property
    def is_right_in_print(self) -> bool:
        return self.printed is self.correct


def type_i_centre(v: Loop) -> float:
    return (
        SQRT3 * v.f * v.g - 2 * BR * (v.f + v.g) + (2 * M - v.g) * v.r * v.st + (2 * M - v.f) * v.q * v.sd
        - SQRT3 * v.q * v.r * v.st * v.sd
    )  # fmt: skip


def x_i(v: Loop) -> float:
    return SQRT3 * v.g - v.q * v.sd - 2 * v.r * v.st


def x_ii(v: Loop) -> float:
    return SQRT3 * v.f - v.r * v.st - 2 * v.q * v.sd


def z_i(v: Loop) -> float:
    return 2 * (v.r * v.ct - v.q * v.cd)


def z_ii(v: Loop) -> float:
    return -z_i(v)


def centre_ii(v: Loop) -> float:
    return -type_i_centre(v)


CASES = [
    Case("3.3", 1, shift(1, 0, 0), x_i, x_i, "guideway_translation", 0),
    Case("3.6", 2, shift(-0.5, SQRT3 / 2, 0), x_ii, x_ii, "guideway_translation", 3),
    Case(
        "3.9", 1, shift(0, 1, 0),
        lambda v: v.g - 2 * v.f - SQRT3 * v.q * v.sd,
        lambda v: v.g - 2 * v.f + SQRT3 * v.q * v.sd,
        "guideway_translation", 1,
    ),
    Case(  # towards the vertex shared with guideway 1: against guideway 2's own y
        "3.12", 2, shift(*(TO_GUIDEWAY_2 @ [0, 1, 0])),
        lambda v: v.f - 2 * v.g - SQRT3 * v.r * v.st,
        lambda v: v.f - 2 * v.g + SQRT3 * v.r * v.st,
        "guideway_translation", 4, -1.0,
    ),
    Case("3.15", 1, shift(0, 0, 1), z_i, z_i, "guideway_translation", 2),
    Case("3.18", 2, shift(0, 0, 1), z_ii, z_ii, "guideway_translation", 5),
    Case(
        "3.21", 1, turn(Z, MIDPOINT_1),
        lambda v: -SQRT3 * v.f * v.g - 3 * BR * v.f + (2 * M + v.g) * v.r * v.st + (M + v.f) * v.q * v.sd
        + SQRT3 * v.q * v.r * v.st * v.sd,
        lambda v: SQRT3 * v.f * v.g - 3 * BR * v.g + (2 * M - v.g) * v.r * v.st + (M - v.f) * v.q * v.sd
        - SQRT3 * v.q * v.r * v.st * v.sd,
        "guideway_rotation_xy", 0, small=1e-4,
    ),
    Case(
        "3.24", 2, turn(-Z, MIDPOINT_2),
        lambda v: -SQRT3 * v.f * v.g + 3 * BR * v.f + (M - v.g) * v.r * v.st + (2 * M - v.f) * v.q * v.sd
        - SQRT3 * v.q * v.r * v.st * v.sd,
        lambda v: SQRT3 * v.f * v.g - 3 * BR * v.f + (M - v.g) * v.r * v.st + (2 * M - v.f) * v.q * v.sd
        - SQRT3 * v.q * v.r * v.st * v.sd,
        "guideway_rotation_xy", 1, -1.0, 1e-4,
    ),
    Case(
        "3.27", 1, turn(X, MIDPOINT_1),
        lambda v: -SQRT3 * v.f * v.g + v.g * v.r * v.st + v.f * v.q * v.sd + 2 * M * (v.r - v.q) * v.cd
        + SQRT3 * v.q * v.r * v.st * v.sd,
        lambda v: (2 * M - v.g) * v.r * v.ct - 2 * (M - v.f) * v.q * v.cd - SQRT3 * v.q * v.r * v.ct * v.sd,
        "guideway_rotation_yz", 0, small=1e-4,
    ),
    Case(  # about guideway 2's own x, which points inward in (3.29)
        "3.30", 2, turn(-TO_GUIDEWAY_2 @ X, MIDPOINT_2),
        lambda v: -2 * (v.g + M) * v.r * v.ct + (v.f + 2 * M) * v.q * v.cd + SQRT3 * v.q * v.r * v.st * v.sd,
        lambda v: 2 * (M - v.g) * v.r * v.ct - (2 * M - v.f) * v.q * v.cd + SQRT3 * v.q * v.r * v.st * v.cd,
        "guideway_rotation_yz", 1, 1.0, 1e-4,
    ),
    Case("3.33", 1, turn(Z, BASE_CENTRE), type_i_centre, type_i_centre, "guideway_rotation_centre", 0, small=1e-4),
    Case("3.36", 2, turn(Z, BASE_CENTRE), centre_ii, centre_ii, "guideway_rotation_centre", 1, small=1e-4),
]  # fmt: skip
case = pytest.mark.parametrize("case", CASES, ids=lambda case: case.equation)
RIGHT_IN_PRINT = {"3.3", "3.6", "3.15", "3.18", "3.33", "3.36"}


def slope(case: Case, loop: Loop) -> float:
    """d |U1 U2|^2 / d error at no error, by central differences of the point transform."""

    def moved(error: float) -> float:
        u1 = case.move(loop.u1, error) if case.guideway == 1 else loop.u1
        u2 = case.move(loop.u2, error) if case.guideway == 2 else loop.u2
        return squared(u1 - u2)

    return (moved(STEP) - moved(-STEP)) / (2 * STEP)


@case
def test_linear_term_is_the_derivative_of_the_point_transform(case: Case, loops: list[Loop]) -> None:
    scale = np.abs([slope(case, loop) for loop in loops]).max()
    corrected = misses(loops, case.correct, lambda loop: slope(case, loop)) / scale
    printed = misses(loops, case.printed, lambda loop: slope(case, loop)) / scale
    np.testing.assert_allclose(corrected, 0, atol=1e-6)
    assert case.is_right_in_print == (case.equation in RIGHT_IN_PRINT)
    if not case.is_right_in_print:
        assert np.sqrt(np.mean(printed**2)) > 0.1
        # Nor is it the term of the opposite error.
        assert np.sqrt(np.mean(misses(loops, lambda v: -case.printed(v), lambda v: slope(case, v)) ** 2)) / scale > 0.1


@case
def test_engine_obeys_the_corrected_term(case: Case) -> None:
    """With one guideway moved by its effect, the engine closes the corrected loop to second order, not the printed."""
    printed, correct = engine_misses(case)
    second_order = {0.05: 0.05**2, 1e-4: (1e-4 * 1000) ** 2}[case.small]
    assert np.abs(correct).max() < 2 * second_order
    if not case.is_right_in_print:
        assert np.abs(printed).max() > 50 * np.abs(correct).max()


def engine_misses(case: Case) -> tuple[Vector, Vector]:
    """(2.11) plus the linear term, printed and corrected, minus the platform's side squared, for poses of a circle."""
    file = shipped_machine()
    machine = engine_machine(file)
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    position = np.column_stack([100 * np.cos(angle), 100 * np.sin(angle), np.full(12, 280.0)])
    sliders, status = inverse(file, position, np.array([0.1, -0.15, 0.2]))
    assert not status.any()
    model = _core.Model(machine)
    model.add(case.effect, 1)
    values = np.zeros(model.size)
    values[case.value] = case.sign * case.small
    model.values = values
    rows = np.zeros(12, dtype=np.int32)
    set_up = _core.SetUp(cup_mm=np.zeros(3), ball_offset_mm=np.zeros(3), bar_length_mm=0.0)
    samples = _core.Samples(sliders_mm=sliders, set_up=rows, mount=rows, set_ups=[set_up])
    poses, status = _core.forward_table(model, samples)
    assert not status.any()

    side_squared = 3 * file.platform.circumradius_mm**2
    vertex = _core.guideway_vertex(machine, 0)
    printed, correct = [], []
    for pose, s in zip(poses, sliders, strict=True):
        joints = [pose[:3] + pose[3:].reshape(3, 3) @ _core.platform_joint(machine, i) - vertex for i in range(2)]
        joints[case.guideway - 1] = case.move(joints[case.guideway - 1], -case.small)  # where it was before the error
        loop = loop_of(joints, s, file.legs.length_mm)
        printed.append(loop.corrected_2_11() + case.small * case.printed(loop) - side_squared)
        correct.append(loop.corrected_2_11() + case.small * case.correct(loop) - side_squared)
    return np.array(printed), np.array(correct)


def loop_of(joints: list[Vector], s: Vector, leg_mm: float) -> Loop:
    """Return the thesis' variables of two ball joints: f and r from the sliders, the lean from the joint."""
    feet = [(s[0] + s[1]) / 2, 2 * M - (s[2] + s[3]) / 2]
    radii = [np.sqrt(leg_mm**2 - ((s[2 * i + 1] - s[2 * i]) / 2) ** 2) for i in range(2)]
    second = TO_GUIDEWAY_2.T @ joints[1]
    return Loop(
        feet[0], feet[1], radii[1], radii[0], np.arctan2(-joints[0][0], joints[0][2]), np.arctan2(second[0], second[2])
    )


# --- the transforms of turned guideways (3.20-3.35) -----------------------------------------------------------------


def about(point: Vector, first: Vector, second: Vector, u: Vector) -> Vector:
    """(O' - O) + second u with O' = first O, the thesis' form of a turn."""
    return first @ point - point + second @ u


@pytest.mark.parametrize(
    ("equation", "midpoint", "printed", "corrected"),
    [
        (
            "3.20", MIDPOINT_1,
            lambda u, e: about(-MIDPOINT_1, rot("z", e), rot("z", -e), u),
            lambda u, e: about(-MIDPOINT_1, rot("z", e), rot("z", e), u),
        ),
        (  # right in print
            "3.23", MIDPOINT_2,
            lambda u, e: about(-MIDPOINT_2, rot("z", -e), rot("z", -e), u),
            lambda u, e: about(-MIDPOINT_2, rot("z", -e), rot("z", -e), u),
        ),
        (
            "3.26", MIDPOINT_1,
            lambda u, e: about(-MIDPOINT_1, rot("x", e), rot("x", -e), u),
            lambda u, e: about(-MIDPOINT_1, rot("x", e), rot("x", e), u),
        ),
        (  # the translation is not turned to guideway 2, which shows in second order only
            "3.29", MIDPOINT_2,
            lambda u, e: about(-MIDPOINT_1, rot("x", -e), TO_GUIDEWAY_2 @ rot("x", -e) @ TO_GUIDEWAY_2.T, u),
            lambda u, e: TO_GUIDEWAY_2 @ about(-MIDPOINT_1, rot("x", -e), rot("x", -e), TO_GUIDEWAY_2.T @ u),
        ),
    ],
    ids=["3.20", "3.23", "3.26", "3.29"],
)  # fmt: skip
def test_transform_leaves_the_midpoint_where_it_is(
    equation: str, midpoint: Vector, printed: Move, corrected: Move, loops: list[Loop]
) -> None:
    error = 1e-3
    np.testing.assert_allclose(corrected(midpoint, error), midpoint, atol=1e-12)
    moved = float(np.linalg.norm(printed(midpoint, error) - midpoint))
    low, high = {"3.23": (0.0, 1e-12), "3.29": (0.1 * error**2 * M, error**2 * M)}.get(
        equation, (error * M, 3 * error * M)
    )
    assert low <= moved <= high
    index = ["3.20", "3.23", "3.26", "3.29"].index(equation)
    wanted = next(each for each in CASES if each.equation == ["3.21", "3.24", "3.27", "3.30"][index])
    for loop in loops[:10]:
        u = loop.u1 if wanted.guideway == 1 else loop.u2
        np.testing.assert_allclose(corrected(u, error), wanted.move(u, error), atol=1e-10)


@pytest.mark.parametrize("equation", ["3.20", "3.26"])
def test_printed_transform_keeps_no_point_of_the_guideway(equation: str) -> None:
    """To first order only the midpoint's mirror image across the vertex stays, which is not on the guideway."""
    axis, error = {"3.20": "z", "3.26": "x"}[equation], 1e-4
    guideway = np.linspace(0, -2 * M, 50)
    moves = [about(-MIDPOINT_1, rot(axis, error), rot(axis, -error), np.array([0, y, 0])) - [0, y, 0] for y in guideway]
    assert np.linalg.norm(moves, axis=1).min() > 0.9 * error * M
    mirror = -MIDPOINT_1
    stays = about(-MIDPOINT_1, rot(axis, error), rot(axis, -error), mirror) - mirror
    assert np.linalg.norm(stays) < 2 * error**2 * M


@pytest.mark.parametrize("equation", ["3.32", "3.35"])
def test_turn_about_the_base_centre_has_its_translation_reversed(equation: str, loops: list[Loop]) -> None:
    """(BR, sqrt(3) BR) is minus the base centre in this frame: O' - O holds the centre, O - O' as printed does not."""
    error, turned = 1e-3, rot("z", 1e-3)
    printed = -BASE_CENTRE - turned @ -BASE_CENTRE + turned @ BASE_CENTRE
    np.testing.assert_allclose(about(-BASE_CENTRE, turned, turned, BASE_CENTRE), BASE_CENTRE, atol=1e-12)
    assert np.linalg.norm(printed - BASE_CENTRE) > error * 2 * BR
    wanted = next(each for each in CASES if each.equation == {"3.32": "3.33", "3.35": "3.36"}[equation])
    for loop in loops[:10]:
        u = loop.u1 if wanted.guideway == 1 else loop.u2
        np.testing.assert_allclose(about(-BASE_CENTRE, turned, turned, u), wanted.move(u, error), atol=1e-10)
