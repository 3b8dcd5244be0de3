"""Explained share of a residual, cross-validated: the part of it that a hypothesis predicts where it was not fitted.

A hypothesis is a sparse design matrix W: the residual is W c. What the model's own free values could imitate must not
count for or against it: with J their derivatives (times their prior standard deviations), c and their shifts d are
fitted together,

    min |r - W c - J d|^2 / noise^2 + |v + d|^2 + |c|^2 / size^2,

v the present values (for half of the samples with half the weight), to one half of the samples, and W c + J d predicts
the other half, and the other way round. The fall of the mean square there is the explained share. Noise predicts
nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from hexdbb.predictors.halves import halves, stretches
from hexdbb.predictors.pushes import Pushes
from hexdbb.predictors.variable import FloatArray
from hexdbb.samples import Samples

SIZE_MM = 0.03
"""Prior standard deviation of a push: 30 µm, above what this residual shows once geometry is fitted. It keeps values
that the readings do not determine at zero."""
LEAST_PART = 1e-9
"""Damping where no noise is given, as part of the largest diagonal element: above rounding, below any information."""
FITTED = 0.1
"""Part of a residual that the model's own values may still remove where the residual is taken for that of a fit: a fit
leaves none of it, an unfitted model of geometry nearly all."""

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Prior:
    """Prior of the model's own values: its weight, and the present values, in prior standard deviations."""

    weight: float
    standing: FloatArray

    def information(self, own_square: FloatArray) -> FloatArray:
        """Return the values' information with the prior's added."""
        added: FloatArray = own_square + self.weight * np.eye(len(own_square))
        return added

    def gradient(self, own_gradient: FloatArray) -> FloatArray:
        """Return the values' gradient with the prior's added."""
        pulled: FloatArray = own_gradient - self.weight * self.standing
        return pulled


@dataclass(frozen=True)
class Half:
    """Some of the samples with the residual and the model's derivatives there, in units of the noise."""

    rows: Mask
    jacobian: FloatArray
    residual: FloatArray
    information: FloatArray
    gradient: FloatArray
    prior: Prior

    def moments(self, design: sparse.csr_matrix, noise_mm: float) -> Moments:
        """Return a hypothesis' sums over these samples."""
        own = design[self.rows] / noise_mm
        turned = own.T.tocsr()
        return Moments(
            (turned @ own).toarray(),
            np.asarray(turned @ self.jacobian),
            turned @ self.residual,
            self.information,
            self.gradient,
            self.prior,
        )


@dataclass(frozen=True)
class Moments:
    """Sums over some samples: W'W, W'J, W'r, J'J, J'r; a fit and its test need no more of them."""

    square: FloatArray
    cross: FloatArray
    gradient: FloatArray
    own_square: FloatArray
    own_gradient: FloatArray
    prior: Prior

    def __add__(self, other: Moments) -> Moments:
        return Moments(
            self.square + other.square,
            self.cross + other.cross,
            self.gradient + other.gradient,
            self.own_square + other.own_square,
            self.own_gradient + other.own_gradient,
            Prior(self.prior.weight + other.prior.weight, self.prior.standing),
        )

    def fitted(self, ridge: float) -> tuple[FloatArray, FloatArray]:
        """Fit the values c of the hypothesis and the shifts d of the model's own."""
        damping = max(ridge, LEAST_PART * float(self.square.diagonal().max(initial=1.0)))
        inverse: FloatArray = np.linalg.inv(self.prior.information(self.own_square)).astype(np.float64)
        own_gradient = self.prior.gradient(self.own_gradient)
        eased: FloatArray = inverse @ self.cross.T
        values: FloatArray = np.linalg.solve(
            self.square + damping * np.eye(len(self.square)) - self.cross @ eased,
            self.gradient - eased.T @ own_gradient,
        ).astype(np.float64)
        return values, inverse @ (own_gradient - self.cross.T @ values)

    def gained(self, values: FloatArray, shifts: FloatArray) -> float:
        """Return the fall of the sum of squares when W c + J d is subtracted from these residuals."""
        along = values @ self.gradient + shifts @ self.own_gradient
        predicted = values @ self.square @ values + 2.0 * (values @ self.cross @ shifts)
        return float(2.0 * along - predicted - shifts @ self.own_square @ shifts)


