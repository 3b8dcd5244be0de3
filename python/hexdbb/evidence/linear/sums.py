"""Sums over cells of readings, from which every fit and every held-out prediction follows.

A cell is one circle, feed, direction and lap. For a signature W the sums W'W, W'J, W'y of every cell are taken once;
those of any training set are sums of cells. The model's own values are eliminated with their priors,

    A = W'W - W'J (J'J + I)^-1 J'W,   b = W'y - W'J (J'J + I)^-1 (J'y - standing).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.linear.readings import GROUPINGS, Linear, Readings

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
ByCell = Sequence[Floats] | Floats
"""Rows of every cell: of their own lengths, or padded to one, shape (cells, longest, k)."""


@dataclass(frozen=True, eq=False)
class Block:
    """Sums of one signature by cell: W'W (cells, k, k) and W'[J y] (cells, k, p + 1)."""

    own: Floats
    cross: Floats


@dataclass(frozen=True, eq=False)
class Projected:
    """A and b of a signature, and what is needed for the model's own values: L^-1 J'W and L^-1 (J'y - standing)."""

    information: Floats
    gradient: Floats
    cross: Floats


class Sums:
    """Sums over the cells of one linearisation.

    Parameters
    ----------
    linear : Linear
    readings : Readings
    groupings : tuple of str
        What tells cells apart; fewer take less time, none make one cell of all rows.
    """

    def __init__(self, linear: Linear, readings: Readings, groupings: tuple[str, ...] = GROUPINGS) -> None:
        self.linear, self.readings, self.groupings = linear, readings, groupings
        self._cells = readings.cells(groupings)
        self.keys = self._cells.keys
        whole = len(self.keys) == 1
        self.base: Floats = linear.normal[None] if whole else _of(self._table, self._table)
        """[J y]'[J y] by cell, (cells, p + 1, p + 1)."""
        self.rows = self._cells.counts.astype(np.float64)
        self._without: dict[bytes, Training] = {}
        self._bases: dict[bytes, Floats] = {}

    @cached_property
    def _table(self) -> ByCell:
        """[J y] by cell; the sums of all rows together follow from what the linearisation knows."""
        return self._of_cells(np.column_stack([self.linear.own, self.linear.residual]))

    def block(self, signature: Floats) -> Block:
        """Return the sums of a signature, shape (n, k)."""
        columns = self._of_cells(signature)
        return Block(_of(columns, columns), _of(columns, self._table))

    def cross(self, signature: Floats) -> Floats:
        """Return W'[J y] of a signature, shape (n, k), by cell: (cells, k, p + 1)."""
        return _of(self._of_cells(signature), self._table)

    def joined(self, blocks: list[Floats]) -> Block:
        """Return the sums of several signatures side by side."""
        return self.block(np.hstack(blocks))

    def groups(self, grouping: str) -> list[Ints]:
        """Return the cells of every group of a grouping."""
        numbers = self.keys[:, 1 + self.groupings.index(grouping)]
        return [np.flatnonzero(numbers == each) for each in np.unique(numbers)]

    def base_of(self, cells: Ints) -> Floats:
        """Return [J y]'[J y] of some cells together, shape (p + 1, p + 1), summed once."""
        key = cells.tobytes()
        if key not in self._bases:
            if 2 * len(cells) <= len(self.keys):
                self._bases[key] = np.asarray(self.base[cells].sum(axis=0))
            else:  # subtracting the few that are left out takes less time
                self._bases[key] = np.asarray(self._total - self.base_of(self._all_but(cells)))
        return self._bases[key]

    def _all_but(self, cells: Ints) -> Ints:
        return np.setdiff1d(np.arange(len(self.keys)), cells)

    @cached_property
    def _total(self) -> Floats:
        return np.asarray(self.base.sum(axis=0))

    @cached_property
    def whole(self) -> Training:
        """All cells."""
        return Training(self, np.arange(len(self.keys)))

    def without(self, cells: Ints) -> Training:
        """Return the training set that lacks some cells, made once."""
        key = cells.tobytes()
        if key not in self._without:
            self._without[key] = Training(self, self._all_but(cells))
        return self._without[key]

    def _of_cells(self, columns: Floats) -> ByCell:
        """Return the rows of every cell: as they are where they stand together, else padded to one length."""
        cells = self._cells
        if cells.slices is not None:
            return [columns[rows] for rows in cells.slices]
        padded = np.zeros((cells.shape[0] * cells.shape[1], columns.shape[1]))
        padded[cells.at] = columns[cells.order]
        return padded.reshape(*cells.shape, columns.shape[1])


def _of(one: ByCell, other: ByCell) -> Floats:
    """Return the products of two tables by cell, shape (cells, k, m)."""
    if isinstance(one, np.ndarray):
        padded: Floats = np.matmul(one.transpose(0, 2, 1), other)
        return padded
    found = np.empty((len(one), one[0].shape[1], other[0].shape[1]))
    for first, second, product in zip(one, other, found, strict=True):
        np.matmul(first.T, second, out=product)
    return found


class Training:
    """Cells that are fitted, with the model's own values eliminated.

    Parameters
    ----------
    sums : Sums
    cells : ndarray of int
    """

    def __init__(self, sums: Sums, cells: Ints) -> None:
        self.cells = cells
        total = sums.base_of(cells)
        self.squared = float(total[-1, -1])
        self.rows = float(sums.rows[cells].sum())
        factor = np.linalg.cholesky(total[:-1, :-1] + np.eye(len(total) - 1))
        self._inverse: Floats = np.linalg.inv(factor).astype(np.float64)
        """L^-1: every signature is multiplied by it."""
        self.own = self._half(total[:-1, -1] - sums.linear.standing)
        """L^-1 (J'y - standing)."""

    def project(self, block: Block) -> Projected:
        """Eliminate the model's own values from a signature's sums."""
        cross = block.cross[self.cells].sum(axis=0)
        half = self._half(cross[:, :-1].T)
        return Projected(
            information=block.own[self.cells].sum(axis=0) - half.T @ half,
            gradient=cross[:, -1] - half.T @ self.own,
            cross=half,
        )

    def imitated(self, cross: Floats) -> tuple[Floats, Floats]:
        """Return what of W'W the model's own values imitate, and b, from W'[J y] of all cells, shape (k, p + 1)."""
        half = self._half(cross[:, :-1].T)
        return half.T @ half, cross[:, -1] - half.T @ self.own

    def own_values(self, projected: Projected | None = None, coefficients: Floats | None = None) -> Floats:
        """Return the change of the model's own values that goes with a signature's coefficients."""
        right = self.own
        if projected is not None and coefficients is not None:
            right = right - projected.cross @ coefficients
        found: Floats = self._inverse.T @ right
        return found

    def own_values_without(self, sums: Sums, columns: Ints) -> Floats:
        """Return the change of the model's own values, fitted anew where those of some columns are zero."""
        total = sums.base_of(self.cells)
        found: Floats = -sums.linear.standing
        others = np.setdiff1d(np.arange(len(found)), columns)
        square = total[np.ix_(others, others)] + np.eye(len(others))
        right = total[others, -1] - sums.linear.standing[others] - total[np.ix_(others, columns)] @ found[columns]
        found[others] = np.linalg.solve(square, right)
        return found

    def expected_error(self, sums: Sums, cells: Ints) -> float:
        """Return the sum of squared errors that the fit to this set expects of itself on other cells."""
        base = sums.base_of(cells)[:-1, :-1]
        return float(sums.rows[cells].sum() + np.sum(self._inverse * self._half(base)))

    def contradiction(self, sums: Sums, cells: Ints) -> tuple[float, float]:
        """Return how far the values that other cells ask for are from those of this set, and how many they determine.

        Returns
        -------
        squared : float
            Squared error of the prediction, in the metric of its own uncertainty: what a fit to both leaves of these
            cells, and the squared distance of the values, in standard deviations.
        determined : float
            Effective number of values.
        """
        base, own = sums.base_of(cells), self.own_values()
        spread = self._half(self._half(base[:-1, :-1]).T)
        both = spread + np.eye(len(own))
        gradient = self._half(base[:-1, -1] - base[:-1, :-1] @ own)
        squared = squared_error(sums, cells, own, None, None) - gradient @ np.linalg.solve(both, gradient)
        return float(squared), float(np.trace(np.linalg.solve(both, spread)))

    def without_own(self, linear: Linear) -> tuple[Floats, Floats]:
        """Return J L^-T and y less what the model's own values explain: A = W'W - H'H and b = W'y' with H' = W'J L^-T.

        For many signatures of the same rows, whose products with these are taken in one.
        """
        own = linear.own @ self._inverse.T
        return own, linear.residual - own @ self.own

    def _half(self, columns: Floats) -> Floats:
        found: Floats = self._inverse @ columns
        return found


def squared_error(sums: Sums, cells: Ints, own: Floats, block: Block | None, coefficients: Floats | None) -> float:
    """Return the sum of squared prediction errors over cells, in noise variances."""
    base = sums.base_of(cells)
    error = float(base[-1, -1] - 2.0 * own @ base[:-1, -1] + own @ base[:-1, :-1] @ own)
    if block is None or coefficients is None:
        return error
    cross = block.cross[cells].sum(axis=0)
    inner = block.own[cells].sum(axis=0)
    error += float(coefficients @ inner @ coefficients - 2.0 * coefficients @ (cross[:, -1] - cross[:, :-1] @ own))
    return error
