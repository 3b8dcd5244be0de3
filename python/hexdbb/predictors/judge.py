"""The share of a residual that a hypothesis carries, judged on samples that it was not fitted to.

A hypothesis is a sparse design matrix W: the residual is W c. What the model's own free values could imitate must not
count for or against it: with J their derivatives (divided by expected sizes), c and their shifts d are fitted together,

    min |r - W c - J d|^2 / noise^2 + |v + d|^2 + |c|^2 / size^2,

v where these values stand (for half of the samples with half the weight), to one half of the samples, and W c + J d
predicts the other half, and the other way round. The part of the mean square that goes there is the share. Noise
predicts nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from hexdbb.predictors.columns import Columns, FloatArray, halves, stretches
from hexdbb.predictors.pushes import Pushes

SIZE_MM = 0.03
"""A push larger than a few times this is not expected; keeps what the readings cannot tell at zero."""
LEAST_PART = 1e-9
"""The same where no noise is given: of the largest diagonal element."""

FITTED = 0.1
"""A residual of which the model's own values could mend more than this part is not that of a fit."""

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Expected:
    """What is expected of the model's own values: the weight of it, and where they stand, in expected sizes."""

    weight: float
    standing: FloatArray

    def information(self, own_square: FloatArray) -> FloatArray:
        """Add it to the values' information."""
        added: FloatArray = own_square + self.weight * np.eye(len(own_square))
        return added

    def gradient(self, own_gradient: FloatArray) -> FloatArray:
        """Add its pull back to zero."""
        pulled: FloatArray = own_gradient - self.weight * self.standing
        return pulled


@dataclass(frozen=True)
class Half:
    """Some of the samples, and what the model's own values do there; in units of the noise."""

    rows: Mask
    jacobian: FloatArray
    residual: FloatArray
    information: FloatArray
    gradient: FloatArray
    expected: Expected

    def moments(self, design: sparse.csr_matrix, noise_mm: float) -> Moments:
        """Sum a hypothesis over these samples."""
        own = design[self.rows] / noise_mm
        turned = own.T.tocsr()
        return Moments(
            (turned @ own).toarray(),
            np.asarray(turned @ self.jacobian),
            turned @ self.residual,
            self.information,
            self.gradient,
            self.expected,
        )


@dataclass(frozen=True)
class Moments:
    """Sums over some samples: W'W, W'J, W'r, J'J, J'r; all that a fit and its judgement need of them."""

    square: FloatArray
    cross: FloatArray
    gradient: FloatArray
    own_square: FloatArray
    own_gradient: FloatArray
    expected: Expected

    def __add__(self, other: Moments) -> Moments:
        return Moments(
            self.square + other.square,
            self.cross + other.cross,
            self.gradient + other.gradient,
            self.own_square + other.own_square,
            self.own_gradient + other.own_gradient,
            Expected(self.expected.weight + other.expected.weight, self.expected.standing),
        )

    def fitted(self, ridge: float) -> tuple[FloatArray, FloatArray]:
        """Give the values c of the hypothesis and the shifts d of the model's own."""
        damping = max(ridge, LEAST_PART * float(self.square.diagonal().max(initial=1.0)))
        inverse: FloatArray = np.linalg.inv(self.expected.information(self.own_square)).astype(np.float64)
        own_gradient = self.expected.gradient(self.own_gradient)
        eased: FloatArray = inverse @ self.cross.T
        values: FloatArray = np.linalg.solve(
            self.square + damping * np.eye(len(self.square)) - self.cross @ eased,
            self.gradient - eased.T @ own_gradient,
        ).astype(np.float64)
        return values, inverse @ (own_gradient - self.cross.T @ values)

    def gained(self, values: FloatArray, shifts: FloatArray) -> float:
        """Fall of the sum of squares when W c + J d is taken from these residuals."""
        along = values @ self.gradient + shifts @ self.own_gradient
        predicted = values @ self.square @ values + 2.0 * (values @ self.cross @ shifts)
        return float(2.0 * along - predicted - shifts @ self.own_square @ shifts)


