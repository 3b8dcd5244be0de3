"""Reference contours: 33 of them, exact against first order, their harmonics, and the table they are written as."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest

from hexdbb.errors import InputError
from hexdbb.plan import load_plan
from hexdbb.studies.thesis import (
    GEOMETRIC_ERRORS,
    UNKNOWNS,
    CircularTest,
    harmonic_amplitudes,
    joint_plane_test,
    plan_test,
    reference_contours,
)
from hexdbb.studies.thesis.contours import COLUMNS, without_harmonics


@pytest.fixture(scope="module")
def in_plane() -> CircularTest:
    return joint_plane_test()


def test_there_are_thirty_three_with_names_of_their_own() -> None:
    assert len(GEOMETRIC_ERRORS) == 33
    assert [each.column for each in UNKNOWNS.values()] == list(range(40))


def test_the_nominal_machine_reads_nothing(in_plane: CircularTest) -> None:
    np.testing.assert_allclose(in_plane.nominal_mm, 0.0, atol=1e-11)
    np.testing.assert_allclose(in_plane.contour_mm(np.zeros(len(UNKNOWNS))), 0.0, atol=1e-15)


@pytest.mark.parametrize("name", GEOMETRIC_ERRORS)
def test_exact_contour_leaves_first_order_with_the_square(in_plane: CircularTest, name: str) -> None:
    """Half the error leaves a quarter of the difference: the derivative is the contour's, and no more is missing."""
    unknown = UNKNOWNS[name]
    values = np.zeros(len(UNKNOWNS))

    def left(size: float) -> float:
        values[unknown.column] = size
        return float(np.abs(in_plane.contour_mm(values) - size * in_plane.first_order[:, unknown.column]).max())

    whole, half = left(2.0 * unknown.unit_size), left(unknown.unit_size)
    assert 1e-7 < half < 1e-3
    assert whole / half == pytest.approx(4.0, rel=0.01)


def test_a_cup_off_in_x_reads_as_minus_the_cosine(in_plane: CircularTest) -> None:
    first_order = in_plane.first_order[:, UNKNOWNS["cup_x"].column]
    np.testing.assert_allclose(first_order, -np.cos(in_plane.angle_rad), atol=1e-9)


def test_harmonics_of_a_known_contour() -> None:
    angle = np.arange(90) / 90 * 2 * np.pi
    contour = (3.0 + 2.0 * np.cos(angle - 0.4) - 0.5 * np.sin(4 * angle))[:, None]
    np.testing.assert_allclose(harmonic_amplitudes(contour, 5)[:, 0], [3, 2, 0, 0, 0.5, 0], atol=1e-12)
    np.testing.assert_allclose(without_harmonics(contour, 1)[:, 0], -0.5 * np.sin(4 * angle), atol=1e-12)


@pytest.mark.parametrize(
    ("names", "present"),
    [
        (("leg1", "leg4", "leg6"), {1, 2, 3, 4}),
        (("y1", "y3", "slider2", "yz1", "side23"), {1}),
        (("xy1", "xy3", "centre2"), {1, 2}),
    ],
)
def test_harmonics_of_the_errors(in_plane: CircularTest, names: tuple[str, ...], present: set[int]) -> None:
    amplitudes = harmonic_amplitudes(reference_contours(in_plane, names).first_order_mm, 20)
    for column in amplitudes.T:
        assert set(np.flatnonzero(column > 0.02 * column.max())) == present
        if present != {1, 2, 3, 4}:
            assert np.delete(column, sorted(present)).max() < 1e-9 * column.max()


def test_table_has_every_error_at_every_angle(in_plane: CircularTest) -> None:
    contours = reference_contours(in_plane, ("leg1", "xy2"))
    rows = list(csv.DictReader(io.StringIO(contours.to_csv())))
    assert tuple(rows[0]) == COLUMNS
    assert len(rows) == 2 * 360
    assert {(row["error"], row["size"], row["unit"]) for row in rows} == {
        ("leg1", "100", "um"),
        ("xy2", "349.066", "urad"),
    }
    exact_um = np.array([float(row["exact_um"]) for row in rows]).reshape(2, 360).T
    np.testing.assert_allclose(exact_um, 1e3 * contours.exact_mm, atol=1e-6)


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["leg7"], r'error "leg7": not known \(expected one of: leg1, leg2'),
        (["leg1", "y1", "leg1"], r'error "leg1": named twice'),
        ([], "no error named"),
    ],
)
def test_wrong_names_are_refused(in_plane: CircularTest, names: list[str], message: str) -> None:
    with pytest.raises(InputError, match=message):
        reference_contours(in_plane, names)


def test_errors_too_large_for_a_pose_are_refused_by_sample(in_plane: CircularTest) -> None:
    values = np.zeros(len(UNKNOWNS))
    values[UNKNOWNS["leg1"].column] = -390.0
    with pytest.raises(InputError, match=r"ball in the joint plane: sample \d+: no pose with these errors \("):
        in_plane.contour_mm(values)


def test_a_circle_that_is_not_there_or_out_of_reach_is_refused() -> None:
    plan = load_plan("thesis")
    with pytest.raises(InputError, match=r"my plan: circle 7: not in the plan \(expected one of: 0\)"):
        plan_test(plan, 7, "my plan")
    mount = plan.mounts[0].model_copy(update={"cup_mm": (0.0, 0.0, 900.0)})
    with pytest.raises(InputError, match=r"my plan: circle 0: 0 deg: "):
        plan_test(plan.model_copy(update={"mounts": (mount,)}), 0, "my plan")
