"""Remaining structure: variables that predict what a fitted model leaves, for a fault that no known effect explains.

The ranking of predictors (`hexdbb.predictors`) for a fitted model's residual: the model's own free values may imitate
part of any variable, and shares are of what exceeds the noise.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis import Noise
from hexdbb.discovery.result import Structure
from hexdbb.model import Model
from hexdbb.predictors import Predictor, Pushes, main_predictors, rank_predictors, sentence
from hexdbb.samples import Samples

Floats = NDArray[np.float64]

MOST_NAMED = 6


def unexplained_structure(samples: Samples, model: Model, residual_mm: Floats, noise: Noise) -> tuple[Structure, ...]:
    """Name the variables that carry the unexplained variance, largest share first.

    Parameters
    ----------
    samples : Samples
    model : Model
        Fitted to them.
    residual_mm : ndarray, shape (n,)
        What it leaves.
    noise : Noise
    """
    if float(np.mean(residual_mm**2)) <= noise.sigma_mm**2:
        return ()
    pushes = Pushes.of(samples, model)
    found = rank_predictors(samples, residual_mm, pushes, noise.sigma_mm, beyond_noise=True)
    return tuple(_structure(each) for each in main_predictors(found, MOST_NAMED))


def _structure(each: Predictor) -> Structure:
    place = None if each.place is None else (each.place.begin, each.place.end)
    return Structure(each.variable, each.share, each.period, each.unit, sentence(each), place, each.size_um)
