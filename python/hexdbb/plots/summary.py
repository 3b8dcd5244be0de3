"""The picture to look at first: the likely cause, the circle of the largest residual, where and on what it depends."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexdbb.charts.colours import MEASURED_COLOURS
from hexdbb.comparison import UM_PER_MM, CircleComparison, Comparison
from hexdbb.comparison.tables import COMMANDED
from hexdbb.files.plain_text import capital
from hexdbb.plots.circle_pages import add_legend, draw_circle
from hexdbb.plots.labels import longest_in
from hexdbb.plots.panels import draw_residual
from hexdbb.plots.residual_pages import draw_both_directions, draw_predictor, ranked_predictors
from hexdbb.plots.rooms import Room, label_at_once, panels, titled
from hexdbb.plots.style import all_inside, sheet, styled

HEIGHT_IN = 10.3
FOOT_IN = 0.68
"""Height of the sheet and of the legend with its note, inches."""
BANDS = {"worst": 3.3, "ranking": 2.0, "predictors": 1.75}
"""Parts of the height between title and legend."""
DIAL_ROOM, BESIDE_ROOM = Room(0.3, 0.2, 0.5, 0.72), Room(0.68, 0.1, 0.38, 0.3)
LINES_BELOW_IN = 0.15
"""Room that the label of the lower panel beside the dial takes beyond that of the upper one, inches."""
RANKING_ROOM, PREDICTOR_ROOM = Room(0.1, 0.1, 0.06, 0.42), Room(0.6, 0.1, 0.55, 0.42)
"""Room around the panels, inches; beside the ranking's come its names."""
NAMES_MOST_IN = 3.5
"""Length of a name beside a bar, inches: longer ones are cut."""
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
    figure = sheet(HEIGHT_IN)
    worst = circles[0]
    title = f"{heading(comparison)}\nlargest residual: {worst.record_name}, circle {worst.circle.id}"
    bands = _bands(figure, titled(figure, title))
    _draw_worst(figure, bands["worst"], worst, meant_by(comparison))
    _draw_ranking(figure, bands["ranking"], circles)
    found = ranked_predictors(comparison)[:PREDICTORS]
    grid = panels(figure, (1, PREDICTORS), PREDICTOR_ROOM, *bands["predictors"])
    for place, predictor in enumerate(found):
        axes = figure.add_subplot(grid[0, place])
        draw_predictor(axes, predictor, width=30)
        label_at_once(axes)
        if place == 0:
            axes.set_ylabel("in the reading, µm")
    add_legend(figure, "lowest panels: what predicts the residual best, and the share of its variance explained")
    return figure


def _bands(figure: Figure, head_in: float) -> dict[str, tuple[float, float]]:
    """Return what stands above and below each band of panels, inches."""
    height_in = figure.get_figheight()
    free_in, whole = height_in - head_in - FOOT_IN, sum(BANDS.values())
    found, above_in = {}, head_in
    for name, part in BANDS.items():
        end_in = above_in + free_in * part / whole
        found[name] = above_in, height_in - end_in
        above_in = end_in
    return found


def _draw_worst(figure: Figure, band: tuple[float, float], circle: CircleComparison, meant: Sequence[str]) -> None:
    """Draw a circle, beside it its residual and the parts of that by direction."""
    dial = panels(figure, (1, 1), DIAL_ROOM, *band, (0.0, 0.5))
    head_in, foot_in = band
    beside = panels(figure, (2, 1), BESIDE_ROOM, head_in, foot_in + LINES_BELOW_IN, (0.5, 1.0), [1.5, 1.7])
    draw_circle(figure.add_subplot(dial[0, 0]), circle, meant)
    residual = figure.add_subplot(beside[0, 0])
    draw_residual(residual, circle, RESIDUAL_IN, meant)
    residual.set_xlabel("")
    directions = figure.add_subplot(beside[1, 0])
    _draw_directions(directions, circle, meant)
    for axes in (residual, directions):
        label_at_once(axes)


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


def _draw_ranking(figure: Figure, band: tuple[float, float], circles: Sequence[CircleComparison]) -> None:
    """Draw the residual of each circle, feed and direction as bars, the largest first."""
    shown = circles[:MOST_BARS]
    several = len({circle.record_name for circle in circles}) > 1
    names = [
        (f"{circle.record_name}, " if several else "") + f"circle {circle.circle.id}, {circle.feed_mm_min:g} mm/min"
        for circle in shown
    ]
    names_in = min(longest_in(figure, names), NAMES_MOST_IN)
    room = replace(RANKING_ROOM, left=RANKING_ROOM.left + names_in)
    axes = figure.add_subplot(panels(figure, (1, 1), room, *band)[0, 0])
    for row, circle in enumerate(shown):
        for part in circle.directions:
            axes.barh(
                row - 0.19 * part.direction, UM_PER_MM * part.rms_mm, 0.36, color=MEASURED_COLOURS[part.direction]
            )
    axes.set_yticks(np.arange(len(shown)), names)
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.grid(visible=False, axis="y")
    axes.tick_params(axis="y", length=0.0)
    left = len(circles) - len(shown)
    axes.set_xlabel("residual, µm RMS (blue ccw, orange cw)" + (f"; {left} smaller ones not shown" if left else ""))
    label_at_once(axes)
    all_inside(axes)
