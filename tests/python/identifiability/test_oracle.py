"""Oracle numbers: what circular tests can tell of the 33 geometric errors, computed independently of the engine.

First-order rank and condition of the ball-bar Jacobian for the assumed SP-120, rotations scaled by 1/300 mm; and
the thesis' Tables 5.1-5.7: which sets of errors one level circle identifies (ball in the joint plane, guideway 3 as
reference).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations, product

import numpy as np
import pytest
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.kinematics import engine_machine, inverse
from hexdbb.machine import shipped_machine

Floats = NDArray[np.float64]
LEVER_MM = 300.0
RADIUS_MM = 100.0
TILT, YAW, PLANE_TILT = np.deg2rad([12.0, 15.0, 8.0])

MACHINE = engine_machine(shipped_machine())
EFFECTS = [*_core.effect_names("geometry"), *_core.effect_names("set-up")]
INFOS = [_core.effect_info(MACHINE, 1, name) for name in EFFECTS]
GEOMETRIC = [info.name for info in INFOS if not info.is_set_up]


@dataclass(frozen=True)
class Circle:
    platform_rpy_rad: tuple[float, float, float] = (0.0, 0.0, 0.0)
    plane_rpy_rad: tuple[float, float, float] = (0.0, 0.0, 0.0)


LEVEL = [Circle()]
SEVEN = [
    Circle(),
    *(Circle((roll, pitch, yaw)) for roll, pitch, yaw in [(TILT, 0, 0), (-TILT, 0, 0), (0, TILT, 0), (0, -TILT, 0)]),
    *(Circle((0, 0, yaw)) for yaw in (YAW, -YAW)),
]
NINE = [*SEVEN, Circle(plane_rpy_rad=(PLANE_TILT, 0, 0)), Circle(plane_rpy_rad=(0, PLANE_TILT, 0))]


@dataclass(frozen=True)
class Test:
    """Circles about one cup, with the nominal ball offset."""

    __test__ = False
    circles: list[Circle]
    cup_z_mm: float
    ball_z_mm: float
    unknown: tuple[str, ...] = field(default=())


IN_PLANE = (300.0, 20.0)  # ball in the joint plane
ABOVE = (340.0, 60.0)  # ball 40 mm above it


def columns_of(effect: str) -> slice:
    first = sum(info.size for info in INFOS[: EFFECTS.index(effect)])
    return slice(first, first + INFOS[EFFECTS.index(effect)].size)


def jacobian(test: Test) -> Floats:
    """Derivatives of the readings with respect to every value the engine knows, mm per mm, 360 samples a circle."""
    angle = np.arange(360) / 360 * 2 * np.pi
    path = np.column_stack([RADIUS_MM * np.cos(angle), RADIUS_MM * np.sin(angle), np.zeros(360)])
    cup, ball = np.array([0, 0, test.cup_z_mm]), np.array([0, 0, test.ball_z_mm])
    sliders = []
    for circle in test.circles:
        plane, platform = (_core.rotation_from_rpy(*rpy) for rpy in (circle.plane_rpy_rad, circle.platform_rpy_rad))
        found, status = inverse(shipped_machine(), cup + path @ plane.T - platform @ ball, circle.platform_rpy_rad)
        assert not status.any()
        sliders.append(found)
    table = np.vstack(sliders)
    rows = np.zeros(len(table), dtype=np.int32)
    set_up = _core.SetUp(cup_mm=cup, ball_offset_mm=ball, bar_length_mm=RADIUS_MM)
    model = _core.Model(MACHINE)
    for name in EFFECTS:
        model.add(name, 1)
    predicted = _core.predict(model, _core.Samples(sliders_mm=table, set_up=rows, mount=rows, set_ups=[set_up]), True)
    assert predicted.first_failure == -1
    np.testing.assert_allclose(predicted.reading_mm, 0.0, atol=1e-11)
    units = [info.parameters[k % len(info.parameters)].unit for info in INFOS for k in range(info.size)]
    return np.asarray(predicted.jacobian * np.where(np.array(units) == "rad", 1 / LEVER_MM, 1.0))


def singular_values(test: Test) -> Floats:
    """Of the 33 geometric columns, the unknown set-up projected out by plain least squares."""
    whole = jacobian(test)
    geometric = whole[:, :33]
    if test.unknown:
        nuisance = np.hstack([whole[:, columns_of(effect)] for effect in test.unknown])
        geometric = geometric - nuisance @ np.linalg.lstsq(nuisance, geometric, rcond=None)[0]
    return np.asarray(np.linalg.svd(geometric, compute_uv=False))


ORACLE = [
    (Test(LEVEL, *IN_PLANE), 7, 106.0),
    (Test(LEVEL, *IN_PLANE, ("cup_position",)), 5, 13.0),
    (Test(LEVEL, *ABOVE), 11, 2832.0),
    (Test(LEVEL, *ABOVE, ("cup_position",)), 9, 464.0),
    (Test(SEVEN, *ABOVE, ("cup_position",)), 21, 438.0),
    (Test(SEVEN, *ABOVE), 23, 2476.0),
    (Test(SEVEN, *ABOVE, ("cup_position", "ball_offset")), 21, 506.0),
    (Test(SEVEN, *ABOVE, ("cup_position", "ball_offset", "bar_length")), 21, 512.0),
    (Test(NINE, *ABOVE, ("cup_position",)), 21, 341.0),
    (Test(NINE, *ABOVE), 24, None),
]
oracle = pytest.mark.parametrize(
    ("test", "rank", "condition"),
    ORACLE,
    ids=[
        f"{len(t.circles)} circles, ball {t.ball_z_mm:.0f}, unknown {' '.join(t.unknown) or '-'}" for t, _, _ in ORACLE
    ],
)


@oracle
def test_rank_and_condition(test: Test, rank: int, condition: float | None) -> None:
    values = singular_values(test)
    assert np.sum(values > 1e-9 * values[0]) == rank
    assert values[rank] < 1e-12 * values[0]  # a gap, not a matter of the threshold
    if condition is not None:
        assert values[0] / values[rank - 1] == pytest.approx(condition, rel=0.005 if condition > 50 else 0.02)


@oracle
def test_engine_counts_the_same(test: Test, rank: int, condition: float | None) -> None:
    whole = jacobian(test)
    rest = whole[:, :33]
    if test.unknown:
        rest = _core.project_out(rest, np.hstack([whole[:, columns_of(effect)] for effect in test.unknown]))
    found = _core.identifiability(rest, relative=1e-8)
    assert found.rank == rank
    if condition is not None:
        assert found.condition == pytest.approx(condition, rel=0.005 if condition > 50 else 0.02)


def test_the_thesis_numbers_thirty_three_errors() -> None:
    assert sum(info.size for info in INFOS if not info.is_set_up) == 33
    assert [info.name for info in INFOS[: len(GEOMETRIC)]] == GEOMETRIC


# --- thesis Tables 5.1-5.7 ------------------------------------------------------------------------------------------

LEGS = {f"leg {k + 1}": columns_of("leg_length").start + k for k in range(6)}
TRANSLATIONS = {
    f"{axis}{i + 1}": columns_of("guideway_translation").start + 3 * i + "xyz".index(axis)
    for i in range(3)
    for axis in "xyz"
}
ROTATIONS = {
    f"{kind}{i + 1}": columns_of(f"guideway_rotation_{kind}").start + i
    for kind in ("xy", "yz", "centre")
    for i in range(3)
}
COLUMN = {**LEGS, **TRANSLATIONS, **ROTATIONS}
FIVE = ["leg 1", "leg 3", "leg 5", "y1", "y2"]


@pytest.fixture(scope="module")
def thesis_jacobian() -> Floats:
    return jacobian(Test(LEVEL, *IN_PLANE))


def is_identified(whole: Floats, names: list[str]) -> bool:
    chosen = whole[:, [COLUMN[name] for name in names]]
    return int(np.linalg.matrix_rank(chosen, tol=1e-9 * np.linalg.norm(chosen, 2))) == len(names)


@pytest.mark.parametrize(
    ("table", "names", "identified"),
    [
        ("5.1", FIVE, True),
        ("5.2", [*FIVE, "y3"], False),
        ("5.3", ["leg 1", "leg 3", "leg 5", "leg 2"], False),
        ("5.4", [*FIVE, "xy1"], True),
        ("5.4", [*FIVE, "xy2"], True),
        ("5.5", [*FIVE, "xy1", "xy2"], True),
        ("5.6", [*FIVE, "xy1", "xy2", "xy3"], False),
        ("5.6", [*FIVE, "xy1", "xy2", "yz1"], False),
        ("5.6", [*FIVE, "xy1", "xy2", "centre1"], False),
        ("5.7", [*FIVE, "xy1", "xy2", "yz1", "yz2"], False),
    ],
)
def test_thesis_tables(thesis_jacobian: Floats, table: str, names: list[str], identified: bool) -> None:
    assert is_identified(thesis_jacobian, names) == identified, f"Table {table}"


def test_any_leg_of_a_pair_serves(thesis_jacobian: Floats) -> None:
    """Four legs are one too many whichever they are; three serve where no two belong to one pair."""
    for legs in product(("leg 1", "leg 2"), ("leg 3", "leg 4"), ("leg 5", "leg 6")):
        assert is_identified(thesis_jacobian, [*legs, "y1", "y2"])
    for legs in combinations(LEGS, 4):
        assert not is_identified(thesis_jacobian, list(legs))


def test_one_level_circle_cannot_see_vertical_and_outward_shifts(thesis_jacobian: Floats) -> None:
    """They move the platform only vertically or tilt it, which a ball in the joint plane does not show."""
    seen = {name: float(np.linalg.norm(thesis_jacobian[:, COLUMN[name]])) for name in TRANSLATIONS}
    for i in (1, 2, 3):
        assert seen[f"x{i}"] < 1e-9 * seen[f"y{i}"]
        assert seen[f"z{i}"] < 1e-9 * seen[f"y{i}"]
