"""The picture of a learned effect: the function over its variable with its band, and where the samples lie."""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.figure import Figure

from hexdbb.errors import InputError
from hexdbb.learned.shown import sentence
from hexdbb.learned.words import UM_PER_MM, shown_places
from hexdbb.model import Model

TITLE_CHARACTERS = 95
"""Characters of 9 points across the figure."""
LINE_COLOUR = "#004B76"
BAND_COLOUR = "#56B4E9"
SAMPLES_COLOUR = "0.75"
BAND_SIGMAS = 2.0
"""Half the band's width in standard deviations: 95 % of the probability."""


def learned_figure(model: Model, name: str) -> Figure:
    """Draw a learned effect of a model.

    Parameters
    ----------
    model : Model
        Fitted.
    name : str
        As in `learned:leg:5:turning_rate`.

    Raises
    ------
    InputError
        Where the model has no learned effect of that name.
    """
    term = model.term(name)
    if term is None or term.learned is None:
        known = ", ".join(each.effect for each in model.learned) or "none"
        raise InputError(f"{name}: no learned effect of {model.name} (expected one of: {known})")
    curves = term.learned.curves(term.values)
    figure = Figure(figsize=(7.5, 1.0 + 3.6 * len(curves)), layout="constrained")
    panels = figure.subplots(2 * len(curves), 1, squeeze=False, height_ratios=[4.0, 1.0] * len(curves))[:, 0]
    for component, curve in enumerate(curves):
        above, below = panels[2 * component], panels[2 * component + 1]
        unit, at = shown_places(curve)
        value_um, band_um = UM_PER_MM * curve.value_mm, BAND_SIGMAS * UM_PER_MM * np.nan_to_num(curve.sigma_mm)
        single = {"marker": "o"} if len(at) == 1 else {}
        above.fill_between(at, value_um - band_um, value_um + band_um, color=BAND_COLOUR, alpha=0.4, linewidth=0.0)
        above.plot(at, value_um, color=LINE_COLOUR, linewidth=1.5, **single)
        above.axhline(0.0, color="0.35", linewidth=0.8)
        above.set_ylabel("push, µm", fontsize=9)
        title = sentence(term.learned.space.hypothesis, curve, term.learned.space.period, component)
        above.set_title(textwrap.fill(title, TITLE_CHARACTERS), fontsize=9)
        above.grid(color="0.88", linewidth=0.6)
        widths = np.gradient(at) if len(at) > 1 else np.ones(1)
        below.fill_between(at, np.nan_to_num(curve.samples) / widths, color=SAMPLES_COLOUR, step="mid")
        below.set(yticks=[], xlim=above.get_xlim(), ylim=(0.0, None))
        below.set_ylabel("samples", fontsize=8)
        below.set_xlabel(f"{curve.variable}, {unit}" if unit else curve.variable, fontsize=9)
    figure.suptitle(f"{name}, band ± {BAND_SIGMAS:g} standard deviations", fontsize=10)
    return figure
