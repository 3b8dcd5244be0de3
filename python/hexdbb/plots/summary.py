"""The picture to look at first: the likely cause, the circle of the largest residual, where and on what it depends."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexdbb.charts.colours import MEASURED_COLOURS
from hexdbb.comparison import UM_PER_MM, CircleComparison, Comparison
from hexdbb.comparison.tables import COMMANDED
from hexdbb.files.plain_text import capital
from hexdbb.plots.circle_pages import add_legend, draw_circle
from hexdbb.plots.panels import draw_residual
from hexdbb.plots.residual_pages import draw_both_directions, draw_predictor, ranked_predictors
from hexdbb.plots.style import all_inside, sheet, styled

MOST_BARS = 14
"""Circles and feeds named in the ranking: seven circles at two feeds."""
PREDICTORS = 3
TITLE_CHARACTERS = 88
"""Characters of a title's size across the sheet."""
RESIDUAL_IN, DIRECTIONS_IN = (3.0, 1.3), (3.0, 1.6)
"""Width and height of panels without their labels, inches, about."""


@styled
def summary_page(comparison: Comparison) -> Figure:
    """Draw what matters first of several circles, a part of each of the other pictures."""
    circles = sorted(comparison.circles, key=lambda circle: -circle.rms_mm)
    worst = circles[0]
    meant = meant_by(comparison)
    figure = sheet(10.3)
    grid = figure.add_gridspec(4, 6, height_ratios=[1.5, 1.7, 2.2, 1.6])
    draw_circle(figure.add_subplot(grid[0:2, :3]), worst, meant)
    residual = figure.add_subplot(grid[0, 3:])
    draw_residual(residual, worst, RESIDUAL_IN, meant)
    residual.set_xlabel("")
    _draw_directions(figure.add_subplot(grid[1, 3:]), worst, meant)
    _draw_ranking(figure.add_subplot(grid[2, :]), circles)
    for place, predictor in enumerate(ranked_predictors(comparison)[:PREDICTORS]):
        axes = figure.add_subplot(grid[3, 2 * place : 2 * place + 2])
        draw_predictor(axes, predictor, width=30)
        if place == 0:
            axes.set_ylabel("in the reading, µm")
    figure.suptitle(f"{heading(comparison)}\nlargest residual: {worst.record_name}, circle {worst.circle.id}")
    add_legend(figure, "lowest panels: what predicts the residual best, and the share of its variance explained")
    return figure


def heading(comparison: Comparison) -> str:
    """Return the likely cause, where there is one, and the size of the residual."""
    rms_um, peak_um = UM_PER_MM * comparison.rms_mm, UM_PER_MM * comparison.peak_to_valley_mm
    size = f"residual (measured - predicted): {rms_um:.2f} µm RMS, {peak_um:.2f} µm peak to valley"
    if comparison.is_commanded:
        size += f"\nno model: predicted is {COMMANDED}"
    if comparison.cause is None:
        return size
    sentence = comparison.cause.sentence
    cause = textwrap.fill(capital(sentence).replace(" µm", "\u00a0µm"), TITLE_CHARACTERS)
    return f"{cause}\n{size}"


def meant_by(comparison: Comparison) -> tuple[str, ...]:
    """Return the elements (``slider 4``) that the likely cause acts at."""
    return () if comparison.cause is None else comparison.cause.subjects


def _draw_directions(axes: Axes, circle: CircleComparison, meant: Sequence[str]) -> None:
    if circle.both_directions is None:
        axes.set_axis_off()
        return
    draw_both_directions(axes, circle, DIRECTIONS_IN, meant)
    axes.set(title="", xlabel="commanded polar angle, deg", ylabel="residual, µm")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, columnspacing=1.0)


def _draw_ranking(axes: Axes, circles: Sequence[CircleComparison]) -> None:
    """Draw the residual of each circle, feed and direction as bars, the largest first."""
    shown = circles[:MOST_BARS]
    several = len({circle.record_name for circle in circles}) > 1
    for row, circle in enumerate(shown):
        for part in circle.directions:
            axes.barh(
                row - 0.19 * part.direction, UM_PER_MM * part.rms_mm, 0.36, color=MEASURED_COLOURS[part.direction]
            )
    names = [
        (f"{circle.record_name}, " if several else "") + f"circle {circle.circle.id}, {circle.feed_mm_min:g} mm/min"
        for circle in shown
    ]
    axes.set_yticks(np.arange(len(shown)), names)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.grid(visible=False, axis="y")
    axes.tick_params(axis="y", length=0.0)
    left = len(circles) - len(shown)
    axes.set_xlabel("residual, µm RMS (blue ccw, orange cw)" + (f"; {left} smaller ones not shown" if left else ""))
    all_inside(axes)
