"""Explained share of a residual, cross-validated: the part of it that a hypothesis predicts where it was not fitted.

A hypothesis is a design matrix W with few entries a row: the residual is W c. What the model's own free values could
imitate must not count for or against it: with J their derivatives (times their prior standard deviations), c and their
shifts d are fitted together,

    min |r - W c - J d|^2 / noise^2 + |v + d|^2 + |c|^2 / size^2,

v the present values (for half of the samples with half the weight), to one half of the samples, and W c + J d predicts
the other half, and the other way round. The fall of the mean square there is the explained share. Noise predicts
nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb.predictors.design import Design, Mask
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


@dataclass(frozen=True)
class Own:
    """Sums of the model's own values over some samples, J'J and J'r in units of the noise, and their prior.

    Attributes
    ----------
    square, gradient : ndarray
        Without the prior.
    weight : float
        Of the prior: the part of all samples that these are.
    standing : ndarray, shape (p,)
        The present values, in prior standard deviations.
    """

    square: FloatArray
    gradient: FloatArray
    weight: float
    standing: FloatArray

    @cached_property
    def inverse(self) -> FloatArray:
        """Inverse of the information, the prior's in it."""
        inverse: FloatArray = np.linalg.inv(self.square + self.weight * np.eye(len(self.square))).astype(np.float64)
        return inverse

    @cached_property
    def pull(self) -> FloatArray:
        """Gradient, the prior's in it."""
        pull: FloatArray = self.gradient - self.weight * self.standing
        return pull

    def __sub__(self, other: Own) -> Own:
        return Own(
            self.square - other.square, self.gradient - other.gradient, self.weight - other.weight, self.standing
        )


@dataclass(frozen=True)
class Moments:
    """Sums over some samples: W'W, W'J, W'r, and those of the model's own values; a fit and its test need no more."""

    square: FloatArray
    cross: FloatArray
    gradient: FloatArray
    own: Own

    def fitted(self, ridge: float) -> tuple[FloatArray, FloatArray]:
        """Fit the values c of the hypothesis and the shifts d of the model's own."""
        damping = max(ridge, LEAST_PART * float(self.square.diagonal().max(initial=1.0)))
        eased: FloatArray = self.own.inverse @ self.cross.T
        values: FloatArray = np.linalg.solve(
            self.square + damping * np.eye(len(self.square)) - self.cross @ eased,
            self.gradient - eased.T @ self.own.pull,
        ).astype(np.float64)
        return values, self.own.inverse @ (self.own.pull - self.cross.T @ values)

    def gained(self, values: FloatArray, shifts: FloatArray) -> float:
        """Return the fall of the sum of squares when W c + J d is subtracted from these residuals."""
        along = values @ self.gradient + shifts @ self.own.gradient
        predicted = values @ self.square @ values + 2.0 * (values @ self.cross @ shifts)
        return float(2.0 * along - predicted - shifts @ self.own.square @ shifts)


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
        own, standing = np.zeros((count, 0)), np.zeros(0)
        if pushes is not None and noise_mm > 0.0:
            own, standing = pushes.own, pushes.standing
        self._take(own, standing)
        if not (beyond_noise or self._is_fitted()):
            self._take(own[:, :0], standing[:0])
        self.second = {False: halves(samples), True: stretches(count)}
        """Second half of the samples, for variables that do not depend on time (False) and for those that do (True)."""
        self._halves = {is_time: self._both(second) for is_time, second in self.second.items()}

    def share(self, design: Design, is_time: bool) -> float:
        """Return the explained share of a hypothesis, at most 1; negative where it predicts wrongly.

        Parameters
        ----------
        design : Design
            Of n rows.
        is_time : bool
            Whether it depends on time, so that neighbouring stretches predict one another and not laps.
        """
        return self._share(*self._moments_of_halves(design, is_time))

    def share_and_values(self, design: Design, is_time: bool) -> tuple[float, FloatArray, FloatArray]:
        """Return the explained share, the values c fitted to all samples, in mm, and the diagonal of W'W."""
        first, second = self._moments_of_halves(design, is_time)
        whole = Moments(
            first.square + second.square, first.cross + second.cross, first.gradient + second.gradient, self._whole
        )
        squares: FloatArray = whole.square.diagonal() * self._noise_mm**2
        return self._share(first, second), whole.fitted(self._ridge)[0], squares

    def fit(self, design: Design) -> FloatArray:
        """Return the values c of a hypothesis fitted to all samples, in mm."""
        (whole,) = self._moments(design, np.zeros(len(self.residual_mm), np.int32), (self._whole,))
        return whole.fitted(self._ridge)[0]

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
        m, scale = weights.shape[1], 1.0 / self._noise_mm
        square, sums = Design.full(weights * scale).sums(self._table, cells, count)
        cross, gradient = sums[:, :, :-1], sums[:, :, -1]
        square, cross, gradient = (np.cumsum(each[::-1], axis=0)[::-1] for each in (square, cross, gradient))
        projected = square - cross @ self._whole.inverse @ cross.transpose(0, 2, 1)
        ridge = np.maximum(self._ridge, LEAST_PART * square.max(axis=(1, 2), initial=1.0))
        left = gradient - cross @ (self._whole.inverse @ self._whole.pull)
        solved = np.linalg.solve(projected + ridge[:, None, None] * np.eye(m), left[..., None])[..., 0]
        gains: FloatArray = np.einsum("ij,ij->i", left, solved)
        return gains

    def _take(self, own: FloatArray, standing: FloatArray) -> None:
        """Let the model's own values be fitted with every hypothesis, derivatives `own` of shape (n, p)."""
        self._table = np.ascontiguousarray(np.column_stack([own, self.residual_mm]) / self._noise_mm)
        """[J r], in units of the noise."""
        self._standing = standing
        self._whole = self._own(self._table, 1.0)

    def _is_fitted(self) -> bool:
        residual = self._table[:, -1]
        return float(self._whole.pull @ self._whole.inverse @ self._whole.pull) < FITTED * float(residual @ residual)

    def _both(self, second: Mask) -> tuple[Own, Own]:
        there = self._own(self._table[second], float(second.mean()))
        return self._whole - there, there

    def _own(self, table: FloatArray, weight: float) -> Own:
        total = table.T @ table
        return Own(total[:-1, :-1], total[:-1, -1], weight, self._standing)

    def _moments_of_halves(self, design: Design, is_time: bool) -> list[Moments]:
        return self._moments(design, self.second[is_time].astype(np.int32), self._halves[is_time])

    def _moments(self, design: Design, group: NDArray[np.int32], owns: tuple[Own, ...]) -> list[Moments]:
        """Return a hypothesis' sums over each group of samples."""
        square, cross = design.sums(self._table, group, len(owns))
        square, cross = square / self._noise_mm**2, cross / self._noise_mm
        return [Moments(square[k], cross[k, :, :-1], cross[k, :, -1], own) for k, own in enumerate(owns)]

    def _share(self, first: Moments, second: Moments) -> float:
        if self.whole <= 0.0:
            return 0.0
        gained = first.gained(*second.fitted(self._ridge)) + second.gained(*first.fitted(self._ridge))
        return min(gained * self._noise_mm**2 / len(self.residual_mm) / self.whole, 1.0)
