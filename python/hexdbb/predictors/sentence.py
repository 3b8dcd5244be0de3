"""A predictor in words: the variable, where and how often it acts, and how strongly."""

from __future__ import annotations

from hexdbb.predictors.periods import folded_hz
from hexdbb.predictors.predictor import Predictor

MAINS_HZ = (50.0, 60.0, 100.0, 120.0)
"""Mains of 50 and 60 Hz, and twice those: what rectifiers and magnetic cores make of them."""
NEAR_HZ = 0.1
"""Largest distance at which a frequency is taken for that of the mains: grids hold theirs to 0.2 %."""
SLOW_HZ = 0.2
"""Frequency below which an alias is not suspected: laps and warming are that slow."""


def sentence(predictor: Predictor) -> str:
    """Return the predictor in words: ``slider 3 position, between 212 and 224 mm: up to 4.1 µm along the guideway``."""
    words = predictor.variable + _where(predictor) + _period(predictor)
    if predictor.size_um is None:
        return words
    most = "up to " if predictor.period is None and not _happens_once(predictor) else ""
    return f"{words}: {most}{predictor.size_um:.3g} µm {predictor.pushes}"


def _happens_once(predictor: Predictor) -> bool:
    return predictor.place is not None and bool(predictor.place.words)


def _where(predictor: Predictor) -> str:
    place = predictor.place
    if place is None:
        return ""
    begin, end = f"{place.begin:.0f}", f"{place.end:.0f}"
    range_words = f"at {begin} {predictor.unit}" if begin == end else f"between {begin} and {end} {predictor.unit}"
    return f", {range_words}" + (f" ({place.words})" if place.words else "")


def _period(predictor: Predictor) -> str:
    if predictor.period is None:
        return ""
    if predictor.sampled_hz is None:
        return f" every {predictor.period:.4g} {predictor.unit}"
    frequency_hz = 1.0 / predictor.period
    if frequency_hz < SLOW_HZ:
        return f" every {predictor.period:.4g} {predictor.unit}"
    mains = [f"{each:g}" for each in MAINS_HZ if abs(folded_hz(each, predictor.sampled_hz) - frequency_hz) < NEAR_HZ]
    as_mains = f"; {' or '.join(mains)} Hz would alias to it" if mains else ""
    return (
        f" with {frequency_hz:.4g} Hz, or a faster one aliased by sampling at {predictor.sampled_hz:.4g} Hz{as_mains}"
    )
