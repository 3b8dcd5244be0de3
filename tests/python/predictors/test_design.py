"""Sums of a design by its entries, against the matrix itself."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.predictors.design import Design

ROWS, COLUMNS, GROUPS = 200, 7, 3


def drawn(parts: int) -> tuple[Design, np.ndarray, np.ndarray, np.ndarray]:
    """Return a design with missing entries, its matrix, a table and groups."""
    random = np.random.default_rng(5 + parts)
    place = random.integers(0, COLUMNS, (ROWS, parts)).astype(np.int32)
    weight = np.where(random.random((ROWS, parts)) < 0.2, 0.0, random.normal(size=(ROWS, parts)))
    matrix = np.zeros((ROWS, COLUMNS))
    for part in range(parts):
        np.add.at(matrix, (np.arange(ROWS), place[:, part]), weight[:, part])
    return Design(place, weight, COLUMNS), matrix, random.normal(size=(ROWS, 4)), random.integers(0, GROUPS, ROWS)


@pytest.mark.parametrize("parts", [1, 2, 3])
def test_sums_are_those_of_the_matrix(parts: int) -> None:
    design, matrix, table, group = drawn(parts)
    square, cross = design.sums(table, group, GROUPS)
    for each in range(GROUPS):
        own = matrix[group == each]
        np.testing.assert_allclose(square[each], own.T @ own, atol=1e-12)
        np.testing.assert_allclose(cross[each], own.T @ table[group == each], atol=1e-12)
    values = np.arange(1.0, COLUMNS + 1.0)
    np.testing.assert_allclose(design.times(values), matrix @ values, atol=1e-12)


def test_some_columns() -> None:
    design, matrix, table, group = drawn(2)
    kept = np.array([True, False, True, True, False, False, True])
    cross = design.only(kept).sums(table, group, GROUPS)[1].sum(axis=0)
    np.testing.assert_allclose(cross, matrix[:, kept].T @ table, atol=1e-12)


def test_all_entries_of_a_matrix() -> None:
    _, matrix, table, _ = drawn(1)
    none = np.zeros(ROWS, np.int32)
    square, cross = Design.full(matrix).sums(table, none, 1)
    np.testing.assert_allclose(cross[0], matrix.T @ table, atol=1e-12)
    np.testing.assert_allclose(square[0], matrix.T @ matrix, atol=1e-12)


def test_rows_of_no_group_do_not_count() -> None:
    design, matrix, table, group = drawn(2)
    counted = np.arange(ROWS) % 3 > 0
    square, cross = design.sums(table, np.where(counted, group, -1), GROUPS)
    for each in range(GROUPS):
        own = counted & (group == each)
        np.testing.assert_allclose(square[each], matrix[own].T @ matrix[own], atol=1e-12)
        np.testing.assert_allclose(cross[each], matrix[own].T @ table[own], atol=1e-12)


@pytest.mark.parametrize(
    ("columns", "groups", "rows"),
    [(COLUMNS - 1, GROUPS, ROWS), (COLUMNS, GROUPS - 1, ROWS), (COLUMNS, GROUPS, ROWS - 1)],
)
def test_places_and_groups_out_of_range_and_other_lengths_are_refused(columns: int, groups: int, rows: int) -> None:
    design, _, table, group = drawn(2)
    place, weight = design.place[:rows], design.weight[:rows]
    with pytest.raises(ValueError, match="expected"):
        _core.design_sums(place, weight, group.astype(np.int32), table, columns, groups)
