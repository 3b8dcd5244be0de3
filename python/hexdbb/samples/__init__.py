"""The table of samples: what everything from prediction to verdict takes, together with a model."""

from hexdbb.samples.earlier import knowing, mount_keys, predict_reading_mm, residual_mm, samples_of, unseen_mounts
from hexdbb.samples.measured import Measured, measured
from hexdbb.samples.prediction import (
    PUSH_SHAPES,
    Linearised,
    Prediction,
    linearise,
    normal_equations,
    port_sensitivity,
    predict,
)
from hexdbb.samples.table import Samples
from hexdbb.samples.whole import PLANNED

__all__ = [
    "PLANNED",
    "PUSH_SHAPES",
    "Linearised",
    "Measured",
    "Prediction",
    "Samples",
    "knowing",
    "linearise",
    "measured",
    "mount_keys",
    "normal_equations",
    "port_sensitivity",
    "predict",
    "predict_reading_mm",
    "residual_mm",
    "samples_of",
    "unseen_mounts",
]
