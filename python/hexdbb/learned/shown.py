"""A learned function for people: one sentence, and a short table of its values."""

from __future__ import annotations

import numpy as np

from hexdbb.learned.hypothesis import Learned
from hexdbb.learned.places import ALL, AXES, EACH, LEVERS, PAIRS
from hexdbb.learned.tables import Curve
from hexdbb.learned.words import UM_PER_MM, describe, shown_places

ROWS = 9
"""Rows of a table in the terminal: enough to see a form."""
PLACES = {
    "slider": "slider {} along its guideway",
    "leg": "length of leg {}",
    "lateral": "guideway {}, sideways",
    "vertical": "guideway {}, up and down",
    "platform_joint": "platform's joint of leg {}",
    "ball": "ball",
    "cup": "cup",
    "reading": "reading of the gauge",
    "guideway": "guideway {}",
    "slider_joint": "joint of slider {}",
    "platform": "all joints of the platform, outward",
    "load": "load on the platform, by elastic legs",
}
PAIR_OF = {
    "slider": "sliders {} and {} along their guideway",
    "leg": "lengths of legs {} and {}",
    "platform_joint": "platform's joint of legs {} and {}",
}
ALL_OF = {
    "slider": "all sliders along their guideways",
    "leg": "length of all legs",
    "lateral": "all guideways, outward",
}
EACH_OF = {
    "slider": "sliders along their guideways, each in its own way",
    "leg": "lengths of legs, each in its own way",
}
ACROSS = {"x": ", sideways", "z": ", up and down"}
"""Axes of a guideway in words."""
SORTS = {"pull": ", a pull along {}", "turn": ", a couple about {}"}
"""Sorts of loads in words."""


def place_words(hypothesis: Learned, function: int = 0) -> str:
    """Return where a function pushes, in words."""
    axis = hypothesis.axis_name(function)
    if hypothesis.element == EACH:
        return PLACES[hypothesis.place].format(axis)
    if hypothesis.place in LEVERS:
        sort, _, about = axis.partition("_")
        return whole_place_words(hypothesis) + SORTS[sort].format(about)
    across = ACROSS if hypothesis.place in AXES else {}
    return whole_place_words(hypothesis) + (across.get(axis, f" along {axis}") if axis else "")


def whole_place_words(hypothesis: Learned) -> str:
    """Return the same without the axis of one of its functions."""
    if hypothesis.element == EACH:
        return EACH_OF[hypothesis.place]
    if hypothesis.element == ALL and hypothesis.place in ALL_OF:
        return ALL_OF[hypothesis.place]
    if hypothesis.element_name in PAIRS:
        return PAIR_OF[hypothesis.place].format(*hypothesis.element_name.split("-"))
    return PLACES[hypothesis.place].format(hypothesis.element)


def sentence(hypothesis: Learned, curve: Curve, period: float = 0.0, function: int = 0) -> str:
    """Return what a function is, in one sentence: where it pushes, on what it depends, its form."""
    form = describe(curve, period)
    band = float(np.median(curve.sigma_mm)) * UM_PER_MM
    known = "" if np.isnan(band) else f" (± {band:.2f} µm)"
    over = f" over the {curve.variable}" if curve.column and form.kind != "step" else ""
    both = ", alike both ways" if hypothesis.variable.each_way and not curve.times else ""
    return f"{place_words(hypothesis, function)}{over}: {form.text}{both}{known}"


def rows(curve: Curve) -> list[tuple[str, str, str]]:
    """Return a short table: place, value and standard deviation (µm), evenly chosen among samples, with extremes."""
    seen = np.flatnonzero(np.nan_to_num(curve.samples, nan=1.0) > 0.0)
    seen = seen if len(seen) else np.arange(len(curve.at))
    unit, at = shown_places(curve)
    even = np.linspace(0, len(seen) - 1, ROWS).round().astype(int)
    extremes = [int(np.argmin(curve.value_mm[seen])), int(np.argmax(curve.value_mm[seen]))]
    chosen = seen[np.unique([*even, *extremes])]
    return [
        (
            f"{at[row]:.4g} {unit}".strip() if curve.column else "",
            f"{curve.value_mm[row] * UM_PER_MM:.2f}",
            "" if np.isnan(curve.sigma_mm[row]) else f"{curve.sigma_mm[row] * UM_PER_MM:.2f}",
        )
        for row in chosen
    ]
