"""The panels beside a polar plot: the residual against angle and the table of ISO 230-4 quantities."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.transforms import Bbox

from hexdbb.charts.colours import MEASURED_COLOURS, PREDICTED_COLOURS
from hexdbb.charts.lines import curve, quantity_rows, residual_path, smoothed
from hexdbb.comparison import UM_PER_MM, CircleComparison
from hexdbb.comparison.circles import DIRECTION_NAMES
from hexdbb.plots.marks import mark_reversals

SMOOTHED_WIDTHS = {1: 2.4, -1: 1.0}
"""Broad below narrow, so that both directions are seen where they coincide."""


def draw_residual(axes: Axes, circle: CircleComparison, meant: Sequence[str] = ()) -> None:
    """Draw measured minus predicted reading (µm) against commanded polar angle, per direction.

    In light the mean of the laps at every angle, in dark its mean over arcs of `SMOOTHED_OVER_DEG`. Reversals of
    sliders are marked, those `meant` (``slider 4``) in bold.
    """
    axes.axhline(0.0, color="0.35", linewidth=0.8, zorder=1)
    for part in circle.directions:
        residual = residual_path(part)
        angle, residual_um = curve(residual)
        axes.plot(np.degrees(angle), residual_um, color=MEASURED_COLOURS[part.direction], linewidth=0.5, alpha=0.6)
        axes.plot(
            *smoothed(residual),
            color=PREDICTED_COLOURS[part.direction],
            linewidth=SMOOTHED_WIDTHS[part.direction],
            zorder=4,
            label=f"{DIRECTION_NAMES[part.direction]}, RMS {UM_PER_MM * part.rms_mm:.2f} µm",
        )
    axes.set_xlim(0.0, 360.0)
    axes.set_xticks(np.arange(0, 361, 45))
    axes.set_xlabel("commanded polar angle, deg", fontsize=8)
    axes.set_ylabel("measured - predicted, µm", fontsize=8)
    axes.tick_params(labelsize=8)
    axes.grid(color="0.88", linewidth=0.6)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, fontsize=8, frameon=False)
    mark_reversals(axes, circle.reversals, meant)


def draw_quantities(axes: Axes, circle: CircleComparison) -> None:
    """Write the ISO 230-4 quantities, measured and predicted, as a table."""
    axes.set_axis_off()
    rows = list(quantity_rows(circle))
    table = axes.table(
        cellText=[[_text(measured), _text(predicted)] for _, measured, predicted in rows],
        rowLabels=[f"  {label}  " for label, _, _ in rows],
        colLabels=["measured, µm", "predicted, µm"],
        cellLoc="right",
        rowLoc="left",
        bbox=Bbox.from_bounds(0.2, 0.0, 0.8, 1.0),
    )
    table.auto_set_font_size(False)
    table.set_fontsize(8)
    for cell in table.get_celld().values():
        cell.set_linewidth(0.4)
        cell.set_edgecolor("0.8")


def _text(value_mm: float | None) -> str:
    return "-" if value_mm is None else f"{round(UM_PER_MM * value_mm, 2) + 0.0:.2f}"
