"""Whether a wanted workspace is within reach, which of its keys is too large, and a workspace where none is wanted."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from hexdbb.errors import InputError
from hexdbb.files.validation import format_value
from hexdbb.machine import MachineFile, Workspace, home_heights_mm
from hexdbb.workspace.assessment import Assessment, assess
from hexdbb.workspace.poses import Poses, workspace_poses

HALVINGS = 12
"""Bisections of what is reached of a size: to a four-thousandth of what is wanted."""
RADII_MM = (100.0, 50.0)
"""Radii tried where no workspace is wanted: lengths of common ball bars, the usual one first."""
TILTS_DEG = (12.0, 6.0, 0.0)
"""Tilts tried where no workspace is wanted; the first is that of the plan `standard`."""
HEIGHT_STEPS = 24
"""Heights tried between those of the machine's home."""


def require_reach(machine: MachineFile, workspace: Workspace, origin: str) -> None:
    """Check that a machine reaches its whole workspace.

    Parameters
    ----------
    machine : MachineFile
    workspace : Workspace
    origin : str
        Name of the file, for the message.

    Raises
    ------
    InputError
        One line naming the key that is too large, its value and the largest that is reached.
    """
    point = workspace.model_copy(update={"radius_mm": 1e-6, "height_mm": 0.0, "tilt_deg": 0.0})
    if not _is_reached(machine, point):
        x, y, z = workspace.centre_mm
        raise InputError(
            f"{origin}: workspace.centre_mm: {format_value([x, y, z])} (expected a place that the level platform"
            f" reaches: {_heights_words(machine, x, y)})"
        )
    # One after another, so that the first that is too large is named: what comes later is still left out.
    for key, what in (
        ("tilt_deg", "at its centre"),
        ("height_mm", "about its centre, tilted as wanted"),
        ("radius_mm", "with the height and tilt wanted"),
    ):
        wanted = getattr(workspace, key)
        grown = point.model_copy(update={key: wanted})
        if not _is_reached(machine, grown):
            largest = _largest(partial(_is_reached_in_part, machine, point, key, wanted))
            raise InputError(
                f"{origin}: workspace.{key}: {format_value(wanted)} (expected at most"
                f" {_down(largest * wanted):.1f}: more is out of reach {what})"
            )
        point = grown


def suggested_workspace(machine: MachineFile) -> Workspace:
    """Return a workspace for a machine whose file has none: a disc over the base centre that a ball bar's circle fills.

    Of the radii and tilts that are reached, and if possible nowhere near a limit, the largest; of the heights the one
    where the condition of the machine's Jacobian stays best.

    Raises
    ------
    InputError
        Not even the smallest disc is reached.
    """
    low_mm, high_mm = (each - machine.platform.joint_plane_height_mm for each in home_heights_mm(machine))
    heights = np.linspace(low_mm, high_mm, HEIGHT_STEPS + 2)[1:-1]
    near_limits: list[Assessment] = []
    for radius_mm in RADII_MM:
        for tilt_deg in TILTS_DEG:
            discs = [
                Workspace(centre_mm=(0.0, 0.0, round(float(z), 0)), radius_mm=radius_mm, tilt_deg=tilt_deg)
                for z in heights
            ]
            found = [assess(machine, each) for each in discs if _is_reached(machine, each)]
            best = min(found, key=lambda each: (len(each.findings), each.condition), default=None)
            if best is not None and not best.findings:
                return best.workspace
            near_limits += [best] if best is not None else []
    if near_limits:
        return near_limits[0].workspace
    raise InputError(
        f"{machine.path or machine.name}: legs.length_mm: {format_value(machine.legs.length_mm)} (expected a machine"
        f" that reaches a level circle of {RADII_MM[-1]:g} mm over its base centre; its home is {low_mm:.0f} to"
        f" {high_mm:.0f} mm high)"
    )


def _is_reached_in_part(machine: MachineFile, point: Workspace, key: str, wanted: float, part: float) -> bool:
    return _is_reached(machine, point.model_copy(update={key: part * wanted}))


def _is_reached(machine: MachineFile, workspace: Workspace) -> bool:
    return bool(workspace_poses(machine, workspace).reached.all())


def _largest(is_reached: Callable[[float], bool]) -> float:
    """Return the largest part, 0 to 1, that is reached, where 0 is."""
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_reached(max(middle, 1e-9)) else (low, middle)
    return low


def _down(value: float) -> float:
    """Round down to what is shown, so that the value shown is reached."""
    return math.floor(10.0 * value) / 10.0


def _heights_words(machine: MachineFile, x_mm: float, y_mm: float) -> str:
    """Return at which heights the level platform reaches a place in plan view."""
    most_mm = max(machine.legs.lengths_mm)
    z_mm = np.arange(0.0, most_mm, 1.0) - machine.platform.joint_plane_height_mm
    places = np.column_stack([np.full_like(z_mm, x_mm), np.full_like(z_mm, y_mm), z_mm])
    reached = z_mm[Poses.of(machine, places, np.zeros_like(places)).reached]
    if not len(reached):
        return f"it reaches none above x {x_mm:g}, y {y_mm:g}"
    return f"above x {x_mm:g}, y {y_mm:g} it reaches z = {reached.min():.0f} to {reached.max():.0f}"
