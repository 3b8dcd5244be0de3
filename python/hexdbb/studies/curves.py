"""Detection curve: how likely a fault of a size is found, from cases in which it was or was not.

Model: P(found at size x) = 1 / (1 + exp(-k (ln x - ln x50))), the logistic curve over the logarithm of the size, as for
the probability of detection in non-destructive testing (MIL-HDBK-1823A, appendix G).
Estimate: the posterior of (ln x50, ln k) on a grid, both evenly distributed beforehand; the curve is its mean, sizes
are its medians, bounds its 2.5 % and 97.5 % quantiles. Unlike a maximum of the likelihood it exists where all small
faults were missed and all large ones found, as in most studies of few cases.
Units: sizes in any one unit.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit, log_expit

from hexdbb.studies.rates import CONFIDENCE, Bounded

Floats = NDArray[np.float64]

BEYOND = 30.0
"""Factor by which x50 may lie beyond the sizes tried: further out, what was tried says nothing of it."""
STEEPNESS = (0.5, 40.0)
"""Least and largest k: from a rise over four decades to one over a tenth of the size."""
STEPS = 181
"""Points of the grid along each axis: neighbours in x50 differ by 7 % with sizes over two decades, less than bounds of
any study that is run."""
LEVELS = ((1.0 - CONFIDENCE) / 2.0, 0.5, (1.0 + CONFIDENCE) / 2.0)
"""Quantiles of the posterior: low bound, value, high bound."""


@dataclass(frozen=True, eq=False)
class DetectionCurve:
    """The curve of some cases.

    Attributes
    ----------
    size : (n,) array
        Above zero.
    found : (n,) array of bool
    """

    size: Floats
    found: NDArray[np.bool_]

    @classmethod
    def of(cls, size: ArrayLike, found: ArrayLike) -> DetectionCurve:
        """Return the curve of sizes and of whether each was found."""
        return cls(np.asarray(size, dtype=float), np.asarray(found, dtype=bool))

    @cached_property
    def _posterior(self) -> tuple[Floats, Floats, Floats]:
        """Grid points ln x50 and k, and their weights, all of shape (STEPS * STEPS,)."""
        logs = np.log(self.size)
        reach = np.log(BEYOND)
        centre, steepness = np.meshgrid(
            np.linspace(logs.min() - reach, logs.max() + reach, STEPS), np.geomspace(*STEEPNESS, STEPS), indexing="ij"
        )
        likelihood = np.zeros_like(centre)
        for log_size, found in zip(logs, self.found, strict=True):
            at = steepness * (log_size - centre)
            likelihood += log_expit(at if found else -at)
        weight = np.exp(likelihood - likelihood.max()).ravel()
        return centre.ravel(), steepness.ravel(), weight / weight.sum()

    def size_found(self, probability: float) -> Bounded:
        """Return the size that is found with a probability; infinite, of either sign, beyond what was tried."""
        centre, steepness, weight = self._posterior
        log_size = centre + np.log(probability / (1.0 - probability)) / steepness
        low, value, high = np.exp(_weighted(log_size, weight, LEVELS))
        smallest, largest = float(self.size.min()), float(self.size.max())
        return Bounded(
            _within(value, smallest, largest),
            _within(low, smallest, largest),
            _within(high, smallest, largest),
            len(self.size),
        )

    def probability(self, size: ArrayLike) -> tuple[Floats, Floats, Floats]:
        """Return low bound, mean and high bound of the probability to be found, shape of `size` each."""
        centre, steepness, weight = self._posterior
        logs = np.log(np.atleast_1d(np.asarray(size, dtype=float)))
        every = [expit(steepness * (log_size - centre)) for log_size in logs]
        low, _, high = np.array([_weighted(each, weight, LEVELS) for each in every]).T
        return low, np.array([each @ weight for each in every]), high


def _weighted(values: Floats, weight: Floats, levels: tuple[float, ...]) -> Floats:
    """Return quantiles of weighted values."""
    order = np.argsort(values)
    return np.interp(levels, np.cumsum(weight[order]), values[order])


def _within(size: float, smallest: float, largest: float) -> float:
    """Return a size; infinity, negative below what was tried, where it lies beyond it."""
    return -np.inf if size < smallest else np.inf if size > largest else float(size)
