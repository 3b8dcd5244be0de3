"""Picture of a coverage study: how many intervals of a level contain the truth, and 95 % intervals by effect."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexdbb.studies.drawing import GRID, STATED, error_bars
from hexdbb.studies.rates import Bounded


def coverage_figure(by_level: Mapping[float, Bounded], by_effect: Mapping[str, Bounded]) -> Figure:
    """Return the figure of shares with their bounds, by level and by effect."""
    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    _draw_levels(left, by_level)
    _draw_effects(right, by_effect)
    return figure


def _draw_levels(axes: Axes, by_level: Mapping[float, Bounded]) -> None:
    levels = 100.0 * np.array(list(by_level))
    axes.plot([0.0, 100.0], [0.0, 100.0], color=STATED, linewidth=1.0, label="as stated")
    error_bars(axes, levels, by_level.values(), 100.0, "found, 95 % bounds")
    low = min((100.0 * each.low for each in by_level.values() if each.number), default=0.0)
    axes.set_xlim(max(0.0, min(levels.min(), low) - 5.0), 100.5)
    axes.set_ylim(max(0.0, min(levels.min(), low) - 5.0), 100.5)
    axes.set_xlabel("stated level of the interval, %")
    axes.set_ylabel("intervals that contain the truth, %")
    axes.grid(**GRID)
    axes.legend(loc="upper left")


def _draw_effects(axes: Axes, by_effect: Mapping[str, Bounded]) -> None:
    shown = {effect: each for effect, each in by_effect.items() if each.number}
    places = np.arange(len(shown))
    axes.axhline(95.0, color=STATED, linewidth=1.0, label="as stated")
    error_bars(axes, places, shown.values(), 100.0, None)
    axes.set_xticks(places, list(shown), rotation=35.0, ha="right", rotation_mode="anchor")
    axes.set_ylabel("95 % intervals that contain the truth, %")
    axes.grid(axis="y", **GRID)
