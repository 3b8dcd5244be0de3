"""The two pictures of the page for beginners, drawn from the nominal machine and the engine's prediction."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hexdbb.charts.colours import (
    GRID_COLOUR,
    LINE_COLOUR,
    NOMINAL_COLOUR,
    PREDICTED_COLOURS,
    QUIET_COLOUR,
    TEXT_COLOUR,
)
from hexdbb.kinematics import guideway_ends, inverse, platform_points, slider_points
from hexdbb.machine import MachineFile
from hexdbb.model import new_model
from hexdbb.plan import load_plan
from hexdbb.plots.dial import Dial
from hexdbb.plots.saving import save_figure
from hexdbb.plots.style import styled
from hexdbb.samples import Samples, predict

Floats = NDArray[np.float64]

PLAN = "thesis"
AZIMUTH_RAD, ELEVATION_RAD = np.radians(-65.0), np.radians(24.0)
"""Where the machine is seen from: no leg hides another, and the circle is open."""
BAR_AT_RAD = np.radians(20.0)
PER_LAP = 720
SHOWN_ERROR_MM = 0.04
"""Error in the second and third circle: large for a machine, so that it is seen beside the paper's grain."""
RIM_UM, INNER_UM = 40.0, -80.0
"""Deviation at the rim and in the middle of a circle: the nominal circle lies at two thirds of the radius."""
BAR_COLOUR, LEG_COLOUR, PLATFORM_COLOUR = "#B35900", "#004B76", "#C9D8E4"


def draw_first_look(folder: Path) -> list[Path]:
    """Write both pictures into a folder as PNG; return their paths."""
    figures = {"first-look-machine": machine_figure(), "first-look-circles": circles_figure()}
    return [path for name, figure in figures.items() for path in save_figure(figure, folder / name, (".png",))]


@styled
def machine_figure() -> Figure:
    """Draw the machine on its circle, every part named."""
    plan = load_plan(PLAN)
    circle, cup_mm = plan.circles[0], np.array(plan.mounts[0].cup_mm)
    machine = plan.machine_file()
    around = circle.radius_mm * _unit(np.linspace(0.0, 2.0 * np.pi, 200))
    ball = cup_mm + circle.radius_mm * _unit(np.array([BAR_AT_RAD]))[0]
    position = ball - np.array(circle.ball_offset_mm)
    figure = Figure(figsize=(7.0, 4.6))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set_aspect("equal")
    parts = _draw_machine(axes, machine, position)
    _line(axes, cup_mm + around, color=BAR_COLOUR, linestyle="--", linewidth=1.0, zorder=6)
    _line(axes, np.array([cup_mm, ball]), color=BAR_COLOUR, linewidth=4.0, zorder=7)
    for point, colour in ((cup_mm, TEXT_COLOUR), (ball, BAR_COLOUR)):
        axes.plot(*_seen(point), "o", color=colour, markersize=8, zorder=8)
    words = [
        ("guideway:\none of three rails", parts["guideway"], (30, -18)),
        ("slider: driven along its guideway,\ntwo on each", parts["slider"], (-190, -34)),
        ("leg: fixed length,\na joint at each end", parts["leg"], (-120, 24)),
        ("platform", parts["platform"], (60, -6)),
        ("cup: stays where it is", cup_mm, (-150, 34)),
        ("ball bar: measures the distance of its two ends", 0.5 * (cup_mm + ball), (-20, 40)),
        ("ball: goes round\nwith the platform", ball, (60, 6)),
    ]
    for text, at, offset in words:
        _label(axes, text, at, offset)
    axes.margins(0.12, 0.13)
    return figure


@styled
def circles_figure() -> Figure:
    """Draw the deviation of three machines: without errors, one leg too long, play in one slider."""
    figure = Figure(figsize=(7.0, 2.9))
    size_um = round(1000.0 * SHOWN_ERROR_MM)
    machines = [
        ("No error:\nthe reading never changes", None, 0),
        (f"Leg 1 is {size_um} µm too long:\nthe circle is shifted and oval", "leg_length", 0),
        (f"Slider 4 has {size_um} µm of play:\nthe two ways round differ", "backlash", 3),
    ]
    for place, (title, effect, index) in enumerate(machines):
        axes = figure.add_axes((0.02 + place * 0.33, 0.08, 0.30, 0.72))
        dial = Dial(axes, INNER_UM, RIM_UM)
        angle_rad = np.linspace(0.0, 2.0 * np.pi, PER_LAP, endpoint=False)
        dial.line(np.append(angle_rad, 0.0), np.zeros(PER_LAP + 1), color=NOMINAL_COLOUR, linewidth=0.8)
        for spoke in np.radians(np.arange(0.0, 360.0, 45.0)):
            dial.line([spoke, spoke], [INNER_UM, RIM_UM], color=GRID_COLOUR, linewidth=0.5, zorder=0)
        for direction, readings_um in _readings_um(angle_rad, effect, index).items():
            style = "-" if direction > 0 else "--"
            closed = np.append(readings_um, readings_um[0])
            dial.line(
                direction * np.append(angle_rad, 0.0), closed, color=PREDICTED_COLOURS[direction], linestyle=style
            )
        axes.set_title(title, pad=10.0)
    words = "full line: counter-clockwise; broken: clockwise; grey: the circle as commanded"
    magnification = 1000.0 * load_plan(PLAN).circles[0].radius_mm / -INNER_UM
    figure.text(0.5, 0.02, f"{words}; deviations magnified {magnification:.0f} times", ha="center", color=QUIET_COLOUR)
    return figure


