"""The panels beside a polar plot: the residual against angle and the table of ISO 230-4 quantities."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from hexdbb.charts.colours import MEASURED_COLOURS, NOMINAL_COLOUR, PREDICTED_COLOURS, RULE_COLOUR, TEXT_COLOUR
from hexdbb.charts.lines import curve, quantity_rows, residual_path, smoothed
from hexdbb.comparison import UM_PER_MM, CircleComparison
from hexdbb.comparison.circles import SHORT_DIRECTION_NAMES
from hexdbb.plots.labels import Labels
from hexdbb.plots.marks import mark_reversals
from hexdbb.plots.style import all_inside, inside

SMOOTHED_WIDTHS = {1: 2.4, -1: 1.0}
"""Broad below narrow, so that both directions are seen where they coincide."""


def draw_residual(
    axes: Axes, circle: CircleComparison, size_in: tuple[float, float], meant: Sequence[str] = ()
) -> None:
    """Draw measured minus predicted reading (µm) against commanded polar angle, per direction.

    In light the mean of the laps at every angle, in dark its mean over arcs of `SMOOTHED_OVER_DEG`. Reversals of
    sliders are marked, those `meant` (``slider 4``) in bold; the panel's size, inches, limits how close
    their numbers may be.
    """
    axes.axhline(0.0, color=NOMINAL_COLOUR, linewidth=0.8, zorder=1)
    for part in circle.directions:
        residual = residual_path(part)
        angle, residual_um = curve(residual)
        axes.plot(np.degrees(angle), residual_um, color=MEASURED_COLOURS[part.direction], linewidth=0.5, alpha=0.6)
        axes.plot(
            *smoothed(residual),
            color=PREDICTED_COLOURS[part.direction],
            linewidth=SMOOTHED_WIDTHS[part.direction],
            zorder=4,
            label=f"{SHORT_DIRECTION_NAMES[part.direction]}, RMS {UM_PER_MM * part.rms_mm:.2f} µm",
        )
    against_angle(axes)
    axes.set_xlabel("commanded polar angle, deg")
    axes.set_ylabel("measured - predicted, µm")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, columnspacing=1.0)
    all_inside(axes)
    mark_reversals(axes, circle.reversals, size_in, meant)


def against_angle(axes: Axes) -> None:
    """Let a panel's abscissa be the commanded polar angle, degrees."""
    axes.set_xlim(0.0, 360.0)
    axes.set_xticks(np.arange(0, 361, 90))


def draw_quantities(axes: Axes, circle: CircleComparison) -> None:
    """Write the ISO 230-4 quantities, measured and predicted, as a table."""
    axes.set_axis_off()
    rows = list(quantity_rows(circle))
    lines = len(rows) + 1
    columns = (
        ("", [label for label, _, _ in rows], 0.02, "left"),
        ("measured, µm", [_text(measured) for _, measured, _ in rows], 0.66, "right"),
        ("predicted, µm", [_text(predicted) for _, _, predicted in rows], 0.98, "right"),
    )
    axes.set(xlim=(0.0, 1.0), ylim=(lines, 0.0))
    for name, values, right, side in columns:
        places = [(right, line + 0.5) for line in range(lines)]
        Labels(axes, places, [name, *values], ha=side, color=TEXT_COLOUR)
    rules = [[(0.0, line), (1.0, line)] for line in range(1, lines + 1)]
    drawn = LineCollection(rules, colors=RULE_COLOUR, linewidths=[0.8, *[0.4] * len(rows)])
    axes.add_collection(drawn, autolim=False)
    inside(drawn)


def _text(value_mm: float | None) -> str:
    return "-" if value_mm is None else f"{round(UM_PER_MM * value_mm, 2) + 0.0:.2f}"
