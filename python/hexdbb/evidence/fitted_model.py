"""A model fitted to all samples: what a search begins with; who asks for the geometry alone first has it already."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import Noise, evaluate_fit
from hexdbb.model import Model
from hexdbb.samples import Samples

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FittedModel:
    """A model's free values fitted to all samples: what a search begins with.

    Attributes
    ----------
    start : Model
        As it was.
    model : Model
        Fitted.
    residual_mm : ndarray, shape (n,)
        What it leaves.
    """

    start: Model
    model: Model
    residual_mm: Floats

    @classmethod
    def of(cls, samples: Samples, start: Model, noise: Noise) -> FittedModel:
        """Fit a model; `RunError` where the fit did not end in a usable solution."""
        model, result = evaluate_fit(samples, start, start.free, noise, hypothesis=True)
        return cls(start, model, result.residual_mm)

    def is_of(self, model: Model) -> bool:
        """Check whether a model that stems from the same one would be fitted alike."""
        return (
            [each.effect for each in model.terms] == [each.effect for each in self.start.terms]
            and np.array_equal(model.free, self.start.free)
            and np.array_equal(model.values, self.start.values)
        )
