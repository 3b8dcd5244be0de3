"""A machine to scale, in 3D and in plan view, and maps of its workspace: condition, and what is left to its limits."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle as Ring
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from hexdbb.charts.colours import COMMON_COLOUR, LINE_COLOUR, NOMINAL_COLOUR, PREDICTED_COLOURS, QUIET_COLOUR
from hexdbb.kinematics import guideway_ends, inverse, platform_points, slider_points
from hexdbb.machine import MachineFile, Workspace
from hexdbb.plots.style import sheet, styled
from hexdbb.workspace import LevelMap

Floats = NDArray[np.float64]

HEIGHT_IN = 7.8
PLATFORM_COLOUR, LEG_COLOUR, WORKSPACE_COLOUR = PREDICTED_COLOURS[1], QUIET_COLOUR, COMMON_COLOUR
BEST, WORST = 3.0, 50.0
"""Range of the condition's colours: from the best that such machines have to where a pose counts as near-singular."""
LABELLED = (5, 10, 16, 30, 50)
"""Lines of equal condition that are drawn."""
NAME_BESIDE_MM, NUMBER_BESIDE_MM = 95.0, 38.0
"""Distance of a guideway's name and of a slider's number from the guideway, for an inradius of 250 mm."""


@styled
def machine_figure(machine: MachineFile, workspace: Workspace, level: LevelMap) -> Figure:
    """Draw a machine with its platform level in the middle of its workspace, and two maps of that workspace.

    Parameters
    ----------
    machine : MachineFile
        Its middle of the workspace must be within reach.
    workspace : Workspace
    level : LevelMap
        From `hexdbb.workspace.level_map`.
    """
    figure = sheet(HEIGHT_IN)
    x, y, z = workspace.centre_mm
    figure.suptitle(f"{machine.name}, to scale, mm; platform level at x {x:g}, y {y:g}, z {z:g}")
    grid = figure.add_gridspec(2, 2, height_ratios=(1.1, 1.0))
    stand = _Stand(machine, workspace)
    _draw_in_space(figure.add_subplot(grid[0, 0], projection="3d"), stand)
    _draw_from_above(figure.add_subplot(grid[0, 1]), stand)
    condition, margin = figure.add_subplot(grid[1, 0]), figure.add_subplot(grid[1, 1])
    _draw_map(condition, level, np.clip(level.condition, None, WORST), LogNorm(BEST, WORST), "viridis_r", workspace)
    _label_condition(condition, level)
    condition.set_title("condition, platform level (small is good)")
    largest = float(np.nanmax(level.margin_mm, initial=1.0))
    _draw_map(margin, level, level.margin_mm, Normalize(0.0, largest), "cividis", workspace)
    margin.set_title("mm left to end of travel or smallest gap")
    return figure


class _Stand:
    """Points of the machine in the middle of its workspace."""

    def __init__(self, machine: MachineFile, workspace: Workspace) -> None:
        self.machine, self.workspace = machine, workspace
        self.centre_mm = np.array(workspace.centre_mm)
        sliders_mm, _ = inverse(machine, self.centre_mm[None], np.zeros(3))
        self.sliders = slider_points(machine, sliders_mm)[0]
        self.joints = platform_points(machine) + self.centre_mm
        self.guideways = guideway_ends(machine)
        angle = np.array(machine.base.guideway_angles_rad)
        self.outward = np.column_stack([np.cos(angle), np.sin(angle)])

    def ring(self, height_mm: float) -> Floats:
        """Return the workspace's edge at a height from its middle, shape (n, 3)."""
        angle = np.linspace(0.0, 2.0 * np.pi, 73)
        edge = self.workspace.radius_mm * np.column_stack([np.cos(angle), np.sin(angle)])
        ring: Floats = self.centre_mm + np.column_stack([edge, np.full(len(angle), height_mm)])
        return ring


