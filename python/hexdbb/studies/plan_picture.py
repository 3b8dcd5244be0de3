"""Picture of a plan study: what every search found, by its number of circles, beside the study's own plan."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from hexdbb.studies.drawing import BAD, GRID, MEASURED, STATED, error_bars, size_axis
from hexdbb.studies.rates import quantile
from hexdbb.studies.study import Row

ASIDE = 0.25
"""Searches of one number of circles are spread over so much to either side, to be told apart."""


def plan_figure(groups: Mapping[int, Sequence[Row]], own_um: float, own_circles: int) -> Figure:
    """Return the figure of the uncertainties that the searches' plans would state."""
    figure = Figure(figsize=(7.5, 4.2), layout="constrained")
    axes = figure.add_subplot()
    for count, rows in groups.items():
        values = np.array([each["place_um"] for each in rows])
        aside = np.linspace(-ASIDE, ASIDE, len(values)) if len(values) > 1 else np.zeros(1)
        label = "searches" if count == next(iter(groups)) else None
        axes.plot(count + aside, values, ".", color=MEASURED, alpha=0.5, markersize=4, label=label)
    counts, medians = list(groups), [quantile([each["place_um"] for each in rows], 0.5) for rows in groups.values()]
    error_bars(axes, counts, medians, 1.0, "median, 95 % bounds", STATED)
    best = [min(float(each["place_um"]) for each in rows) for rows in groups.values()]
    axes.plot(counts, best, "v", color=BAD, label="best")
    axes.plot([own_circles], [own_um], "s", color="black", label="the study's plan")
    axes.set_yscale("log")
    size_axis(axes.yaxis)
    axes.set_xticks(sorted({*groups, own_circles}))
    axes.set_xlabel("circles")
    axes.set_ylabel("stated uncertainty of the ball's position,\nRMS over the workspace, µm")
    axes.grid(which="both", **GRID)
    axes.legend()
    return figure
