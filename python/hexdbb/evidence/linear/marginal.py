"""Marginal likelihood of a signature whose coefficients have a Gaussian prior, and its hyperparameters.

With coefficients T z, z ~ N(0, tau^2 I), and A, b of `sums.py`,

    ln evidence over the base = -1/2 ln det(I + tau^2 T'A T) + 1/2 tau^2 b'T (I + tau^2 T'A T)^-1 T'b,

diagonal in the eigenvectors of T'A T, so that all sizes tau cost one decomposition. Size and smoothness are averaged
over a grid (`Criteria`), which is REML with its own uncertainty counted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Marginal:
    """Log evidence over the base, averaged over the grid; the grid's best point and the coefficients there.

    `best` is the place of the prior factor and of the size in their grids, `axes` the factor turned to its own axes,
    shape (k, r), and `strength` what the readings tell of each, in values' worth.
    """

    log_evidence: float
    best: tuple[int, int]
    size: float
    factor: Floats
    coefficients: Floats
    axes: Floats
    strength: Floats

    def seen(self, least: float, most: int) -> Floats:
        """Return the axes that the readings see, at most so many, the best: shape (k, r)."""
        enough = max(least, float(np.sort(self.strength)[-min(len(self.strength), most)]))
        found: Floats = self.axes[:, self.strength >= min(enough, float(self.strength.max()))]
        return found


def marginal(
    information: Floats,
    gradient: Floats,
    factors: Sequence[Floats],
    sizes: Floats,
    weights: Floats | None = None,
    temper: float = 1.0,
) -> Marginal:
    """Average the evidence of a signature over prior factors and sizes.

    Parameters
    ----------
    information, gradient : ndarray, shapes (k, k), (k,)
        A and b.
    factors : sequence of ndarray, shape (k, k)
        T, each as probable as the others.
    sizes : ndarray, shape (m,)
        tau.
    weights : ndarray, shape (m,), optional
        Probability of each size; equal where not given.
    temper : float
        Variance that stands for the noise's one.
    """
    log_weights = np.full(len(sizes), -np.log(len(sizes))) if weights is None else np.log(weights)
    table = np.empty((len(factors), len(sizes)))
    parts = []
    for row, factor in enumerate(factors):
        values, vectors = np.linalg.eigh(factor.T @ information @ factor / temper)
        values = np.maximum(values, 0.0)
        along = vectors.T @ (factor.T @ gradient) / temper
        table[row] = _of_sizes(values, along, sizes) + log_weights
        parts.append((values, vectors, along))
    best = divmod(int(np.argmax(table)), len(sizes))
    size = float(sizes[best[1]])
    values, vectors, along = parts[best[0]]
    coefficients = factors[best[0]] @ (vectors @ (size**2 * along / (1.0 + size**2 * values)))
    return Marginal(
        log_evidence=float(np.logaddexp.reduce(table, axis=None)) - float(np.log(len(factors))),
        best=best,
        size=size,
        factor=factors[best[0]],
        coefficients=coefficients,
        axes=factors[best[0]] @ vectors,
        strength=size**2 * values * temper,
    )


def log_evidences(information: Floats, gradient: Floats, sizes: Floats, temper: float) -> Floats:
    """Return the log evidence that `marginal` has for each of many signatures of one prior factor: shape (many,).

    Parameters
    ----------
    information, gradient : ndarray, shapes (many, k, k), (many, k)
        T'A T and T'b.
    sizes : ndarray, shape (m,)
        tau, equally probable.
    temper : float
        Variance that stands for the noise's one.
    """
    values, vectors = np.linalg.eigh(information / temper)
    along = np.matmul(vectors.transpose(0, 2, 1), gradient[:, :, None])[:, :, 0] / temper
    table = _of_sizes(np.maximum(values, 0.0), along, sizes) - np.log(len(sizes))
    found: Floats = np.logaddexp.reduce(table, axis=-1)
    return found


def _of_sizes(values: Floats, along: Floats, sizes: Floats) -> Floats:
    """Return the log evidence of each size, from the eigenvalues of T'A T and T'b along its axes: shape (..., m)."""
    squares = np.asarray(sizes)[:, None] ** 2
    grown = 1.0 + squares * values[..., None, :]
    found: Floats = 0.5 * np.sum(squares * along[..., None, :] ** 2 / grown - np.log(grown), axis=-1)
    return found


def solved(information: Floats, gradient: Floats, factor: Floats, size: float) -> Floats:
    """Return the most probable coefficients for one prior, shape (k,)."""
    inner = factor.T @ information @ factor + np.eye(factor.shape[1]) / size**2
    found: Floats = factor @ np.linalg.solve(inner, factor.T @ gradient)
    return found
