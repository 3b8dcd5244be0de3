"""Predictors of a residual: the variables of the samples (angle, a slider's position, time, ...) that explain it.

::

    pushes = Pushes.of(samples, model)
    found = rank_predictors(samples, residual_mm, pushes, noise_mm)
    [sentence(each) for each in main_predictors(found, 6)]
"""

from hexdbb.predictors.names import record_names
from hexdbb.predictors.predictor import LEAST_SHARE, Predictor, Profile
from hexdbb.predictors.pushes import Pushes
from hexdbb.predictors.ranking import main_predictors, rank_predictors
from hexdbb.predictors.sentence import sentence

__all__ = [
    "LEAST_SHARE",
    "Predictor",
    "Profile",
    "Pushes",
    "main_predictors",
    "rank_predictors",
    "record_names",
    "sentence",
]
