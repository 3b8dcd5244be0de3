"""The residual circle by circle: as it is, or before and after something was added to the model."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hexdbb.charts.colours import MEASURED_COLOURS, NOMINAL_COLOUR, PREDICTED_COLOURS
from hexdbb.charts.lines import residual_path, smoothed
from hexdbb.comparison import UM_PER_MM, CircleComparison
from hexdbb.comparison.circles import DIRECTION_NAMES, compare_circles
from hexdbb.comparison.iso230 import FloatArray
from hexdbb.plots.marks import KEY, mark_reversals
from hexdbb.plots.panels import against_angle
from hexdbb.plots.style import all_inside, sheet, styled
from hexdbb.samples import Samples

COLUMNS = 2
PANEL_IN = (3.4, 1.0)
"""Width and height of a panel without its labels, inches, about."""
ROW_IN = 1.45
MOST_PANELS = 14
"""Circles and feeds drawn: seven rows are what a sheet has room for."""


@styled
def residual_figure(
    samples: Samples,
    residual_mm: FloatArray,
    after_mm: FloatArray | None = None,
    title: str = "",
    meant: Sequence[str] = (),
) -> Figure:
    """Draw a residual against the commanded polar angle, a panel for each circle and feed, the largest first.

    Of more than `MOST_PANELS` the smallest are left out, which is stated.

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
    ranked = sorted(zip(before, after, strict=True), key=lambda each: -each[0].rms_mm)
    panels, left_out = ranked[:MOST_PANELS], len(ranked[MOST_PANELS:])
    rows = -(-len(panels) // COLUMNS)
    figure = sheet(ROW_IN * rows + 1.5)
    grid = figure.subplots(rows, COLUMNS, squeeze=False)
    for axes, (one, other) in zip(grid.flat, panels, strict=False):
        _draw(axes, one, None if after_mm is None else other, several=len({each.record_name for each in before}) > 1)
        mark_reversals(axes, one.reversals, PANEL_IN, meant)
    for axes in grid.flat[len(panels) :]:
        axes.set_axis_off()
    for row in grid:
        row[0].set_ylabel("residual, µm")
    smaller = f"; {left_out} smaller ones not drawn" if left_out else ""
    figure.suptitle(f"{title}\nmeasured - predicted, against the commanded polar angle, deg; means of 3 deg{smaller}")
    figure.legend(handles=_legend(after_mm is not None), loc="outside lower center", ncols=2, title=KEY)
    return figure


def _draw(axes: Axes, before: CircleComparison, after: CircleComparison | None, several: bool) -> None:
    axes.axhline(0.0, color=NOMINAL_COLOUR, linewidth=0.6, zorder=1)
    for part in before.directions:
        colours = PREDICTED_COLOURS if after is None else MEASURED_COLOURS
        axes.plot(*smoothed(residual_path(part)), color=colours[part.direction], zorder=2)
    for part in () if after is None else after.directions:
        axes.plot(*smoothed(residual_path(part)), color=PREDICTED_COLOURS[part.direction], zorder=3)
    fall = f"{UM_PER_MM * before.rms_mm:.2f} µm RMS"
    if after is not None:
        fall = f"{UM_PER_MM * before.rms_mm:.2f} → {UM_PER_MM * after.rms_mm:.2f} µm RMS"
    record = f"{before.record_name}, " if several else ""
    axes.set_title(f"{record}circle {before.circle.id}, {before.feed_mm_min:g} mm/min: {fall}")
    against_angle(axes)
    all_inside(axes)


def _legend(has_after: bool) -> list[Line2D]:
    if not has_after:
        return [Line2D([], [], color=PREDICTED_COLOURS[each], label=name) for each, name in DIRECTION_NAMES.items()]
    return [
        Line2D([], [], color=colours[each], label=f"{name}, {when}")
        for colours, when in ((MEASURED_COLOURS, "before"), (PREDICTED_COLOURS, "after"))
        for each, name in DIRECTION_NAMES.items()
    ]
