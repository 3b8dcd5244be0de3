"""What a model's free values leave of signatures: sums of squares with these values and their priors eliminated.

About a model, residual y and a signature W (both divided by the noise) obey y = J d + W c + e, d the change of the free
values in prior standard deviations, d ~ N(-standing, I). With d eliminated the evidence for c rests on

    A = W'W - W'J (J'J + I)^-1 J'W,   b = W'y - W'J (J'J + I)^-1 (J'y - standing).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis.noise import Noise
from hexdbb.model import Model
from hexdbb.samples import PUSH_SHAPES, Samples, linearise, port_sensitivity

Floats = NDArray[np.float64]

MAX_ROWS = 12000
"""Rows that sums are taken over at most, evenly spread: more readings than this only sharpen what they already say."""


class Projection:
    """The neighbourhood of a model, for signatures of effects that are not in it.

    Parameters
    ----------
    samples : Samples
    model : Model
        Of mounts that the samples have; fitted, or near it.
    free : ndarray of bool, shape (size,)
    noise : Noise
    """

    def __init__(self, samples: Samples, model: Model, free: NDArray[np.bool_], noise: Noise) -> None:
        stride = -(-len(samples) // MAX_ROWS)
        self.samples = samples.part(np.arange(0, len(samples), stride))
        self.noise_mm = noise.sigma_mm
        here = linearise(self.samples, model)
        prior = model.prior_sigma[free]
        self.residual = here.residual_mm / noise.sigma_mm
        self._own = here.jacobian[:, free] * (prior / noise.sigma_mm)
        standing = (model.values - model.start)[free] / prior
        self._total = self._own.T @ self._own + np.eye(len(prior))
        self._gradient = self._own.T @ self.residual - standing
        pushes = port_sensitivity(self.samples, model)
        self.ports = np.hstack([pushes[port].reshape(len(self.samples), -1) for port in PUSH_SHAPES])
        """Derivatives of the readings by a push at every port column, shape (n, 55), mm per mm."""

    def of(self, signature_mm: Floats) -> tuple[Floats, Floats]:
        """Return A (k, k) and b (k,) of a signature, shape (n, k), mm of reading per unit."""
        scaled = signature_mm / self.noise_mm
        cross = self._own.T @ scaled
        information = scaled.T @ scaled - cross.T @ np.linalg.solve(self._total, cross)
        gradient = scaled.T @ self.residual - cross.T @ np.linalg.solve(self._total, self._gradient)
        return information, gradient
