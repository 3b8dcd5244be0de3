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
    square, cross = design.square(group, GROUPS), design.cross(table, group, GROUPS)
    for each in range(GROUPS):
        own = matrix[group == each]
        np.testing.assert_allclose(square[each], own.T @ own, atol=1e-12)
        np.testing.assert_allclose(cross[each], own.T @ table[group == each], atol=1e-12)
    np.testing.assert_allclose(design.squares, np.sum(matrix**2, axis=0), atol=1e-12)
    values = np.arange(1.0, COLUMNS + 1.0)
    np.testing.assert_allclose(design.times(values), matrix @ values, atol=1e-12)


def test_some_columns() -> None:
    design, matrix, table, group = drawn(2)
    kept = np.array([True, False, True, True, False, False, True])
    cross = design.only(kept).cross(table, group, GROUPS).sum(axis=0)
    np.testing.assert_allclose(cross, matrix[:, kept].T @ table, atol=1e-12)


def test_all_entries_of_a_matrix() -> None:
    _, matrix, table, _ = drawn(1)
    none = np.zeros(ROWS, np.int32)
    np.testing.assert_allclose(Design.full(matrix).cross(table, none, 1)[0], matrix.T @ table, atol=1e-12)
    np.testing.assert_allclose(Design.full(matrix).square(none, 1)[0], matrix.T @ matrix, atol=1e-12)


@pytest.mark.parametrize(("groups", "rows"), [(3, ROWS), (COLUMNS, ROWS - 1)])
def test_groups_out_of_range_and_other_lengths_are_refused(groups: int, rows: int) -> None:
    design, _, table, _ = drawn(1)
    with pytest.raises(ValueError, match="expected"):
        _core.grouped_sums(design.place[:rows], design.weight[:rows], table, groups)