class CrossValidation:
    """Tests hypotheses on one residual.

    Parameters
    ----------
    samples : Samples
    residual_mm : ndarray, shape (n,)
        Measured minus predicted reading of each sample.
    pushes : Pushes, optional
        Has the derivatives with respect to the model's own values. They are left aside without a noise, and where the
        residual is not that of a fit, so that the values alone could remove much of it.
    noise_mm : float
        Standard deviation of one reading; 0 where it is not known.
    beyond_noise : bool
        Whether the residual is that of a fit; shares are then of what exceeds the noise, else of the whole mean square.
    """

    def __init__(
        self,
        samples: Samples,
        residual_mm: FloatArray,
        pushes: Pushes | None = None,
        noise_mm: float = 0.0,
        *,
        beyond_noise: bool = False,
    ) -> None:
        self.residual_mm = residual_mm
        count = len(residual_mm)
        self._noise_mm = noise_mm if noise_mm > 0.0 else 1.0
        self._ridge = (1.0 / SIZE_MM) ** 2 if noise_mm > 0.0 else 0.0
        self.whole = float(np.mean(self.residual_mm**2)) - (noise_mm**2 if beyond_noise else 0.0)
        self._nuisance, self._standing = np.zeros((count, 0)), np.zeros(0)
        if pushes is not None and noise_mm > 0.0:
            self._nuisance, self._standing = pushes.own, pushes.standing
        if not (beyond_noise or self._is_fitted()):
            self._nuisance, self._standing = np.zeros((count, 0)), np.zeros(0)
        self.second = {False: halves(samples), True: stretches(count)}
        """Second half of the samples, for variables that do not depend on time (False) and for those that do (True)."""
        self._halves = {is_time: self._both(second) for is_time, second in self.second.items()}
        self._whole = self._half(np.ones(count, bool))
        self._inverse = np.linalg.inv(self._whole.prior.information(self._whole.information))

    def share(self, design: sparse.csr_matrix, is_time: bool) -> float:
        """Return the explained share of a hypothesis, at most 1; negative where it predicts wrongly.

        Parameters
        ----------
        design : sparse matrix, shape (n, values)
        is_time : bool
            Whether it depends on time, so that neighbouring stretches predict one another and not laps.
        """
        return self.share_and_values(design, is_time)[0]

    def share_and_values(self, design: sparse.csr_matrix, is_time: bool) -> tuple[float, FloatArray]:
        """Return the explained share, and the values c fitted to all samples, in mm."""
        first, second = (half.moments(design, self._noise_mm) for half in self._halves[is_time])
        values_mm = (first + second).fitted(self._ridge)[0]
        if self.whole <= 0.0:
            return 0.0, values_mm
        gained = first.gained(*second.fitted(self._ridge)) + second.gained(*first.fitted(self._ridge))
        return min(gained * self._noise_mm**2 / len(self.residual_mm) / self.whole, 1.0), values_mm

    def fit(self, design: sparse.csr_matrix) -> FloatArray:
        """Return the values c of a hypothesis fitted to all samples, in mm."""
        return self._whole.moments(design, self._noise_mm).fitted(self._ridge)[0]

    def step_gains(self, weights: FloatArray, cells: NDArray[np.intp], count: int) -> FloatArray:
        """Return the fall of the sum of squares that a push from each cell on explains; entry k begins with cell k.

        Parameters
        ----------
        weights : ndarray, shape (n, m)
            Derivatives of the readings with respect to the push's components.
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
        left = gradient - cross @ (self._inverse @ on.prior.gradient(on.gradient))
        solved = np.linalg.solve(projected + ridge[:, None, None] * np.eye(m), left[..., None])[..., 0]
        gains: FloatArray = np.einsum("ij,ij->i", left, solved)
        return gains

    def _is_fitted(self) -> bool:
        on = self._half(np.ones(len(self.residual_mm), bool))
        pulled = on.prior.gradient(on.gradient)
        steps = np.linalg.solve(on.prior.information(on.information), pulled)
        return float(pulled @ steps) < FITTED * float(on.residual @ on.residual)

    def _both(self, second: Mask) -> tuple[Half, Half]:
        return self._half(~second), self._half(second)

    def _half(self, rows: Mask) -> Half:
        jacobian = self._nuisance[rows] / self._noise_mm
        residual = self.residual_mm[rows] / self._noise_mm
        prior = Prior(float(rows.mean()), self._standing)
        return Half(rows, jacobian, residual, jacobian.T @ jacobian, jacobian.T @ residual, prior)
