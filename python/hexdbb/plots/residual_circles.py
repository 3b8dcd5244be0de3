"""The residual circle by circle: as it is, or before and after something was added to the model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hexdbb.charts.colours import MEASURED_COLOURS, PREDICTED_COLOURS
from hexdbb.charts.lines import residual_path, smoothed
from hexdbb.comparison import UM_PER_MM, CircleComparison
from hexdbb.comparison.circles import DIRECTION_NAMES, compare_circles
from hexdbb.comparison.iso230 import FloatArray
from hexdbb.plots.marks import mark_reversals
from hexdbb.samples import Samples

COLUMNS = 3
PANEL_IN = (4.2, 2.3)
"""Width and height of a panel, inches: twelve reversals have their names above it."""


def residual_figure(
    samples: Samples,
    residual_mm: FloatArray,
    after_mm: FloatArray | None = None,
    title: str = "",
    meant: Sequence[str] = (),
) -> Figure:
    """Draw a residual against the commanded polar angle, a panel for each circle and feed, the largest first.

    Parameters
    ----------
    samples : Samples
    residual_mm : ndarray, shape (n,)
        Measured minus predicted reading.
    after_mm : ndarray, shape (n,), optional
        The same with what was added; dark, the first light.
    title : str
    meant : sequence of str
        Sliders (``slider 4``) whose reversals are marked in bold.
    """
    before = compare_circles(samples, samples.reading_mm - residual_mm)
    after = before if after_mm is None else compare_circles(samples, samples.reading_mm - after_mm)
    panels = sorted(zip(before, after, strict=True), key=lambda each: -each[0].rms_mm)
    rows = -(-len(panels) // COLUMNS)
    figure = Figure(figsize=(COLUMNS * PANEL_IN[0], rows * PANEL_IN[1] + 1.1), layout="constrained")
    grid = figure.subplots(rows, COLUMNS, squeeze=False)
    for axes, (one, other) in zip(grid.flat, panels, strict=False):
        _draw(axes, one, None if after_mm is None else other, several=len({each.record_name for each in before}) > 1)
        mark_reversals(axes, one.reversals, meant)
    for axes in grid.flat[len(panels) :]:
        axes.set_axis_off()
    for row in grid:
        row[0].set_ylabel("measured - predicted, µm", fontsize=8)
    figure.suptitle(
        f"{title}\nagainst the commanded polar angle (deg), means of 3 deg; dotted: a slider reverses", fontsize=11
    )
    figure.legend(handles=_legend(after_mm is not None), loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def _draw(axes: Axes, before: CircleComparison, after: CircleComparison | None, several: bool) -> None:
    axes.axhline(0.0, color="0.6", linewidth=0.6, zorder=1)
    for part in before.directions:
        colours = PREDICTED_COLOURS if after is None else MEASURED_COLOURS
        axes.plot(*smoothed(residual_path(part)), color=colours[part.direction], linewidth=1.1, zorder=2)
    for part in () if after is None else after.directions:
        axes.plot(*smoothed(residual_path(part)), color=PREDICTED_COLOURS[part.direction], linewidth=1.1, zorder=3)
    fall = f"{UM_PER_MM * before.rms_mm:.2f} µm RMS"
    if after is not None:
        fall = f"{UM_PER_MM * before.rms_mm:.2f} µm -> {UM_PER_MM * after.rms_mm:.2f} µm RMS"
    record = f"{before.record_name}, " if several else ""
    axes.set_title(f"{record}circle {before.circle.id}, {before.feed_mm_min:g} mm/min: {fall}", fontsize=8)
    axes.set_xlim(0.0, 360.0)
    axes.set_xticks(np.arange(0, 361, 90))
    axes.tick_params(labelsize=7)
    axes.grid(color="0.92", linewidth=0.5)


def _legend(has_after: bool) -> list[Line2D]:
    if not has_after:
        return [Line2D([], [], color=PREDICTED_COLOURS[each], label=name) for each, name in DIRECTION_NAMES.items()]
    return [
        Line2D([], [], color=colours[each], label=f"{name}, {when}")
        for colours, when in ((MEASURED_COLOURS, "before"), (PREDICTED_COLOURS, "after"))
        for each, name in DIRECTION_NAMES.items()
    ]
