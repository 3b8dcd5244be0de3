"""The share of a residual that a hypothesis carries, judged on samples that it was not fitted to.

A hypothesis is a sparse design matrix W: the residual is W c. What the model's own free values could imitate must not
count for or against it: with J their derivatives (divided by expected sizes), c and their shifts d are fitted together,

    min |r - W c - J d|^2 / noise^2 + |d|^2 + |c|^2 / size^2,

to one half of the samples, and W c + J d predicts the other half, and the other way round. The part of the mean square
that goes there is the share. Noise predicts nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from hexdbb.variables.columns import Columns, FloatArray, halves, stretches

SIZE_MM = 0.03
"""A push larger than a few times this is not expected; keeps what the readings cannot tell at zero."""
LEAST_PART = 1e-9
"""The same where no noise is given: of the largest diagonal element."""

FITTED = 0.1
"""A residual of which the model's own values could mend more than this part is not that of a fit."""

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Trained:
    """Some of the samples, and what the model's own values do there."""

    rows: Mask
    jacobian: FloatArray
    inverse: NDArray[np.floating]
    """Of J'J / noise^2 + I."""
    gradient: FloatArray


class Judge:
    """Judges hypotheses on one residual.

    Parameters
    ----------
    columns : dict of str to (n,) arrays
        As `sample_columns` gives them.
    nuisance : ndarray, shape (n, p), optional
        Derivatives of the readings at what may imitate a hypothesis, each times its expected size, mm. Left aside where
        the residual is not that of a fit, so that much of it could be mended by these alone, or without a noise.
    noise_mm : float
        Of one reading; 0 where it is not known.
    beyond_noise : bool
        Whether shares are of what is beyond the noise, or of the whole mean square.
    """

    def __init__(
        self,
        columns: Columns,
        nuisance: FloatArray | None = None,
        noise_mm: float = 0.0,
        *,
        beyond_noise: bool = False,
    ) -> None:
        self.residual_mm: FloatArray = columns["residual_um"] * 1e-3
        count = len(self.residual_mm)
        self._noise_mm = noise_mm if noise_mm > 0.0 else 1.0
        self._ridge = (1.0 / SIZE_MM) ** 2 if noise_mm > 0.0 else 0.0
        self.whole = float(np.mean(self.residual_mm**2)) - (noise_mm**2 if beyond_noise else 0.0)
        self._nuisance = np.zeros((count, 0)) if nuisance is None or noise_mm <= 0.0 else nuisance
        if not self._is_fitted():
            self._nuisance = np.zeros((count, 0))
        by_lap, by_stretch = halves(columns), stretches(count)
        self._halves = {False: self._both(by_lap), True: self._both(by_stretch)}
        self.everything = self._trained(np.ones(count, bool))

    def share(self, design: sparse.csr_matrix, is_time: bool) -> float:
        """Give the share a hypothesis carries, at most 1; negative where it predicts wrongly.

        Parameters
        ----------
        design : sparse matrix, shape (n, values)
        is_time : bool
            Whether it depends on time, so that neighbouring stretches are held against one another and not laps.
        """
        if self.whole <= 0.0:
            return 0.0
        gained = sum(self._gained(design, trained) for trained in self._halves[is_time])
        return min(gained / len(self.residual_mm) / self.whole, 1.0)

    def fit(self, design: sparse.csr_matrix, trained: Trained | None = None) -> tuple[FloatArray, FloatArray]:
        """Give the values c of a hypothesis and the shifts d of the model's own, in mm and expected sizes."""
        on = self.everything if trained is None else trained
        own = design[on.rows] / self._noise_mm
        cross = np.asarray(own.T @ on.jacobian) / self._noise_mm
        gradient = own.T @ (self.residual_mm[on.rows] / self._noise_mm)
        square = (own.T @ own).toarray()
        ridge = max(self._ridge, LEAST_PART * float(square.diagonal().max(initial=1.0)))
        square = square + ridge * np.eye(len(square))
        eased = on.inverse @ cross.T
        values: FloatArray = np.linalg.solve(square - cross @ eased, gradient - eased.T @ on.gradient)
        return values, on.inverse @ (on.gradient - cross.T @ values)

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
        on, scale = self.everything, 1.0 / self._noise_mm
        m = weights.shape[1]
        square, cross = np.zeros((count, m, m)), np.zeros((count, m, on.jacobian.shape[1]))
        gradient = np.zeros((count, m))
        order = np.argsort(cells, kind="stable")
        edges = np.searchsorted(cells[order], np.arange(count + 1))
        for cell in range(count):
            rows = order[edges[cell] : edges[cell + 1]]
            own = weights[rows] * scale
            square[cell], cross[cell] = own.T @ own, own.T @ on.jacobian[rows] * scale
            gradient[cell] = own.T @ (self.residual_mm[rows] * scale)
        square, cross, gradient = (np.cumsum(each[::-1], axis=0)[::-1] for each in (square, cross, gradient))
        projected = square - cross @ on.inverse @ cross.transpose(0, 2, 1)
        ridge = np.maximum(self._ridge, LEAST_PART * square.max(axis=(1, 2), initial=1.0))
        left = gradient - cross @ (on.inverse @ on.gradient)
        solved = np.linalg.solve(projected + ridge[:, None, None] * np.eye(m), left[..., None])[..., 0]
        gains: FloatArray = np.einsum("ij,ij->i", left, solved)
        return gains

    def _is_fitted(self) -> bool:
        on = self._trained(np.ones(len(self.residual_mm), bool))
        mended = float(on.gradient @ on.inverse @ on.gradient) * self._noise_mm**2
        return mended < FITTED * float(self.residual_mm @ self.residual_mm)

    def _both(self, second: Mask) -> tuple[Trained, Trained]:
        return self._trained(~second), self._trained(second)

    def _trained(self, rows: Mask) -> Trained:
        jacobian = self._nuisance[rows] / self._noise_mm
        inverse = np.linalg.inv(jacobian.T @ jacobian + np.eye(jacobian.shape[1]))
        gradient: FloatArray = jacobian.T @ (self.residual_mm[rows] / self._noise_mm)
        return Trained(rows, self._nuisance[rows], inverse, gradient)

    def _gained(self, design: sparse.csr_matrix, trained: Trained) -> float:
        values, shifts = self.fit(design, trained)
        judged = ~trained.rows
        predicted = design[judged] @ values + self._nuisance[judged] @ shifts
        left = self.residual_mm[judged]
        return float(np.sum(left**2 - (left - predicted) ** 2))
