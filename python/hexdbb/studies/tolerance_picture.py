"""Picture of a tolerance study: the error of the compensated machine over the level of each factor."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexdbb.studies.drawing import BAD, GRID, MEASURED, SECOND, error_bars, size_axis
from hexdbb.studies.rates import Bounded

Errors = Mapping[tuple[str, float], Bounded]
"""By factor and level."""
LABEL_CHARACTERS = 32
"""Longest line of a label: as wide as its panel."""


def tolerance_figure(medians: Errors, upper: Errors, target_um: float) -> Figure:
    """Return the figure of medians and 95 % quantiles with their bounds, a panel a factor, and the target."""
    factors = list(dict.fromkeys(factor for factor, _ in medians))
    figure = Figure(figsize=(2.7 * len(factors) + 0.6, 3.6), layout="constrained")
    panels = figure.subplots(1, len(factors), squeeze=False, sharey=True).ravel()
    for axes, factor in zip(panels, factors, strict=True):
        _draw(axes, factor, medians, upper, target_um)
    panels[0].set_ylabel("error of the\ncompensated machine, µm")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(handles), frameon=False)
    return figure


def _draw(axes: Axes, factor: str, medians: Errors, upper: Errors, target_um: float) -> None:
    from hexdbb.studies.tolerance import FACTORS

    levels = [level for of, level in medians if of == factor]
    for values, colour, label in ((medians, MEASURED, "median"), (upper, SECOND, "95 % of the machines")):
        of_factor = [values[factor, level] for level in levels]
        measured = [index for index, each in enumerate(of_factor) if np.isfinite(each.value)]
        at = np.array([levels[index] for index in measured])
        chosen = [of_factor[index] for index in measured]
        axes.plot(at, [each.value for each in chosen], color=colour, linewidth=0.9)
        error_bars(axes, at, chosen, 1.0, label, colour)
    axes.axhline(target_um, color=BAD, linewidth=1.0, linestyle="--", label="target")
    axes.set_xscale("log")
    axes.set_yscale("log")
    size_axis(axes.xaxis, levels)
    size_axis(axes.yaxis)
    name, unit, _ = FACTORS[factor]
    axes.set_xlabel("\n".join(textwrap.wrap(f"{name}, {unit}", LABEL_CHARACTERS)), fontsize=8)
    axes.grid(**GRID)
