"""Pictures of the residual alone: against each predictor, its two directions combined, its harmonics.

Panels stand in the order of what they show most of, each to its own scale.
"""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexdbb.charts.colours import BY_NAME, COMMON_COLOUR, LINE_COLOUR, REVERSING_COLOUR
from hexdbb.comparison import UM_PER_MM, Comparison
from hexdbb.comparison.circles import SHORT_DIRECTION_NAMES, CircleComparison
from hexdbb.comparison.iso230 import FloatArray
from hexdbb.plots.marks import mark_reversals
from hexdbb.predictors import LEAST_SHARE, Predictor

COLUMNS = 4
MOST_PREDICTORS = 16
"""Number of panels drawn: four rows are still read on a screen."""
TITLE_WIDTH = 36
"""Characters in a line above a panel."""
BYSTANDER_COLOUR = "0.5"
GAP = 10.0
"""Distance between points, in usual distances, at which a line breaks: a guideway's two sliders do not meet."""


def predictors_page(comparison: Comparison) -> Figure:
    """Draw what the bins of each predictor explain of the residual: largest share first, bystanders last."""
    drawn = [each for each in comparison.predictors if each.profiles]
    found = [each for each in drawn if each.share > LEAST_SHARE][:MOST_PREDICTORS] or drawn[:COLUMNS]
    found.sort(key=lambda each: (each.is_bystander, -each.share))
    rows = -(-len(found) // COLUMNS)
    figure = Figure(figsize=(11.5, 2.2 * rows + 0.9), layout="constrained")
    grid = figure.subplots(rows, COLUMNS, squeeze=False)
    for axes, predictor in zip(grid.flat, found, strict=False):
        _draw_predictor(axes, predictor)
    for axes in grid.flat[len(found) :]:
        axes.set_axis_off()
    for row in grid:
        row[0].set_ylabel("in the reading, µm", fontsize=8)
    figure.suptitle(
        "Predictors of the residual (measured - predicted): response in the reading (RMS of each bin, signed as the"
        " push),\nand explained variance, cross-validated: fitted to one half of the laps, tested on the other",
        fontsize=11,
    )
    return figure


def directions_page(comparison: Comparison) -> Figure:
    """Draw the common part and the reversing part of both directions' residuals, the largest residual first."""
    pairs = [circle for circle in comparison.circles if circle.both_directions is not None]
    pairs.sort(key=lambda circle: -circle.rms_mm)
    meant = () if comparison.cause is None else comparison.cause.subjects
    rows = max(-(-len(pairs) // COLUMNS), 1)
    figure = Figure(figsize=(11.5, 2.2 * rows + 1.2), layout="constrained")
    grid = figure.subplots(rows, COLUMNS, squeeze=False)
    for axes, circle in zip(grid.flat, pairs, strict=False):
        _draw_both_directions(axes, circle)
        mark_reversals(axes, circle.reversals, meant)
    for axes in grid.flat[len(pairs) :]:
        axes.set_axis_off()
    for row in grid:
        row[0].set_ylabel("residual, µm", fontsize=8)
    figure.suptitle("Residuals of both directions combined, against commanded polar angle (deg)", fontsize=11)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=8, frameon=False)
    return figure


def harmonics_page(comparison: Comparison) -> Figure:
    """Draw the amplitude of every harmonic of the residual, a line for each capture, the largest amplitude first."""
    rows = [
        (f"circle {circle.circle.id}, {circle.feed_mm_min:g}, {SHORT_DIRECTION_NAMES[part.direction]}", part.harmonics)
        for circle in comparison.circles
        for part in circle.directions
        if part.harmonics
    ]
    rows.sort(key=lambda row: -max(each.amplitude_mm for each in row[1]))
    highest = max(len(harmonics) for _, harmonics in rows)
    amplitude_um = np.full((len(rows), highest), np.nan)
    for row, (_, harmonics) in enumerate(rows):
        amplitude_um[row, : len(harmonics)] = [UM_PER_MM * each.amplitude_mm for each in harmonics]
    figure = Figure(figsize=(8.5, 0.24 * len(rows) + 2.0), layout="constrained")
    axes = figure.subplots()
    axes.imshow(amplitude_um, aspect="auto", cmap="Blues", vmin=0.0)
    axes.set_xticks(np.arange(highest), [str(order) for order in range(1, highest + 1)], fontsize=8)
    axes.set_yticks(np.arange(len(rows)), [label for label, _ in rows], fontsize=7)
    axes.set_xlabel("order (periods per turn)", fontsize=8)
    axes.set_title("Amplitude of the residual's harmonics, µm (circle, feed in mm/min, direction)", fontsize=11)
    largest = float(np.nanmax(amplitude_um))
    for row, column in np.argwhere(amplitude_um > 0.0):
        value = amplitude_um[row, column]
        colour = "white" if value > 0.6 * largest else "black"
        axes.text(
            column,
            row,
            f"{value:.1f}" if value >= 1.0 else f"{value:.2f}",
            ha="center",
            va="center",
            fontsize=6,
            color=colour,
        )
    return figure


def _draw_predictor(axes: Axes, predictor: Predictor) -> None:
    axes.axhline(0.0, color="0.6", linewidth=0.6)
    classes = not predictor.unit
    for means in predictor.profiles:
        # A variable with many classes (each circle) is drawn in one colour.
        colour = BY_NAME.get(means.name, LINE_COLOUR)
        marker, line = ("o", "none") if classes else (".", "-")
        axes.plot(
            *_broken(means.centre, means.mean_um),
            color=colour,
            linewidth=0.8,
            markersize=3.5,
            marker=marker,
            linestyle=line,
            label=means.name,
        )
    if all(means.name for means in predictor.profiles):
        axes.legend(loc="best", fontsize=6, frameon=False)
    title = textwrap.fill(f"{predictor.variable}: {100.0 * predictor.share:.0f} %", TITLE_WIDTH)
    if predictor.is_bystander:
        title += "\n(goes with the likely cause)"
    axes.set_title(title, fontsize=8, color=BYSTANDER_COLOUR if predictor.is_bystander else "black")
    if classes:
        names = dict(predictor.classes)
        ticks = sorted({float(each) for means in predictor.profiles for each in means.centre})
        axes.set_xticks(ticks, [names.get(tick, f"{tick:g}") for tick in ticks])
        axes.margins(x=0.2)
    else:
        axes.set_xlabel(predictor.unit, fontsize=7, labelpad=1)
        low, high = axes.get_xlim()
        axes.set_xticks([tick for tick in axes.get_xticks() if low <= tick <= high])
    low, high = axes.get_ylim()
    axes.set_yticks([tick for tick in axes.get_yticks() if low <= tick <= high])
    axes.tick_params(labelsize=7)
    axes.grid(color="0.92", linewidth=0.5)


def _broken(centre: FloatArray, mean_um: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the points with a nan wherever a line should not be drawn."""
    step = np.diff(centre)
    far = np.flatnonzero(step > GAP * np.median(step)) + 1 if len(step) > 2 else np.zeros(0, np.intp)
    return np.insert(centre, far, np.nan), np.insert(mean_um, far, np.nan)


def _draw_both_directions(axes: Axes, circle: CircleComparison) -> None:
    both = circle.both_directions
    assert both is not None  # the page is made of circles that have both directions
    angle_deg = np.degrees(both.angle_rad)
    axes.axhline(0.0, color="0.6", linewidth=0.6)
    for values_mm, colour, label in (
        (both.half_sum_mm, COMMON_COLOUR, "(ccw + cw) / 2: common part"),
        (both.half_difference_mm, REVERSING_COLOUR, "(ccw - cw) / 2: reversing part"),
    ):
        axes.plot(angle_deg, UM_PER_MM * values_mm, color=colour, linewidth=1.0, label=label)
    axes.set_title(
        f"circle {circle.circle.id}, {circle.feed_mm_min:g} mm/min: {UM_PER_MM * circle.rms_mm:.2f} µm RMS", fontsize=8
    )
    axes.set_xlim(0.0, 360.0)
    axes.set_xticks(np.arange(0, 361, 90))
    axes.tick_params(labelsize=7)
    axes.grid(color="0.92", linewidth=0.5)
