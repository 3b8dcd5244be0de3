"""Picture of a power study: how likely a fault is named, over its size, one panel an effect."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexdbb.studies.curves import DetectionCurve
from hexdbb.studies.drawing import BAD, GRID, MEASURED, STATED, error_bars, size_axis
from hexdbb.studies.rates import share
from hexdbb.studies.study import Row

COLUMNS = 4
"""Panels side by side, each wide enough for its labels on a page."""
GROUPS = 5
"""Groups of cases of similar size, whose shares are drawn beside the curve: with 40 cases eight in each."""


def power_figure(rows: Sequence[Row], curves: Mapping[str, DetectionCurve | None], units: Mapping[str, str]) -> Figure:
    """Return the figure of the curves of several effects, with the shares of groups of cases."""
    drawn = {effect: curve for effect, curve in curves.items() if curve is not None}
    across = max(1, min(COLUMNS, len(drawn)))
    down = max(1, math.ceil(len(drawn) / across))
    figure = Figure(figsize=(3.2 * across + 0.6, 2.9 * down + 0.7), layout="constrained")
    panels = figure.subplots(down, across, squeeze=False, sharey=True).ravel()
    for axes, (effect, curve) in zip(panels, drawn.items(), strict=False):
        _draw(axes, effect, units[effect], curve, rows)
    for axes in panels[len(drawn) :]:
        axes.set_visible(False)
    for axes in panels[::across]:
        axes.set_ylabel("named, % of the machines")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(handles), frameon=False)
    return figure


def _draw(axes: Axes, effect: str, unit: str, curve: DetectionCurve, rows: Sequence[Row]) -> None:
    size = np.geomspace(curve.size.min(), curve.size.max(), 120)
    low, middle, high = (100.0 * each for each in curve.probability(size))
    axes.fill_between(size, low, high, color=MEASURED, alpha=0.2, linewidth=0.0, label="95 % bounds")
    axes.plot(size, middle, color=MEASURED, label="curve")
    order = np.argsort(curve.size)
    groups = [each for each in np.array_split(order, GROUPS) if len(each)]
    centres = [float(np.exp(np.log(curve.size[each]).mean())) for each in groups]
    shares = [share(int(curve.found[each].sum()), len(each)) for each in groups]
    error_bars(axes, centres, shares, 100.0, "cases of similar size", STATED)
    false = [each["size"] for each in rows if each["effect"] == effect and each["outcome"] == "false"]
    axes.plot(false, np.zeros(len(false)), "x", color=BAD, label="false name")
    axes.axhline(95.0, color=STATED, linewidth=0.8, linestyle=":")
    axes.set_xscale("log")
    size_axis(axes.xaxis)
    axes.set_ylim(-3.0, 103.0)
    axes.set_xlabel(f"size, {unit}")
    axes.set_title(effect, fontsize=10)
    axes.grid(**GRID)
