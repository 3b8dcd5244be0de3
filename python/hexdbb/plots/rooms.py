"""Panels at places that are known beforehand: the room that titles and labels take is stated, in inches.

Constrained layout measures every text of a sheet twice to find it, which takes as long as to write half of the sheet;
on sheets that are all alike, with one size of text, it finds the same each time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec
from matplotlib.transforms import ScaledTranslation

from hexdbb.plots.style import SIDE_MARGIN, TITLE_PT

POINTS_PER_IN = 72.0
LINE = 1.2
"""Distance of two lines of text over its size."""
HEAD_MARGIN_IN = 0.04
"""White above and below the title, inches."""
YLABEL_IN, XLABEL_IN = 0.5, 0.26
"""Distance of an axis' label from its panel, inches: beside tick labels of up to six characters, below those of one
line."""


@dataclass(frozen=True)
class Room:
    """Room around each panel for its tick labels, title and labels, inches."""

    left: float = 0.68
    right: float = 0.1
    top: float = 0.3
    bottom: float = 0.25


def titled(figure: Figure, title: str) -> float:
    """Write a title above all panels; return the height that it takes, inches."""
    height_in = figure.get_figheight()
    figure.suptitle(title, y=1.0 - HEAD_MARGIN_IN / height_in, va="top")
    return 2.0 * HEAD_MARGIN_IN + (1 + title.count("\n")) * LINE * TITLE_PT / POINTS_PER_IN


def panels(
    figure: Figure,
    shape: tuple[int, int],
    room: Room,
    head_in: float,
    foot_in: float,
    across: tuple[float, float] = (0.0, 1.0),
    height_ratios: Sequence[float] | None = None,
) -> GridSpec:
    """Return the grid of a sheet's panels.

    Parameters
    ----------
    figure : Figure
        Gets no other layout.
    shape : tuple of int
        Rows and columns.
    room : Room
    head_in, foot_in : float
        Heights of what stands above and below all panels, inches.
    across : tuple of float
        Where the grid begins and ends, as parts of the sheet's width between its margins.
    height_ratios : sequence of float, optional
        Heights of the rows.
    """
    figure.set_layout_engine("none")
    rows, columns = shape
    width_in, height_in = figure.get_size_inches()
    used_in = (1.0 - 2.0 * SIDE_MARGIN) * width_in
    begin_in, end_in = (SIDE_MARGIN * width_in + part * used_in for part in across)
    panel_in = (end_in - begin_in) / columns - room.left - room.right
    row_in = (height_in - head_in - foot_in) / rows - room.top - room.bottom
    return figure.add_gridspec(
        rows,
        columns,
        left=(begin_in + room.left) / width_in,
        right=(end_in - room.right) / width_in,
        top=1.0 - (head_in + room.top) / height_in,
        bottom=(foot_in + room.bottom) / height_in,
        wspace=(room.left + room.right) / panel_in,
        hspace=(room.top + room.bottom) / row_in,
        height_ratios=height_ratios,
    )


def label_at_once(axes: Axes) -> None:
    """Place the labels of both axes without looking where the tick labels end: for panels with `Room` around them."""
    figure: Any = axes.get_figure(root=True)
    for axis, offset_in, place in (
        (axes.yaxis, (-YLABEL_IN, 0.0), (0.0, 0.5)),
        (axes.xaxis, (0.0, -XLABEL_IN), (0.5, 0.0)),
    ):
        away = ScaledTranslation(*offset_in, figure.dpi_scale_trans)
        axis.set_label_coords(*place, transform=axes.transAxes + away)