class Judge:
    """Judges hypotheses on one residual.

    Parameters
    ----------
    columns : dict of str to (n,) arrays
        As `sample_columns` gives them.
    pushes : Pushes, optional
        Has what the model's own values do. That is left aside without a noise, and where the residual is not that of a
        fit, so that much of it could be mended by them alone.
    noise_mm : float
        Of one reading; 0 where it is not known.
    beyond_noise : bool
        Whether the residual is that of a fit, of which shares are of what is beyond the noise; else they are of the
        whole mean square.
    """

    def __init__(
        self,
        columns: Columns,
        pushes: Pushes | None = None,
        noise_mm: float = 0.0,
        *,
        beyond_noise: bool = False,
    ) -> None:
        self.residual_mm: FloatArray = columns["residual_um"] * 1e-3
        count = len(self.residual_mm)
        self._noise_mm = noise_mm if noise_mm > 0.0 else 1.0
        self._ridge = (1.0 / SIZE_MM) ** 2 if noise_mm > 0.0 else 0.0
        self.whole = float(np.mean(self.residual_mm**2)) - (noise_mm**2 if beyond_noise else 0.0)
        self._nuisance, self._standing = np.zeros((count, 0)), np.zeros(0)
        if pushes is not None and noise_mm > 0.0:
            self._nuisance, self._standing = pushes.own, pushes.standing
        if not (beyond_noise or self._is_fitted()):
            self._nuisance, self._standing = np.zeros((count, 0)), np.zeros(0)
        self.second = {False: halves(columns), True: stretches(count)}
        """Samples of the second half, for what depends on place and for what depends on time."""
        self._halves = {is_time: self._both(second) for is_time, second in self.second.items()}
        self._whole = self._half(np.ones(count, bool))
        self._inverse = np.linalg.inv(self._whole.expected.information(self._whole.information))

    def share(self, design: sparse.csr_matrix, is_time: bool) -> float:
        """Give the share a hypothesis carries, at most 1; negative where it predicts wrongly.

        Parameters
        ----------
        design : sparse matrix, shape (n, values)
        is_time : bool
            Whether it depends on time, so that neighbouring stretches are held against one another and not laps.
        """
        return self.weighed(design, is_time)[0]

    def weighed(self, design: sparse.csr_matrix, is_time: bool) -> tuple[float, FloatArray]:
        """Give the share, and the values c fitted to all samples, in mm."""
        first, second = (half.moments(design, self._noise_mm) for half in self._halves[is_time])
        values_mm = (first + second).fitted(self._ridge)[0]
        if self.whole <= 0.0:
            return 0.0, values_mm
        gained = first.gained(*second.fitted(self._ridge)) + second.gained(*first.fitted(self._ridge))
        return min(gained * self._noise_mm**2 / len(self.residual_mm) / self.whole, 1.0), values_mm

    def fit(self, design: sparse.csr_matrix) -> FloatArray:
        """Give the values c of a hypothesis, in mm."""
        return self._whole.moments(design, self._noise_mm).fitted(self._ridge)[0]

    def step_gains(self, weights: FloatArray, cells: NDArray[np.intp], count: int) -> FloatArray:
        """Fall of the sum of squares that a push from each cell on explains; entry k begins with cell k.

        Parameters
        ----------
        weights : ndarray, shape (n, m)
            Derivatives of the readings at the push's components.
        cells : ndarray of int, shape (n,)
            Cell of each sample in order of time, -1 where it has none.
        count : int
            Number of cells.
        """
        on, scale = self._whole, 1.0 / self._noise_mm
        m = weights.shape[1]
        square, cross = np.zeros((count, m, m)), np.zeros((count, m, on.jacobian.shape[1]))
        gradient = np.zeros((count, m))
        order = np.argsort(cells, kind="stable")
        edges = np.searchsorted(cells[order], np.arange(count + 1))
        for cell in range(count):
            rows = order[edges[cell] : edges[cell + 1]]
            own = weights[rows] * scale
            square[cell], cross[cell] = own.T @ own, own.T @ on.jacobian[rows]
            gradient[cell] = own.T @ on.residual[rows]
        square, cross, gradient = (np.cumsum(each[::-1], axis=0)[::-1] for each in (square, cross, gradient))
        projected = square - cross @ self._inverse @ cross.transpose(0, 2, 1)
        ridge = np.maximum(self._ridge, LEAST_PART * square.max(axis=(1, 2), initial=1.0))
        left = gradient - cross @ (self._inverse @ on.expected.gradient(on.gradient))
        solved = np.linalg.solve(projected + ridge[:, None, None] * np.eye(m), left[..., None])[..., 0]
        gains: FloatArray = np.einsum("ij,ij->i", left, solved)
        return gains

    def _is_fitted(self) -> bool:
        on = self._half(np.ones(len(self.residual_mm), bool))
        pulled = on.expected.gradient(on.gradient)
        steps = np.linalg.solve(on.expected.information(on.information), pulled)
        return float(pulled @ steps) < FITTED * float(on.residual @ on.residual)

    def _both(self, second: Mask) -> tuple[Half, Half]:
        return self._half(~second), self._half(second)

    def _half(self, rows: Mask) -> Half:
        jacobian = self._nuisance[rows] / self._noise_mm
        residual = self.residual_mm[rows] / self._noise_mm
        expected = Expected(float(rows.mean()), self._standing)
        return Half(rows, jacobian, residual, jacobian.T @ jacobian, jacobian.T @ residual, expected)
