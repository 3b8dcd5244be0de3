"""The picture of a learned effect: the function over its variable with its band, and where the samples lie."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexdbb.charts.colours import BAND_COLOUR, FORMULA_COLOUR, FUNCTION_COLOUR, NOMINAL_COLOUR, RULE_COLOUR
from hexdbb.errors import InputError
from hexdbb.learned import Curve
from hexdbb.learned.shown import place_words, sentence
from hexdbb.learned.words import UM_PER_MM, shown_places
from hexdbb.model import Model
from hexdbb.plots.style import sheet, styled

TITLE_CHARACTERS = 100
"""Characters of 8 points across the figure."""
SUPTITLE_CHARACTERS = 85
"""Characters of 10 points across the figure."""
BAND_SIGMAS = 2.0
"""Half the band's width in standard deviations: 95 % of the probability."""

STATES, STATE_NAMES = (-1.0, 1.0), ("back", "over")
"""Values of a variable of two states, and what a picture calls them."""


@styled
def learned_figure(model: Model, name: str, formula: Sequence[Curve] = (), title: str = "") -> Figure:
    """Draw a learned effect of a model.

    Parameters
    ----------
    model : Model
        Fitted.
    name : str
        As in `learned:leg:5:turning_rate`.
    formula : sequence of Curve, optional
        What a known effect has in its place, one a function, drawn beside it.
    title : str
        Above all; the effect's name where not given.

    Raises
    ------
    InputError
        Where the model has no learned effect of that name.
    """
    term = model.term(name)
    if term is None or term.learned is None:
        known = ", ".join(each.effect for each in model.learned) or "none"
        raise InputError(f"{name}: no learned effect of {model.name} (expected one of: {known})")
    curves, space = term.learned.curves(term.values), term.learned.space
    figure = sheet(1.0 + 3.6 * len(curves))
    panels = figure.subplots(2 * len(curves), 1, squeeze=False, height_ratios=[4.0, 1.0] * len(curves))[:, 0]
    for number, curve in enumerate(curves):
        above, below = panels[2 * number], panels[2 * number + 1]
        _draw_function(above, curve, formula[number] if formula else None)
        place = place_words(space.hypothesis, number)
        said = place if formula else sentence(space.hypothesis, curve, space.period, number)
        above.set_title(_wrapped(said, TITLE_CHARACTERS))
        if space.hypothesis.variable.is_log:
            above.set_xscale("log")
            below.set_xscale("log")
        _draw_samples(below, curve, above, space.hypothesis.variable.is_log)
    figure.suptitle(_wrapped(title or f"{name}, band ± {BAND_SIGMAS:g} standard deviations", SUPTITLE_CHARACTERS))
    return figure


def _wrapped(text: str, characters: int) -> str:
    """Break a text into lines, none between a number and its unit."""
    return textwrap.fill(text.replace(" µm", "\u00a0µm").replace("± ", "±\u00a0"), characters)


def _draw_function(axes: Axes, curve: Curve, formula: Curve | None) -> None:
    _, at = shown_places(curve)
    value_um, band_um = UM_PER_MM * curve.value_mm, BAND_SIGMAS * UM_PER_MM * np.nan_to_num(curve.sigma_mm)
    marker = "o" if len(at) == 1 else None
    label = f"as the readings have it, ± {BAND_SIGMAS:g} standard deviations"
    if curve.has_states:
        axes.errorbar(at, value_um, band_um, color=FUNCTION_COLOUR, label=label, fmt="o", capsize=4.0)
        axes.set_xticks(STATES, STATE_NAMES)
    else:
        axes.fill_between(at, value_um - band_um, value_um + band_um, color=BAND_COLOUR, alpha=0.3, linewidth=0.0)
        axes.plot(at, value_um, color=FUNCTION_COLOUR, linewidth=1.5, label=label, marker=marker)
    if formula is not None:
        axes.plot(
            at,
            UM_PER_MM * formula.value_mm,
            color=FORMULA_COLOUR,
            linestyle="--",
            label="by its formula",
            marker=marker,
        )
        axes.legend()
    axes.axhline(0.0, color=NOMINAL_COLOUR, linewidth=0.8)
    axes.set_ylabel("push, µm")


def _draw_samples(axes: Axes, curve: Curve, above: Axes, is_log: bool) -> None:
    """Draw how densely the samples lie along the variable."""
    unit, at = shown_places(curve)
    if curve.has_states:
        axes.bar(at, np.nan_to_num(curve.samples), 0.1, color=RULE_COLOUR)
        axes.set_xticks(STATES, STATE_NAMES)
        axes.set(yticks=[], xlim=above.get_xlim(), xlabel=curve.variable, ylabel="samples")
        return
    widths = np.gradient(np.log(at) if is_log else at) if len(at) > 1 else np.ones(1)
    axes.fill_between(at, np.nan_to_num(curve.samples) / widths, color=RULE_COLOUR, step="mid")
    axes.set(yticks=[], xlim=above.get_xlim(), ylim=(0.0, None))
    axes.set_ylabel("samples")
    axes.set_xlabel(f"{curve.variable}, {unit}" if unit else curve.variable)
