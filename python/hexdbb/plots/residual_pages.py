"""Pictures of the residual alone: against each predictor, its two directions combined, its harmonics.

Panels stand in the order of what they show most of, each to its own scale.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hexdbb.charts.colours import (
    BY_NAME,
    COMMON_COLOUR,
    LINE_COLOUR,
    NOMINAL_COLOUR,
    QUIET_COLOUR,
    REVERSING_COLOUR,
    TEXT_COLOUR,
)
from hexdbb.comparison import UM_PER_MM, Comparison
from hexdbb.comparison.circles import CircleComparison
from hexdbb.comparison.harmonics import Harmonic
from hexdbb.comparison.iso230 import FloatArray
from hexdbb.plots.labels import Labels
from hexdbb.plots.marks import KEY, mark_reversals
from hexdbb.plots.panels import against_angle
from hexdbb.plots.rooms import Room, label_at_once, panels, titled
from hexdbb.plots.style import all_inside, inside, sheet, styled
from hexdbb.predictors import LEAST_SHARE, Predictor

PREDICTOR_COLUMNS = 3
MOST_PREDICTORS = 15
"""Number of panels drawn: what a sheet has room for."""
PREDICTOR_IN = 2.05
PREDICTOR_ROOM = Room(0.6, 0.1, 0.46, 0.42)
TITLE_WIDTH = 36
"""Characters in a line above a panel."""
DIRECTION_COLUMNS = 2
DIRECTIONS_OF_A_SHEET = 14
DIRECTION_IN = (3.4, 1.0)
"""Width and height of a panel without its labels, inches, about."""
DIRECTION_ROW_IN, DIRECTION_FOOT_IN = 1.5, 0.5
HARMONICS_OF_A_SHEET = 40
HARMONIC_IN = 0.24
GAP = 10.0
"""Distance between points, in usual distances, at which a line breaks: a guideway's two sliders do not meet."""


def ranked_predictors(comparison: Comparison) -> list[Predictor]:
    """Return the predictors worth a panel: largest share first, bystanders last."""
    drawn = [each for each in comparison.predictors if each.profiles]
    found = [each for each in drawn if each.share > LEAST_SHARE][:MOST_PREDICTORS] or drawn[:PREDICTOR_COLUMNS]
    return sorted(found, key=lambda each: (each.is_bystander, -each.share))


