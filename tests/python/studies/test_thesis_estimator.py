"""The thesis' estimator: it identifies what it should, refuses what it cannot, and is limited to small errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.errors import InputError
from hexdbb.record import Record
from hexdbb.studies.thesis import (
    GEOMETRIC_ERRORS,
    UNKNOWNS,
    CircularTest,
    joint_plane_test,
    record_test,
    reference_contours,
    thesis_estimate,
    thesis_estimate_record,
)
from hexdbb.studies.thesis.circular_test import joint_plane_circle
from hexdbb.studies.thesis.linearity import SIZES_MM, linearity_study
from hexdbb.studies.thesis.simulated import simulated_record
from hexdbb.studies.thesis.tables import GIVEN, SEVEN, all_values

GIVEN_SEVEN = np.array([GIVEN[name] for name in SEVEN])


@pytest.fixture(scope="module")
def in_plane() -> CircularTest:
    return joint_plane_test()


@pytest.fixture(scope="module")
def record() -> Record:
    return simulated_record(*joint_plane_circle(), all_values(SEVEN, GIVEN_SEVEN), seed=7)


def test_normal_equations_agree_with_least_squares_by_qr(in_plane: CircularTest) -> None:
    """The same minimum as (5.5) written with A'A, found without it."""
    contour_mm = in_plane.contour_mm(all_values(SEVEN, GIVEN_SEVEN)) + 0.01 * np.cos(5 * in_plane.angle_rad)
    found = thesis_estimate(in_plane, contour_mm, SEVEN)
    matrix = reference_contours(in_plane, SEVEN).first_order_mm
    amounts, *_ = np.linalg.lstsq(matrix, contour_mm, rcond=None)
    sizes = [each.unit_size for each in found.unknowns]
    np.testing.assert_allclose(found.values, amounts * sizes, rtol=1e-8)
    assert found.rms_after_mm == pytest.approx(np.sqrt(np.mean((contour_mm - matrix @ amounts) ** 2)))
    assert (found.rank, found.dependent, found.determined.all()) == (7, (), True)
    singular = np.linalg.svd(matrix, compute_uv=False)
    assert found.condition == pytest.approx(singular[0] / singular[-1], rel=1e-6)


def test_singular_normal_equations_are_refused_by_name(in_plane: CircularTest) -> None:
    with pytest.raises(
        InputError, match=r"A'A of equation \(5.4\) is singular, rank 5 of 6: y3 = -1\.000 y1 - 1\.000 y2"
    ):
        thesis_estimate(in_plane, np.zeros(360), ["leg1", "leg3", "leg5", "y1", "y2", "y3"])
    with pytest.raises(InputError, match="rank 1 of 2: z3 has no contour"):
        thesis_estimate(in_plane, np.zeros(360), ["y1", "z3"])


def test_smallest_solution_of_all_thirty_three(in_plane: CircularTest) -> None:
    """It explains the contour as well as any, is the pseudo-inverse's, and does not claim to determine anything."""
    values = all_values(SEVEN, GIVEN_SEVEN)
    contour_mm = in_plane.first_order @ values
    found = thesis_estimate(in_plane, contour_mm, GEOMETRIC_ERRORS, minimum_norm=True)
    contours = reference_contours(in_plane)
    np.testing.assert_allclose(
        found.values, contours.sizes * (np.linalg.pinv(contours.first_order_mm, rcond=1e-7) @ contour_mm), atol=1e-9
    )
    assert found.rank == 7
    assert len(found.dependent) == 33 - 7
    assert not found.determined.any()
    assert found.rms_after_mm < 1e-12


def test_sentence_of_coincidence_is_true_of_the_contours(in_plane: CircularTest) -> None:
    sentences = thesis_estimate(in_plane, np.zeros(360), [*SEVEN, "centre1"], minimum_norm=True).dependent
    assert len(sentences) == 1
    left, _, right = sentences[0].partition(" = ")
    numbers = right.replace("- ", "-").replace("+ ", "").split()
    amounts, names = [float(each) for each in numbers[::2]], numbers[1::2]
    contours = reference_contours(in_plane, [left, *names]).first_order_mm
    np.testing.assert_allclose(contours[:, 0], contours[:, 1:] @ amounts, atol=1e-3 * np.abs(contours).max())


def test_record_gives_back_its_seven_errors(in_plane: CircularTest, record: Record) -> None:
    """Within four standard deviations of the error from the gauge's noise and rounding."""
    found = thesis_estimate_record(record, SEVEN)
    matrix = record_test(record).first_order[:, [UNKNOWNS[name].column for name in SEVEN]]
    noise_mm = np.hypot(0.5e-3, 0.1e-3 / np.sqrt(12.0))
    sigma = noise_mm * np.sqrt(np.diag(np.linalg.inv(matrix.T @ matrix)))
    np.testing.assert_array_less(np.abs(found.values - GIVEN_SEVEN), 4.0 * sigma)
    assert found.rms_after_mm == pytest.approx(noise_mm, rel=0.1)
    assert len(record) == 2 * in_plane.samples.size


def test_translations_are_not_identified_beside_the_cup(record: Record) -> None:
    with pytest.raises(InputError, match=r"rank 7 of 9: y1 = -0\.667 cup_y; y2 = 0\.577 cup_x \+ 0\.333 cup_y"):
        thesis_estimate_record(record, [*SEVEN, "cup_x", "cup_y"])


def test_wrong_contours_and_records_are_refused(in_plane: CircularTest, record: Record) -> None:
    with pytest.raises(InputError, match=r"contour of shape \(359,\) \(expected \(360,\), one per sample\)"):
        thesis_estimate(in_plane, np.zeros(359), ["leg1"])
    few = replace(record, columns={name: values[:3] for name, values in record.columns.items()})
    with pytest.raises(InputError, match=r"record: 3 samples for 7 errors \(expected at least as many\)"):
        thesis_estimate_record(few, SEVEN)
    none = replace(record, columns={name: values[:0] for name, values in record.columns.items()})
    with pytest.raises(InputError, match=r"record: no samples"):
        thesis_estimate_record(none, SEVEN)
    circle, mount = record.circles[0], record.mounts[0]
    circles = (circle, circle.model_copy(update={"id": 1, "mount": 1}))
    half = np.arange(len(record)) % 2
    two = replace(
        record,
        columns={**record.columns, "circle": half},
        circles=circles,
        mounts=(mount, mount.model_copy(update={"id": 1})),
    )
    with pytest.raises(InputError, match=r"samples of mounts 0, 1 \(expected one"):
        thesis_estimate_record(two, SEVEN)


def test_linearity_breaks_where_stated() -> None:
    """Small errors: both estimators alike. Large: the linear one is off by the square, the exact one is not."""
    study = linearity_study()
    small, large = study.rows[0], study.rows[-1]
    assert small.linear_rms_mm == pytest.approx(small.exact_rms_mm, rel=0.01)
    assert large.linear_rms_mm > 20 * large.exact_rms_mm
    assert large.linear_rms_mm == pytest.approx(study.curvature_per_mm * SIZES_MM[-1] ** 2, rel=0.05)
    for row in study.rows:
        assert row.exact_rms_mm == pytest.approx(study.noise_rms_mm, rel=0.25)
        if row.size_mm < study.break_mm / 2:
            assert row.linear_rms_mm < 1.1 * row.exact_rms_mm
        if row.size_mm > study.break_mm * 1.5:
            assert row.linear_rms_mm > 2.0 * row.exact_rms_mm
