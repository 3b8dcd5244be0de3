"""One held-out circle before and after compensation, as polar plots at two magnifications of the deviation."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes
from tests.truth.closing import CircleError

BEFORE_COLOUR, AFTER_COLOUR, NOMINAL_COLOUR = "#E69F00", "#004B76", "0.35"
FINER = 10
"""Ratio of the divisions of the two plots."""


def draw(before: CircleError, after: CircleError, title: str, path: Path) -> None:
    """Write a PNG: a circle before and after at one scale, and beside it after alone at a finer one."""
    with mpl.rc_context({"svg.hashsalt": "hexdbb", "font.size": 9}):
        figure = Figure(figsize=(9.6, 5.0), layout="constrained")
        figure.suptitle(title, fontsize=10)
        largest_um = float(np.abs(before.radial_um).max())
        division_um = _round(largest_um / 2.0)
        left, right = figure.subplots(1, 2, subplot_kw={"projection": "polar"})
        _grid(left, division_um)
        _curve(left, before, BEFORE_COLOUR, f"nominal targets, RMS {before.rms_um:.1f} µm")
        _curve(left, after, AFTER_COLOUR, f"compensated, RMS {after.rms_um:.2f} µm")
        _grid(right, division_um / FINER)
        _curve(right, after, AFTER_COLOUR, "compensated, with the gauge's noise of 0.5 µm")
        for axes in (left, right):
            axes.legend(loc="lower center", bbox_to_anchor=(0.5, -0.22), frameon=False)
        figure.savefig(path, dpi=110)


def _round(value: float) -> float:
    """Return the next 1, 2 or 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= value))


def _grid(axes: PolarAxes, division_um: float) -> None:
    ticks = [division_um * step for step in (-2, -1, 0, 1, 2)]
    axes.set_ylim(-4.0 * division_um, 2.5 * division_um)
    axes.set_yticks(ticks, [""] * len(ticks))
    axes.tick_params(axis="x", labelsize=7)
    axes.grid(color="0.85", linewidth=0.6)
    axes.spines["polar"].set_visible(False)
    turn = np.linspace(0.0, 2.0 * np.pi, 361)
    axes.plot(turn, np.zeros_like(turn), color=NOMINAL_COLOUR, linewidth=1.0)
    for tick in ticks:
        label = f"{tick:+g}" if tick else "0 µm"
        backing = {"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.6}
        axes.text(np.radians(67.5), tick, label, fontsize=7, ha="center", va="center", bbox=backing)


def _curve(axes: PolarAxes, error: CircleError, colour: str, label: str) -> None:
    """Draw counter-clockwise samples, then clockwise ones: two turns."""
    axes.plot(error.angle_rad, error.radial_um, color=colour, linewidth=0.9, label=label)
