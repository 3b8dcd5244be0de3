"""Words that the sentences of a discovery share; learned functions are described by `hexdbb.learned`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from hexdbb.discovery.result import Grouping
from hexdbb.evidence.fit.heldout import HeldOut
from hexdbb.learned import Learned, describe
from hexdbb.learned.following import creeps, is_relay
from hexdbb.learned.numbered import number_of
from hexdbb.learned.repeating import has_chosen_period, period_of_wave
from hexdbb.learned.shown import sentence, whole_place_words
from hexdbb.learned.variable import NUMBERED
from hexdbb.learned.words import UM_PER_MM
from hexdbb.model import Term

GROUPS: dict[Grouping, str] = {"circle": "circles", "feed": "feeds", "direction": "directions", "lap": "laps"}
NOTHING = "nothing is missing: what is left is noise"
KNOWN_ALONE = "known effects alone were tried: a function learned from the readings may explain as much"
SMALLEST_DEVIATION = 0.01
"""Deviation of form from which it is stated: below, a machine's effect is as the formula has it."""

MOST_WAYS = 2
"""Functions of one push that are told one by one. Those over where a leg points, for its tilt and the square of that,
say little each: they make up for one another."""
MOST_CURVES = 3
"""Curves that a sentence describes one by one, those of a ball or a cup; a load on the platform has ten."""


def function_clause(term: Term) -> str:
    """Return a learned effect of a fitted model as a clause: where it pushes, on what it depends, its form.

    Of the axes of a ball or cup those along which nothing is distinguishable from zero are left out. Where that is all,
    geometry takes most of what it does: two legs, by the angle of their joints, are two sliders nearer to each other.
    """
    effect = term.learned
    assert effect is not None
    space = effect.space
    curves = effect.curves(term.values)
    clear = [k for k, curve in enumerate(curves) if describe(curve, space.period).kind != "nothing"]
    if creeps(space.hypothesis.variable):
        size_um = UM_PER_MM * float(np.linalg.norm([curves[k].value_mm[0] for k in clear]))
        return _creep_clause(space.hypothesis, f" by {size_um:.3g} µm")
    if space.hypothesis.variable.is_anew:
        size_um = UM_PER_MM * float(np.linalg.norm([np.ptp(curves[k].value_mm) for k in clear]))
        return f"{place_clause(space.hypothesis)}, within {size_um:.3g} µm"
    if NUMBERED in space.hypothesis.variable.name:  # instants or a period say more than the function's form
        return place_clause(space.hypothesis)
    variable = space.hypothesis.variable
    if variable.ways > MOST_WAYS:
        return f"{whole_place_words(space.hypothesis)}: follows the {variable.words}, otherwise at each of its tilts"
    if not clear:
        return f"{place_clause(space.hypothesis)}, by how much geometry tells as well"
    if len(clear) > MOST_CURVES:
        largest = max(clear, key=lambda k: float(np.ptp(curves[k].value_mm)))
        said = sentence(space.hypothesis, curves[largest], space.period, largest)
        return f"{said}, and {len(clear) - 1} smaller functions of it along other axes"
    return ", ".join(sentence(space.hypothesis, curves[k], space.period, k) for k in clear)


def place_clause(hypothesis: Learned) -> str:
    """Return where a learned hypothesis acts and what it follows: instants, a period, or the variable's name."""
    place, variable = whole_place_words(hypothesis), hypothesis.variable
    if variable.is_anew:
        return f"{place}: is otherwise with each sweep"
    if variable.instants:
        return f"{place}: shifts at {joined([f'{each:.0f} s' for each in variable.instants])}"
    if is_relay(variable):
        return f"{place}: in {variable.words}"
    if creeps(variable):
        return _creep_clause(hypothesis)
    if NUMBERED in variable.name:
        if (period_mm := period_of_wave(variable.times)) is not None:
            by = variable.name.partition("_")[0]
            return f"{place}: repeats every {period_mm:.4g} mm of travel, more or less by its {by}"
        otherwise = ", otherwise at each feed" if variable.beside else ""
        repeats = f"repeats every {variable.period:.4g} {variable.unit}{otherwise}"
        return f"{place}: {repeats if has_chosen_period(variable) else f'follows the {variable.words}'}"
    if not variable.column and not variable.times:
        return f"{place}: a constant"
    return f"{place}: follows the {variable.name.replace('_', ' ')}"


def _creep_clause(hypothesis: Learned, size: str = "") -> str:
    constant_s = number_of(hypothesis.variable)
    return f"{whole_place_words(hypothesis)}: creeps{size} towards an end within about {constant_s:.3g} s"


def unseen_words(heldout: Mapping[str, HeldOut], share: float) -> str:
    """Return on what it holds: ``on circles, feeds and directions not used to find it``; empty where on nothing."""
    held = [words for name, words in GROUPS.items() if name in heldout and heldout[name].share >= 0.5 * share]
    return f"on {joined(held)} not used to find it" if held else ""


def joined(words: Sequence[str]) -> str:
    """Return words joined by commas and ``and``."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}" if words else ""


def percent(share: float) -> str:
    """Return a share in per cent, 100 only where nothing is left."""
    shown = min(max(100.0 * share, 0.0), 100.0)
    return "more than 99 %" if 99.5 <= shown < 100.0 else f"{shown:.0f} %"
