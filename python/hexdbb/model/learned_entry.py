"""A learned effect in a model file, and back."""

from __future__ import annotations

from dataclasses import replace

from hexdbb.errors import InputError
from hexdbb.learned import FINER, Learned, Space
from hexdbb.model.entries import LearnedEntry
from hexdbb.model.learned import LearnedEffect
from hexdbb.model.shown import shown_value


def learned_entry(effect: LearnedEffect) -> LearnedEntry:
    """Return a learned effect in the form of the file."""
    space = effect.space
    return LearnedEntry(
        low=space.low,
        high=space.high,
        splines=space.hypothesis.variable.count,
        period=space.period,
        sign_width=space.sign_width,
        since_s=space.since_s,
        span_s=space.span_s,
        warp_width=space.warp_width,
        roughness=effect.roughness,
        prior_sigma_um=shown_value(effect.prior_sigma_mm, "mm"),
        sigma_um=tuple(shown_value(each, "mm") for each in effect.sigma_mm),
        samples=effect.samples,
    )


def learned_effect(name: str, entry: LearnedEntry) -> LearnedEffect:
    """Return the learned effect that a file has.

    Raises
    ------
    InputError
        A name that is no hypothesis, or numbers that do not go with it.
    """
    hypothesis = Learned.parse(name)
    variable = hypothesis.variable
    splines = [variable.count * times for times in ((1, *FINER) if variable.is_smooth else (1,))]
    if entry.splines not in splines:
        raise InputError(f"{name}: splines {entry.splines} (expected {' or '.join(map(str, splines))})")
    hypothesis = hypothesis.finer(entry.splines // variable.count)
    if not entry.high > entry.low:
        raise InputError(f"{name}: high {entry.high:g} (expected more than low, {entry.low:g})")
    if variable.signed != (entry.sign_width > 0.0):
        raise InputError(f"{name}: sign_width {entry.sign_width:g} (expected {'> 0' if variable.signed else '0'})")
    if (variable.period != 0.0) != (entry.period > 0.0):
        raise InputError(f"{name}: period {entry.period:g} (expected {'> 0' if variable.period else '0'})")
    if entry.warp_width > 0.0 and not variable.signed:
        raise InputError(f"{name}: warp_width {entry.warp_width:g} (expected 0)")
    if variable.signed and entry.warp_width == 0.0:
        hypothesis = replace(hypothesis, variable=replace(hypothesis.variable, is_even=True))
    space = Space(
        hypothesis,
        entry.low,
        entry.high,
        entry.period,
        entry.sign_width,
        entry.since_s,
        entry.span_s,
        entry.warp_width,
    )
    points = len(space.points())
    for key, given, expected in (
        ("sigma_um", entry.sigma_um, hypothesis.functions * points),
        ("samples", entry.samples, points),
    ):
        if given and len(given) != expected:
            raise InputError(f"{name}: {key}: {len(given)} numbers (expected {expected})")
    return LearnedEffect(
        space,
        entry.roughness,
        entry.prior_sigma_um * 1e-3,
        tuple(each * 1e-3 for each in entry.sigma_um),
        entry.samples,
    )
