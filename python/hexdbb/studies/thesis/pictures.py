"""Pictures of the thesis' method: reference contours as small polar plots, and the limit of its linear estimator.

A contour is drawn as a ring: nominal circle in grey, deviation magnified so that the largest in its panel is
`LARGEST_SHARE` of the radius. The magnification differs from panel to panel; the largest deviation is in the centre.
"""

from __future__ import annotations

from typing import cast

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import FuncFormatter

from hexdbb.studies.thesis.contours import Floats, ReferenceContours
from hexdbb.studies.thesis.linearity import ARM_MM, LinearityStudy
from hexdbb.studies.thesis.unknowns import Unknown
from hexdbb.units import shown_factor

PANELS_PER_ROW = 6
LARGEST_SHARE = 0.4
NEGLIGIBLE_UM = 0.05
"""Largest deviation of a contour that is drawn as the nominal circle: half the resolution of the gauge."""
DRAWN_EVERY = 3
"""Samples from one drawn point to the next: 3 deg, finer than a panel resolves."""

LABEL_BACKING = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.8}
EXACT_COLOUR = "#004B76"
LINEAR_COLOUR = "#E69F00"
NOMINAL_COLOUR = "0.6"


def contours_figure(contours: ReferenceContours) -> Figure:
    """Return a figure of reference contours, one panel per error."""
    rows = -(-len(contours.unknowns) // PANELS_PER_ROW)
    figure = Figure(figsize=(9.6, 1.75 * rows + 1.0), layout="constrained")
    panels = figure.subplots(rows, PANELS_PER_ROW, squeeze=False, subplot_kw={"projection": "polar"}).flat
    for index, each in enumerate(contours.unknowns):
        axes = cast(PolarAxes, panels[index])
        _draw_contour(axes, contours, index)
        axes.set_title(f"{each.name}, {_size(each)}", fontsize=9, pad=6)
    for axes in panels[len(contours.unknowns) :]:
        axes.set_axis_off()
    figure.suptitle(
        f"Radial deviation of unit errors, {contours.test.origin}\n"
        "each panel at its own magnification, its largest deviation in the centre; 0° to the right, counter-clockwise",
        fontsize=11,
    )
    handles = [
        Line2D([], [], color=NOMINAL_COLOUR, linewidth=0.8, label="nominal circle"),
        Line2D([], [], color=EXACT_COLOUR, linewidth=2.4, label="exact kinematics"),
        Line2D([], [], color=LINEAR_COLOUR, linewidth=1.0, linestyle="--", label="first order"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=9, frameon=False)
    return figure


def linearity_figure(study: LinearityStudy) -> Figure:
    """Return a figure of the error of both estimators against the size of the given errors."""
    figure = Figure(figsize=(7.2, 4.6), layout="constrained")
    axes = figure.subplots()
    size_um = [1e3 * row.size_mm for row in study.rows]
    linear = [1e3 * row.linear_rms_mm for row in study.rows]
    exact = [1e3 * row.exact_rms_mm for row in study.rows]
    axes.loglog(
        size_um,
        linear,
        "o-",
        color=LINEAR_COLOUR,
        markersize=9,
        linewidth=3.0,
        label="linear on reference contours (5.10)",
    )
    axes.loglog(
        size_um,
        exact,
        "s-",
        color=EXACT_COLOUR,
        markersize=4,
        linewidth=1.4,
        label="hexdbb's diagnosis, exact kinematics",
    )
    neglected = [1e3 * study.curvature_per_mm * row.size_mm**2 for row in study.rows]
    axes.loglog(size_um, neglected, ":", color="0.3", label="second-order terms neglected by the linear estimator")
    axes.axvline(1e3 * study.break_mm, color="0.6", linewidth=0.9)
    axes.annotate(
        f"{1e3 * study.break_mm:.0f} µm: as large as\nthe error from the noise",
        (1e3 * study.break_mm, 0.02),
        xytext=(-6, 0),
        textcoords="offset points",
        fontsize=8,
        ha="right",
    )
    axes.set_ylim(bottom=0.01)
    axes.set_xlabel(f"size of the seven given errors, µm (rotations at {ARM_MM:g} mm)")
    axes.set_ylabel("RMS error of the identified values, µm")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.grid(which="major", color="0.88", linewidth=0.6)
    axes.legend(fontsize=8, frameon=False, loc="upper left")
    return figure


def _draw_contour(axes: PolarAxes, contours: ReferenceContours, index: int) -> None:
    exact_um, linear_um = 1e3 * contours.exact_mm[:, index], 1e3 * contours.first_order_mm[:, index]
    largest_um = float(np.abs(exact_um).max())
    turn = np.linspace(0.0, 2.0 * np.pi, 121)
    axes.plot(turn, np.ones_like(turn), color=NOMINAL_COLOUR, linewidth=0.8)
    if largest_um >= NEGLIGIBLE_UM:
        share = LARGEST_SHARE / largest_um
        axes.plot(*_ring(contours.test.angle_rad, share * exact_um), color=EXACT_COLOUR, linewidth=2.4)
        axes.plot(*_ring(contours.test.angle_rad, share * linear_um), "--", color=LINEAR_COLOUR, linewidth=1.0)
    label = f"{largest_um:.1f} µm" if largest_um >= NEGLIGIBLE_UM else f"below\n{NEGLIGIBLE_UM:g} µm"
    axes.text(0.0, 0.0, label, fontsize=8, ha="center", va="center", bbox=LABEL_BACKING)
    axes.set_ylim(0.0, 1.0 + LARGEST_SHARE + 0.05)
    axes.set_yticks([])
    axes.set_xticks(np.radians(np.arange(0, 360, 90)), [""] * 4)
    axes.grid(color="0.9", linewidth=0.5)
    axes.spines["polar"].set_visible(False)


def _ring(angle_rad: Floats, deviation: Floats) -> tuple[Floats, Floats]:
    """Return the closed line of a contour, sorted by angle."""
    order = np.argsort(angle_rad)[::DRAWN_EVERY]
    order = np.append(order, order[0])
    return angle_rad[order], 1.0 + deviation[order]


def _size(unknown: Unknown) -> str:
    if unknown.unit == "rad":
        return f"{np.degrees(unknown.unit_size):g}°"
    return f"{unknown.unit_size * shown_factor(unknown.unit):g} µm"