@styled
def predictors_page(comparison: Comparison) -> Figure:
    """Draw what the bins of each predictor explain of the residual: largest share first, bystanders last."""
    found = ranked_predictors(comparison)
    rows = max(-(-len(found) // PREDICTOR_COLUMNS), 1)
    figure = sheet(PREDICTOR_IN * rows + 1.0)
    head_in = titled(
        figure,
        "Predictors of the residual (measured - predicted): response in the reading\n"
        "(RMS of each bin, signed as the push), and explained variance, cross-validated:\n"
        "fitted to one half of the laps, tested on the other",
    )
    grid = panels(figure, (rows, PREDICTOR_COLUMNS), PREDICTOR_ROOM, head_in, 0.0)
    for place, predictor in enumerate(found):
        axes = figure.add_subplot(grid[divmod(place, PREDICTOR_COLUMNS)])
        draw_predictor(axes, predictor)
        label_at_once(axes)
        if place % PREDICTOR_COLUMNS == 0:
            axes.set_ylabel("in the reading, µm")
    return figure


@styled
def directions_page(circles: Sequence[CircleComparison], meant: Sequence[str]) -> Figure:
    """Draw the common part and the reversing part of both directions' residuals, in the order given.

    Reversals of the sliders `meant` (``slider 4``) are marked in bold.
    """
    rows = max(-(-len(circles) // DIRECTION_COLUMNS), 1)
    figure = sheet(DIRECTION_ROW_IN * rows + 1.2)
    head_in = titled(figure, "Residuals of both directions combined, against the commanded polar angle, deg")
    grid = panels(figure, (rows, DIRECTION_COLUMNS), Room(top=0.22), head_in, DIRECTION_FOOT_IN)
    for place, circle in enumerate(circles):
        axes = figure.add_subplot(grid[divmod(place, DIRECTION_COLUMNS)])
        draw_both_directions(axes, circle, DIRECTION_IN, meant)
        label_at_once(axes)
        if place % DIRECTION_COLUMNS == 0:
            axes.set_ylabel("residual, µm")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    labels = [
        f"{formula}: {label}" for formula, label in zip(("(ccw + cw) / 2", "(ccw - cw) / 2"), labels, strict=True)
    ]
    figure.legend(handles, labels, loc="outside lower center", ncols=2, title=KEY)
    return figure


@styled
def harmonics_page(rows: Sequence[tuple[str, Sequence[Harmonic]]]) -> Figure:
    """Draw the amplitude of every harmonic of the residual, a line for each capture with its name."""
    highest = max(len(harmonics) for _, harmonics in rows)
    amplitude_um = np.full((len(rows), highest), np.nan)
    for row, (_, harmonics) in enumerate(rows):
        amplitude_um[row, : len(harmonics)] = [UM_PER_MM * each.amplitude_mm for each in harmonics]
    figure = sheet(HARMONIC_IN * len(rows) + 1.6)
    axes = figure.subplots()
    axes.imshow(amplitude_um, aspect="auto", cmap="Blues", vmin=0.0)
    axes.set_xticks(np.arange(highest), [str(order) for order in range(1, highest + 1)])
    axes.set_yticks(np.arange(len(rows)), [label for label, _ in rows])
    axes.grid(visible=False)
    axes.set_xlabel("order (periods per turn)")
    axes.set_title("Amplitude of the residual's harmonics, µm (circle, feed in mm/min, direction)", fontsize=10)
    largest = float(np.nanmax(amplitude_um))
    for colour, chosen in (("white", amplitude_um > 0.6 * largest), (TEXT_COLOUR, amplitude_um <= 0.6 * largest)):
        cells = np.argwhere(chosen & (amplitude_um > 0.0))
        said = [_three_digits(value) for value in amplitude_um[tuple(cells.T)].tolist()]
        Labels(axes, cells[:, ::-1], said, color=colour)
    return figure


def _three_digits(value: float) -> str:
    return f"{value:.0f}" if value >= 10.0 else f"{value:.1f}" if value >= 1.0 else f"{value:.2f}"


def draw_predictor(axes: Axes, predictor: Predictor, width: int = TITLE_WIDTH) -> None:
    """Draw one predictor, its name and share above in lines of `width` characters."""
    axes.axhline(0.0, color=NOMINAL_COLOUR, linewidth=0.6)
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
        inside(axes.legend(loc="best", handlelength=1.2, labelspacing=0.2))
    title = textwrap.fill(f"{predictor.variable}: {100.0 * predictor.share:.0f}\u00a0%", width)
    if predictor.is_bystander:
        title += "\n(goes with the likely cause)"
    axes.set_title(title, color=QUIET_COLOUR if predictor.is_bystander else TEXT_COLOUR)
    if classes:
        names = dict(predictor.classes)
        ticks = sorted({float(each) for means in predictor.profiles for each in means.centre})
        axes.set_xticks(ticks, [names.get(tick, f"{tick:g}") for tick in ticks])
        axes.margins(x=0.2)
    else:
        axes.set_xlabel(predictor.unit, labelpad=1)
        low, high = axes.get_xlim()
        axes.set_xticks([tick for tick in axes.get_xticks() if low <= tick <= high])
    low, high = axes.get_ylim()
    axes.set_yticks([tick for tick in axes.get_yticks() if low <= tick <= high])
    all_inside(axes)


def draw_both_directions(
    axes: Axes, circle: CircleComparison, size_in: tuple[float, float], meant: Sequence[str]
) -> None:
    """Draw the common and the reversing part of a circle's residual; the panel's size, inches, is for the marks."""
    both = circle.both_directions
    assert both is not None  # circles that have both directions are drawn
    angle_deg = np.degrees(both.angle_rad)
    axes.axhline(0.0, color=NOMINAL_COLOUR, linewidth=0.6)
    for values_mm, colour, label in (
        (both.half_sum_mm, COMMON_COLOUR, "common part"),
        (both.half_difference_mm, REVERSING_COLOUR, "reversing part"),
    ):
        axes.plot(angle_deg, UM_PER_MM * values_mm, color=colour, label=label)
    axes.set_title(f"circle {circle.circle.id}, {circle.feed_mm_min:g} mm/min: {UM_PER_MM * circle.rms_mm:.2f} µm RMS")
    against_angle(axes)
    all_inside(axes)
    mark_reversals(axes, circle.reversals, size_in, meant)


def _broken(centre: FloatArray, mean_um: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the points with a nan wherever a line should not be drawn."""
    step = np.diff(centre)
    far = np.flatnonzero(step > GAP * np.median(step)) + 1 if len(step) > 2 else np.zeros(0, np.intp)
    return np.insert(centre, far, np.nan), np.insert(mean_um, far, np.nan)
