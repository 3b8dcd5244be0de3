"""The design matrix of a hypothesis, by its entries: few in a row, so that sums over samples need no others."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.predictors.variable import FloatArray

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Design:
    """A matrix W with ``W[i, place[i, part]] = weight[i, part]``, the parts of one place added up.

    Attributes
    ----------
    place : ndarray of int32, shape (n, parts)
        Column of each entry.
    weight : ndarray, shape (n, parts)
        0 where there is no entry.
    columns : int
        Number of columns.
    """

    place: NDArray[np.int32]
    weight: FloatArray
    columns: int

    @classmethod
    def full(cls, matrix: FloatArray) -> Design:
        """Return the design with all entries of a matrix, shape (n, columns)."""
        return cls(np.tile(np.arange(matrix.shape[1], dtype=np.int32), (len(matrix), 1)), matrix, matrix.shape[1])

    def only(self, kept: Mask) -> Design:
        """Return the design with some of the columns, shape (columns,)."""
        number = np.where(kept, np.cumsum(kept) - 1, 0).astype(np.int32)
        return Design(number[self.place], np.where(kept[self.place], self.weight, 0.0), int(kept.sum()))

    def times(self, values: FloatArray) -> FloatArray:
        """Return W c, shape (n,), of values c, shape (columns,)."""
        product: FloatArray = np.sum(self.weight * values[self.place], axis=1)
        return product

    def cross(self, table: FloatArray, group: NDArray[np.integer], groups: int) -> FloatArray:
        """Return W'T over each group of rows, shape (groups, columns, k).

        Parameters
        ----------
        table : ndarray, shape (n, k)
        group : ndarray of int, shape (n,)
            Group of each row, from 0.
        groups : int
        """
        sums = _core.grouped_sums(self._grouped(group), self.weight, table, self.columns * groups)
        return sums.reshape(groups, self.columns, table.shape[1])

    def square(self, group: NDArray[np.integer], groups: int) -> FloatArray:
        """Return W'W over each group of rows, shape (groups, columns, columns)."""
        row = self._grouped(group)
        parts = range(self.place.shape[1])
        if len(parts) == 1:  # no row has two entries
            return self._diagonals(row[:, 0], self.weight[:, 0] ** 2, groups)
        total = np.zeros(groups * self.columns**2)
        for one, other in product(parts, repeat=2):
            at = row[:, one].astype(np.intp) * self.columns + self.place[:, other]
            total += np.bincount(at, self.weight[:, one] * self.weight[:, other], len(total))
        return total.reshape(groups, self.columns, self.columns)

    @property
    def squares(self) -> FloatArray:
        """Sum of squared entries of each column, shape (columns,)."""
        squares: FloatArray = self.square(np.zeros(len(self.place), np.int32), 1)[0].diagonal()
        return squares

    def _diagonals(self, row: NDArray[np.int32], square: FloatArray, groups: int) -> FloatArray:
        """Return diagonal matrices of the sums of squared entries by row of all groups."""
        sums = np.bincount(row, square, groups * self.columns).reshape(groups, self.columns)
        full = np.zeros((groups, self.columns, self.columns))
        full[:, range(self.columns), range(self.columns)] = sums
        return full

    def _grouped(self, group: NDArray[np.integer]) -> NDArray[np.int32]:
        return self.place + (group.astype(np.int32) * np.int32(self.columns))[:, None]
