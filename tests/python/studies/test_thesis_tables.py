"""Thesis Tables 5.1-5.8: what is identified and what is not, as the thesis states; and the reason, by harmonics."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.studies.thesis import GEOMETRIC_ERRORS, CircularTest, joint_plane_test, reference_contours
from hexdbb.studies.thesis.contours import without_harmonics
from hexdbb.studies.thesis.tables import (
    FIVE,
    LEGS,
    ROTATIONS,
    SEVEN,
    TABLES,
    TableResult,
    identified_additions,
    rank_of,
    table_5_8,
    table_results,
)

RESULTS = table_results()


@pytest.fixture(scope="module")
def in_plane() -> CircularTest:
    return joint_plane_test()


@pytest.mark.parametrize("result", RESULTS, ids=[table.number for table in TABLES])
def test_table_comes_out_as_the_thesis_says(result: TableResult) -> None:
    assert result.agrees.all() == result.table.thesis_says_identified
    assert (result.from_sum.rank == len(result.given)) == result.table.thesis_says_identified
    assert result.agrees.any(), "the thesis finds a part of the values only not to correspond"
    np.testing.assert_array_equal(result.agrees, result.from_sum.determined)


@pytest.mark.parametrize("result", RESULTS, ids=[table.number for table in TABLES])
def test_exact_contour_gives_determined_values_up_to_what_linearity_neglects(result: TableResult) -> None:
    sizes = np.array([each.unit_size for each in result.from_exact.unknowns])
    miss = np.abs(result.from_exact.values - result.given) / sizes
    assert miss[result.agrees].max() < 2e-3
    assert miss[result.agrees].max() > 1e-6
    assert (miss[~result.agrees] > 0.1).all()


@pytest.mark.parametrize("result", RESULTS, ids=[table.number for table in TABLES])
def test_finite_contours_hide_a_singular_matrix(result: TableResult) -> None:
    """With contours of 0.1 mm and 0.02 degrees the columns are never quite dependent: no warning is possible."""
    assert result.singular_ratio > 1e-9
    assert (result.singular_ratio > 1e-3) == result.table.thesis_says_identified


def test_which_additions_are_identified(in_plane: CircularTest) -> None:
    assert identified_additions(in_plane, FIVE, ("x1", "z1", "x2", "z2", "x3", "y3", "z3"), 1) == []
    assert identified_additions(in_plane, LEGS, ("leg2", "leg4", "leg6"), 1) == []
    vertical = {"xy1", "xy2", "centre1", "centre2"}
    assert {name for (name,) in identified_additions(in_plane, FIVE, ROTATIONS, 1)} == vertical
    pairs = identified_additions(in_plane, FIVE, ROTATIONS, 2)
    assert pairs == [("xy1", "xy2"), ("xy1", "centre2"), ("xy2", "centre1"), ("centre1", "centre2")]
    assert identified_additions(in_plane, FIVE, ROTATIONS, 3) == []
    others = [name for name in GEOMETRIC_ERRORS if name not in SEVEN]
    assert identified_additions(in_plane, SEVEN, others, 1) == []


def test_seven_are_two_of_harmonic_one_two_of_two_and_three_legs(in_plane: CircularTest) -> None:
    turns = [f"{kind}{i}" for kind in ("xy", "centre") for i in (1, 2, 3)]
    legs = [f"leg{k}" for k in range(1, 7)]
    others = [name for name in GEOMETRIC_ERRORS if name not in {*turns, *legs}]
    assert rank_of(in_plane, others) == 2
    assert rank_of(in_plane, [*others, *turns]) == 4
    assert rank_of(in_plane, GEOMETRIC_ERRORS) == 7
    for names, up_to, rank in ((turns, 1, 2), (legs, 2, 3)):
        left = without_harmonics(reference_contours(in_plane, names).first_order_mm, up_to)
        assert np.linalg.matrix_rank(left, tol=1e-7 * np.linalg.norm(left, 2)) == rank


def test_legs_of_a_pair_have_opposite_contours(in_plane: CircularTest) -> None:
    contours = reference_contours(in_plane, [f"leg{k}" for k in range(1, 7)]).first_order_mm
    np.testing.assert_allclose(contours[:, 0::2], -contours[:, 1::2], atol=1e-12)


def test_table_5_8_explains_the_contour_whether_or_not_its_values_are_true() -> None:
    alone, everything = table_5_8()
    for result in (alone, everything):
        assert 1e3 * result.estimate.rms_after_mm == pytest.approx(0.5, rel=0.1)
    sizes = np.array([each.unit_size for each in alone.estimate.unknowns])
    assert np.abs((alone.estimate.values - alone.given) / sizes).max() < 0.05
    assert np.abs((everything.estimate.values - everything.given) / sizes).max() > 0.5
