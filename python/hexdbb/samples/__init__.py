"""The table of samples: what everything from prediction to verdict takes, together with a model."""

from hexdbb.samples.fixings import require_agreement, shared_words
from hexdbb.samples.prediction import (
    PUSH_SHAPES,
    Linearised,
    Prediction,
    effect_pushes,
    linearise,
    normal_equations,
    port_sensitivity,
    predict,
    predict_poses,
)
from hexdbb.samples.table import Samples
from hexdbb.samples.whole import PLANNED, of_its_own

__all__ = [
    "PLANNED",
    "PUSH_SHAPES",
    "Linearised",
    "Prediction",
    "Samples",
    "effect_pushes",
    "linearise",
    "normal_equations",
    "of_its_own",
    "port_sensitivity",
    "predict",
    "predict_poses",
    "require_agreement",
    "shared_words",
]
