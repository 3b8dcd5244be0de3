"""One polar plot: the nominal circle, measured and predicted paths of both directions, magnified deviations.

The radial axis is the deviation in micrometres; its origin is the deviation `Scale.centre_um`, so that the nominal
circle (deviation 0) has its true radius at the stated magnification. The set-up's centre offset, as measured (least
squares, both directions together), is removed from the measured **and** the predicted paths, so that a difference
between the two stays visible.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patheffects import Normal, Stroke
from numpy.typing import NDArray

from hexdbb.charts.colours import (
    GRID_COLOUR,
    MEASURED_COLOURS,
    NOMINAL_COLOUR,
    PAPER_COLOUR,
    PREDICTED_COLOURS,
    TEXT_COLOUR,
)
from hexdbb.charts.lines import curve, drawn_paths
from hexdbb.charts.magnification import Scale
from hexdbb.comparison import CircleComparison
from hexdbb.comparison.circles import DIRECTION_NAMES
from hexdbb.comparison.iso230 import FULL_TURN_RAD
from hexdbb.plots.dial import Dial
from hexdbb.plots.marks import mark_reversals_around

GRID_LABEL_ANGLE_DEG = 67.5
DRAWN_TURN_RAD = np.linspace(0.0, FULL_TURN_RAD, 181)
"""Angles of the grid's circles: steps of 2 deg, straight between them within 0.02 % of the radius."""
BESIDE = 1.16
"""Half of a large plot's width over its radius: "180°" is read beside it."""
DASH_PT = 3.5
MOST_LABELS = 7
"""Divisions, nominal circle and both sides, of which each is labelled."""


def draw_polar(axes: Axes, circle: CircleComparison, scale: Scale, fine: bool, meant: Sequence[str] = ()) -> Dial:
    """Draw one circle at one feed.

    Parameters
    ----------
    axes : Axes
        Empty.
    circle : CircleComparison
        What to draw.
    scale : Scale
        Magnification and division.
    fine : bool
        A large plot with labelled grid; otherwise a small one of many, its labels left out.
    meant : sequence of str
        Sliders (``slider 4``) whose reversals are marked in bold.
    """
    dial = Dial(axes, scale.centre_um, (scale.divisions + 0.25) * scale.division_um, beside=BESIDE if fine else 1.0)
    _draw_grid(dial, scale, fine)
    mark_reversals_around(dial, circle.reversals, meant, named=fine)
    for direction, measured, predicted in drawn_paths(circle):
        dial.line(*curve(measured), **_measured_style(direction, fine), zorder=3)
        dial.line(*curve(predicted), **_predicted_style(direction, fine), zorder=4)
    return dial


def legend_handles() -> list[Artist]:
    """Return one legend entry for each line of a polar plot."""
    handles: list[Artist] = []
    for direction, name in DIRECTION_NAMES.items():
        handles.append(Line2D([], [], **_measured_style(direction, fine=True), label=f"measured, {name}"))
        handles.append(Line2D([], [], **_predicted_style(direction, fine=True), label=f"predicted, {name}"))
    handles.append(Line2D([], [], color=NOMINAL_COLOUR, linewidth=1.0, label="nominal circle"))
    handles.append(
        Line2D([], [], color=NOMINAL_COLOUR, linewidth=0.8, linestyle=":", label="a slider reverses (its number)")
    )
    return handles


def _measured_style(direction: int, fine: bool) -> dict[str, Any]:
    """Broad below narrow, so that both directions are seen where they coincide."""
    return {"color": MEASURED_COLOURS[direction], "linewidth": {1: 4.0, -1: 1.8}[direction] * (1.0 if fine else 0.7)}


def _predicted_style(direction: int, fine: bool) -> dict[str, Any]:
    """Dashes of one direction in the gaps of the other's, edged with paper to be seen on the measured band."""
    width = 1.2 if fine else 0.9
    dash = DASH_PT / width
    return {
        "color": PREDICTED_COLOURS[direction],
        "linewidth": width,
        "linestyle": ({1: 0.0, -1: dash}[direction], (dash, dash)),
        "dash_capstyle": "butt",
        "path_effects": [Stroke(linewidth=width + 0.9, foreground=PAPER_COLOUR), Normal()],
    }


def _draw_grid(dial: Dial, scale: Scale, fine: bool) -> None:
    ticks_um = [scale.division_um * step for step in range(-scale.divisions, scale.divisions + 1)]
    angles_deg = np.arange(0, 360, 45 if fine else 90)
    rings = [np.column_stack([DRAWN_TURN_RAD, np.full_like(DRAWN_TURN_RAD, tick_um)]) for tick_um in ticks_um]
    spokes = [np.array([[angle, dial.centre], [angle, dial.rim]]) for angle in np.radians(angles_deg)]
    dial.lines([*rings, *spokes], colors=GRID_COLOUR, linewidths=0.6, zorder=1.0)
    dial.line(DRAWN_TURN_RAD, 0.0 * DRAWN_TURN_RAD, color=NOMINAL_COLOUR, linewidth=0.9, zorder=2)
    _label_angles(dial, angles_deg if fine else angles_deg[:1])
    if fine:
        _label_grid(dial, ticks_um)


def _label_angles(dial: Dial, angles_deg: NDArray[np.integer]) -> None:
    """Label angles outside the rim, those of one side together."""
    sides: dict[tuple[str, str], list[int]] = {}
    for angle_deg in angles_deg.tolist():
        across, up = round(np.cos(np.radians(angle_deg)), 6), round(np.sin(np.radians(angle_deg)), 6)
        side = "left" if across > 0.0 else "right" if across < 0.0 else "center"
        level = "bottom" if up > 0.0 else "top" if up < 0.0 else "center"
        sides.setdefault((side, level), []).append(angle_deg)
    for (side, level), some in sides.items():
        said = [f"{angle_deg}°" for angle_deg in some]
        dial.labels(np.radians(some), dial.rim, said, ha=side, va=level, color=TEXT_COLOUR)


def _label_grid(dial: Dial, ticks_um: list[float]) -> None:
    """Label the divisions on top of the paths, which would hide them."""
    # Divisions of a fine grid are labelled in turn: the labels would cover one another.
    shown = ticks_um[len(ticks_um) // 2 % 2 :: 2] if len(ticks_um) > MOST_LABELS else ticks_um
    said = [f"{tick_um:+g}" if tick_um else "0 µm" for tick_um in shown]
    dial.labels(np.radians(GRID_LABEL_ANGLE_DEG), shown, said, color=TEXT_COLOUR, backing=0.75)