def _readings_um(angle_rad: Floats, effect: str | None, index: int) -> dict[int, Floats]:
    """Return the deviation along the plan's circle by direction, where one value of one effect is not zero."""
    plan = load_plan(PLAN)
    if effect is None:
        return {direction: np.zeros(PER_LAP) for direction in (1, -1)}
    model = new_model(plan.machine_file(), [effect])
    values = np.zeros(len(model.values))
    values[index] = SHOWN_ERROR_MM
    runs = [next(run for run in plan.runs() if run.direction == direction) for direction in (1, -1)]
    samples = Samples.planned(plan.machine_file(), runs, angle_rad, plan.gauge.bar_length_mm)
    reading_mm = predict(samples, model.with_values(values)).reading_mm.reshape(len(runs), PER_LAP)
    return {run.direction: 1000.0 * one for run, one in zip(runs, reading_mm, strict=True)}


def _draw_machine(axes: Axes, machine: MachineFile, position_mm: Floats) -> dict[str, Floats]:
    """Draw guideways, sliders, legs and the level platform; return a place of each kind for its name."""
    sliders_mm, _ = inverse(machine, position_mm[None, :], np.zeros(3))
    feet = slider_points(machine, sliders_mm)[0]
    joints = platform_points(machine) + position_mm
    ends = guideway_ends(machine)
    for rail in ends:
        _line(axes, rail, color=NOMINAL_COLOUR, linewidth=5.0, solid_capstyle="round", zorder=1)
    for foot, joint in zip(feet, joints, strict=True):
        _line(axes, np.array([foot, joint]), color=LEG_COLOUR, linewidth=2.6, zorder=3)
        axes.plot(*_seen(foot), "s", color=LINE_COLOUR, markersize=10, zorder=4)
    triangle = np.array([_seen(each) for each in joints[::2]])
    axes.fill(*triangle.T, facecolor=PLATFORM_COLOUR, edgecolor=LEG_COLOUR, alpha=0.85, zorder=5)
    seen = np.array([_seen(each) for each in feet])
    nearest, leftmost, edge = int(seen[:, 1].argmin()), int(seen[:, 0].argmin()), int(triangle[:, 0].argmax())
    rail = max(ends, key=lambda each: float(_seen(each.mean(axis=0))[0] - _seen(each.mean(axis=0))[1]))
    return {
        "guideway": 0.5 * rail.sum(axis=0),
        "slider": feet[nearest],
        "leg": 0.5 * (feet[leftmost] + joints[leftmost]),
        "platform": 0.7 * joints[::2][edge] + 0.3 * joints.mean(axis=0),
    }


def _label(axes: Axes, text: str, at: Floats, offset_pt: tuple[float, float]) -> None:
    arrow: dict[str, Any] = {"arrowstyle": "-", "color": QUIET_COLOUR, "linewidth": 0.7, "shrinkB": 2.0}
    style: Any = {"textcoords": "offset points", "arrowprops": arrow, "zorder": 9, "fontsize": 9.0}
    axes.annotate(text, tuple(_seen(at)), offset_pt, **style)


def _line(axes: Axes, points: Floats, **style: Any) -> None:
    axes.plot(*np.array([_seen(each) for each in points]).T, **style)


def _seen(point: Floats) -> Floats:
    """Return the place of a point in the picture, mm: parallel projection."""
    x, y, z = point
    right = x * np.cos(AZIMUTH_RAD + np.pi / 2.0) + y * np.sin(AZIMUTH_RAD + np.pi / 2.0)
    away = -x * np.cos(AZIMUTH_RAD) - y * np.sin(AZIMUTH_RAD)
    return np.array([right, z * np.cos(ELEVATION_RAD) + away * np.sin(ELEVATION_RAD)])


def _unit(angle_rad: Floats) -> Floats:
    return np.column_stack([np.cos(angle_rad), np.sin(angle_rad), np.zeros_like(angle_rad)])
