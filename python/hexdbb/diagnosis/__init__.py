"""Diagnosis: the values that explain measured readings best, how well they are known, what cannot be known."""

from hexdbb.diagnosis.extrapolation import foretold
from hexdbb.diagnosis.fit import diagnose, evaluate_fit, refitter
from hexdbb.diagnosis.heldout import HeldOut, held_out
from hexdbb.diagnosis.mounts import fit_mounts, with_mounts_fitted
from hexdbb.diagnosis.noise import Noise, lap_differences, noise_of, stated_noise
from hexdbb.diagnosis.result import UNKNOWN_PART, Diagnosis
from hexdbb.diagnosis.step import ledger_step
from hexdbb.diagnosis.whiteness import is_white

__all__ = [
    "UNKNOWN_PART",
    "Diagnosis",
    "HeldOut",
    "Noise",
    "diagnose",
    "evaluate_fit",
    "fit_mounts",
    "foretold",
    "held_out",
    "is_white",
    "lap_differences",
    "ledger_step",
    "noise_of",
    "refitter",
    "stated_noise",
    "with_mounts_fitted",
]
