"""The design matrix of a hypothesis, by its entries: few in a row, so that sums over samples need no others."""

from __future__ import annotations

from dataclasses import dataclass

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

    def sums(self, table: FloatArray, group: NDArray[np.integer], groups: int) -> tuple[FloatArray, FloatArray]:
        """Return W'W and W'T over each group of rows, shapes (groups, columns, columns) and (groups, columns, k).

        Parameters
        ----------
        table : ndarray, shape (n, k)
        group : ndarray of int, shape (n,)
            Group of each row, from 0; -1 for rows that belong to none.
        groups : int
        """
        found = _core.design_sums(self.place, self.weight, group.astype(np.int32), table, self.columns, groups)
        return (
            found.square.reshape(groups, self.columns, self.columns),
            found.cross.reshape(groups, self.columns, table.shape[1]),
        )
