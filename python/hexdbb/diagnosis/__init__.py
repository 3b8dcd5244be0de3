"""Diagnosis: the values that explain measured readings best, how well they are known, what is not identifiable."""

from hexdbb.diagnosis.extrapolation import ExpectedError, expected_error
from hexdbb.diagnosis.fit import Fit, diagnose, evaluate_fit, fit_free, refitter
from hexdbb.diagnosis.glitches import glitches_in, glitches_sentence
from hexdbb.diagnosis.heldout import HeldOut, Refit, as_it_is, held_out
from hexdbb.diagnosis.judging import JudgingNoise, explains_changes, judging_noise
from hexdbb.diagnosis.lack_of_fit import FitTest, LackOfFit
from hexdbb.diagnosis.mounts import fit_mounts
from hexdbb.diagnosis.noise import Noise, lap_differences, noise_of, stated_noise
from hexdbb.diagnosis.place_uncertainty import PlaceUncertainty, place_uncertainty
from hexdbb.diagnosis.result import Diagnosis
from hexdbb.diagnosis.smoothing import learned_effect, space_of
from hexdbb.diagnosis.sufficiency import Sufficiency, assess_sufficiency, p_shown, p_words
from hexdbb.diagnosis.whiteness import is_white

__all__ = [
    "Diagnosis",
    "ExpectedError",
    "Fit",
    "FitTest",
    "HeldOut",
    "JudgingNoise",
    "LackOfFit",
    "Noise",
    "PlaceUncertainty",
    "Refit",
    "Sufficiency",
    "as_it_is",
    "assess_sufficiency",
    "diagnose",
    "evaluate_fit",
    "expected_error",
    "explains_changes",
    "fit_free",
    "fit_mounts",
    "glitches_in",
    "glitches_sentence",
    "held_out",
    "is_white",
    "judging_noise",
    "lap_differences",
    "learned_effect",
    "noise_of",
    "p_shown",
    "p_words",
    "place_uncertainty",
    "refitter",
    "space_of",
    "stated_noise",
]