def _draw_in_space(axes: Any, stand: _Stand) -> None:
    for ends in stand.guideways:
        axes.plot(*ends.T, color=LINE_COLOUR, linewidth=2.2)
    for slider, joint in zip(stand.sliders, stand.joints, strict=True):
        axes.plot(*np.array([slider, joint]).T, color=LEG_COLOUR, linewidth=1.6)
    axes.plot(*stand.sliders.T, "s", color=LINE_COLOUR, markersize=4)
    plate = stand.joints[[0, 2, 4, 0]]
    axes.plot(*plate.T, color=PLATFORM_COLOUR, linewidth=1.6)
    axes.plot_trisurf(*stand.joints[::2].T, color=PLATFORM_COLOUR, alpha=0.35)
    half_mm = 0.5 * stand.workspace.height_mm
    for height in (-half_mm, half_mm) if half_mm else (0.0,):
        axes.plot(*stand.ring(height).T, color=WORKSPACE_COLOUR, linewidth=1.2)
    for number, slider in enumerate(stand.sliders, start=1):
        axes.text(*slider, f" {number}", fontsize=8)
    every = np.vstack([stand.guideways.reshape(-1, 3), stand.joints, stand.ring(half_mm)])
    low, high = every.min(axis=0), every.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=1.1)
    axes.set(xlabel="x", ylabel="y", zlabel="z")
    axes.view_init(elev=24.0, azim=-58.0)
    axes.locator_params(nbins=4)
    axes.set_title("sliders 1 to 6; green: workspace")


def _draw_from_above(axes: Axes, stand: _Stand) -> None:
    machine = stand.machine
    scale = machine.base.inradius_mm / 250.0
    reach = scale * NAME_BESIDE_MM
    for number, ends in enumerate(stand.guideways, start=1):
        axes.plot(*ends[:, :2].T, color=LINE_COLOUR, linewidth=2.2)
        middle = ends[:, :2].mean(axis=0)
        outward = stand.outward[number - 1]
        axes.annotate(
            f"guideway {number}, {machine.base.guideway_angles_deg[number - 1]:g}°",
            middle + reach * outward,
            ha="center",
            va="center",
            rotation=_upright(ends),
        )
    for slider, joint in zip(stand.sliders, stand.joints, strict=True):
        axes.plot(*np.array([slider, joint])[:, :2].T, color=LEG_COLOUR, linewidth=1.4)
    axes.plot(*stand.sliders[:, :2].T, "s", color=LINE_COLOUR, markersize=4)
    for number, slider in enumerate(stand.sliders, start=1):
        outward = stand.outward[(number - 1) // 2]
        axes.annotate(str(number), slider[:2] + scale * NUMBER_BESIDE_MM * outward, ha="center", va="center")
    axes.add_patch(Polygon(stand.joints[::2, :2], color=PLATFORM_COLOUR, alpha=0.35))
    axes.add_patch(_edge(stand.workspace))
    axes.plot(0.0, 0.0, "+", color=NOMINAL_COLOUR)
    axes.set_aspect("equal")
    named = np.vstack([*stand.guideways[:, :, :2], stand.guideways[:, :, :2].mean(axis=1) + reach * stand.outward])
    low, high = named.min(axis=0) - 0.4 * reach, named.max(axis=0) + 0.4 * reach
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    axes.set(xlabel="x, mm", ylabel="y, mm", title="plan view")


def _upright(ends: Floats) -> float:
    """Return the angle of text along a guideway, deg, that is not read upside down."""
    across, up = (ends[1] - ends[0])[:2]
    return float((np.degrees(np.arctan2(up, across)) + 90.0) % 180.0 - 90.0)


def _edge(workspace: Workspace) -> Ring:
    x, y, _ = workspace.centre_mm
    return Ring((x, y), workspace.radius_mm, fill=False, color=WORKSPACE_COLOUR, linewidth=1.6)


def _draw_map(axes: Axes, level: LevelMap, values: Floats, norm: Normalize, colours: str, workspace: Workspace) -> None:
    mesh = axes.pcolormesh(level.x_mm, level.y_mm, values, norm=norm, cmap=colours, shading="nearest", rasterized=True)
    axes.set_facecolor("#EFEFEF")
    axes.add_patch(_edge(workspace))
    axes.grid(False)
    axes.set_aspect("equal")
    axes.set(xlabel="x, mm (grey: out of reach)", ylabel="y, mm")
    bar = axes.figure.colorbar(mesh, ax=axes, location="bottom", fraction=0.05, pad=0.02, shrink=0.75)
    if isinstance(norm, LogNorm):
        bar.set_ticks(list(LABELLED), labels=[str(each) for each in LABELLED])
        bar.minorticks_off()


def _label_condition(axes: Axes, level: LevelMap) -> None:
    known = level.condition[np.isfinite(level.condition)]
    lines = [each for each in LABELLED if len(known) and known.min() < each < known.max()]
    if lines:
        drawn = axes.contour(level.x_mm, level.y_mm, level.condition, lines, colors="#FFFFFF", linewidths=0.8)
        axes.clabel(drawn, fmt="%g", fontsize=8)
