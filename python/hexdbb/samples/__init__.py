"""The table of samples: what everything from prediction to verdict takes, together with a model."""

from hexdbb.samples.prediction import knowing, mount_keys, predict_reading_mm, residual_mm, samples_of, unseen_mounts
from hexdbb.samples.table import Measured, measured

__all__ = [
    "Measured",
    "knowing",
    "measured",
    "mount_keys",
    "predict_reading_mm",
    "residual_mm",
    "samples_of",
    "unseen_mounts",
]
