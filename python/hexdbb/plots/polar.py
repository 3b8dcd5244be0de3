"""One polar plot: the nominal circle, measured and predicted paths of both directions, magnified deviations.

The radial axis is the deviation in micrometres; its origin is the deviation `Scale.centre_um`, so that the nominal
circle (deviation 0) has its true radius at the stated magnification. The set-up's centre offset, as measured (least
squares, both directions together), is removed from the measured **and** the predicted paths, so that a difference
between the two stays visible.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.lines import Line2D
from matplotlib.projections.polar import PolarAxes

from hexdbb.charts.colours import GRID_COLOUR, MEASURED_COLOURS, NOMINAL_COLOUR, PREDICTED_COLOURS
from hexdbb.charts.lines import curve, drawn_paths
from hexdbb.charts.magnification import Scale
from hexdbb.comparison import CircleComparison
from hexdbb.comparison.circles import DIRECTION_NAMES
from hexdbb.comparison.iso230 import FULL_TURN_RAD

GRID_LABEL_ANGLE_DEG = 67.5


def draw_polar(axes: PolarAxes, circle: CircleComparison, scale: Scale, fine: bool) -> None:
    """Draw one circle at one feed.

    Parameters
    ----------
    axes : PolarAxes
        Empty axes of projection ``polar``.
    circle : CircleComparison
        What to draw.
    scale : Scale
        Magnification and division.
    fine : bool
        A large plot with labelled grid; otherwise a small one of many, its labels left out.
    """
    _draw_grid(axes, scale, fine)
    for direction, measured, predicted in drawn_paths(circle):
        axes.plot(*curve(measured), **_measured_style(direction, fine), zorder=3)
        axes.plot(*curve(predicted), **_predicted_style(direction, fine), zorder=4)


def legend_handles() -> list[Artist]:
    """Return one legend entry for each line of a polar plot."""
    handles: list[Artist] = []
    for direction, name in DIRECTION_NAMES.items():
        handles.append(Line2D([], [], **_measured_style(direction, fine=True), label=f"measured, {name}"))
        handles.append(Line2D([], [], **_predicted_style(direction, fine=True), label=f"predicted, {name}"))
    handles.append(Line2D([], [], color=NOMINAL_COLOUR, linewidth=1.0, label="nominal circle"))
    return handles


def _measured_style(direction: int, fine: bool) -> dict[str, Any]:
    """Broad below narrow, so that both directions are seen where they coincide."""
    return {"color": MEASURED_COLOURS[direction], "linewidth": {1: 4.0, -1: 1.8}[direction] * (1.0 if fine else 0.7)}


def _predicted_style(direction: int, fine: bool) -> dict[str, Any]:
    """Dashes of one direction in the gaps of the other's."""
    dashes = ({1: 0.0, -1: 4.0}[direction], (4.0, 4.0))
    return {"color": PREDICTED_COLOURS[direction], "linewidth": 1.1 if fine else 0.8, "linestyle": dashes}


def _draw_grid(axes: PolarAxes, scale: Scale, fine: bool) -> None:
    ticks_um = [scale.division_um * step for step in range(-scale.divisions, scale.divisions + 1)]
    axes.set_ylim(scale.centre_um, ticks_um[-1] + 0.25 * scale.division_um)
    axes.set_yticks(ticks_um, [""] * len(ticks_um))
    axes.set_xticks(np.radians(np.arange(0, 360, 45 if fine else 90)))
    axes.tick_params(axis="x", labelsize=8 if fine else 6, pad=2 if fine else -2)
    if fine:
        _label_grid(axes, ticks_um)
    axes.grid(color=GRID_COLOUR, linewidth=0.6)
    axes.spines["polar"].set_visible(False)
    turn = np.linspace(0.0, FULL_TURN_RAD, 361)
    axes.plot(turn, np.zeros_like(turn), color=NOMINAL_COLOUR, linewidth=1.0 if fine else 0.6, zorder=2)


def _label_grid(axes: PolarAxes, ticks_um: list[float]) -> None:
    """Label the divisions as text of its own, because tick labels would be hidden under the paths."""
    backing = {"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.6}
    for tick_um in ticks_um:
        label = f"{tick_um:+g}" if tick_um else "0 µm"
        angle_rad = np.radians(GRID_LABEL_ANGLE_DEG)
        axes.text(angle_rad, tick_um, label, fontsize=7, ha="center", va="center", bbox=backing, zorder=6)
