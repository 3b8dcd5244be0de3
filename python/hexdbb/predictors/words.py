"""A carrier in words: the variable, where and how often, how much."""

from __future__ import annotations

from hexdbb.predictors.carriers import Carrier
from hexdbb.predictors.periods import folded_hz

MAINS_HZ = (50.0, 60.0, 100.0, 120.0)
NEAR_HZ = 0.1
SLOW_HZ = 0.2
"""What is slower goes with laps and warming, and is not suspected to be a fast one that sampling folds."""


def sentence(carrier: Carrier) -> str:
    """Say what a variable is like: ``slider 3 position between 212 and 224 mm: up to 4.1 µm along the guideway``."""
    words = carrier.variable + _where(carrier) + _period(carrier)
    if carrier.size_um is None:
        return words
    most = "up to " if carrier.period is None and not _happens_once(carrier) else ""
    return f"{words}: {most}{carrier.size_um:.3g} µm {carrier.pushes}"


def _happens_once(carrier: Carrier) -> bool:
    return carrier.place is not None and bool(carrier.place.words)


def _where(carrier: Carrier) -> str:
    place = carrier.place
    if place is None:
        return ""
    begin, end = f"{place.begin:.0f}", f"{place.end:.0f}"
    range_words = f"at {begin} {carrier.unit}" if begin == end else f"between {begin} and {end} {carrier.unit}"
    return f", {range_words}" + (f" ({place.words})" if place.words else "")


def _period(carrier: Carrier) -> str:
    if carrier.period is None:
        return ""
    if carrier.sampled_hz is None:
        return f" every {carrier.period:.4g} {carrier.unit}"
    frequency_hz = 1.0 / carrier.period
    if frequency_hz < SLOW_HZ:
        return f" every {carrier.period:.4g} {carrier.unit}"
    mains = [f"{each:g}" for each in MAINS_HZ if abs(folded_hz(each, carrier.sampled_hz) - frequency_hz) < NEAR_HZ]
    as_mains = f"; {' or '.join(mains)} Hz would look so" if mains else ""
    return f" with {frequency_hz:.4g} Hz, or a faster one sampled at {carrier.sampled_hz:.4g} Hz{as_mains}"
