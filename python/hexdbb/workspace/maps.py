"""A horizontal slice through the reach of a machine with its platform level, for pictures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.identifiability.redundancy import LEVER_MM
from hexdbb.kinematics.legs import Legs
from hexdbb.machine import MachineFile, Workspace
from hexdbb.workspace.poses import Poses

Floats = NDArray[np.float64]

PLACES = 91
"""Places along a side of the slice: a picture of 80 mm shows no finer."""
BEYOND = 2.0
"""Half side of the slice, in radii of the workspace: what lies around it is seen."""


@dataclass(frozen=True)
class LevelMap:
    """A slice: places along its sides (m,), and of each place, shape (m, m), rows along y; nan out of reach.

    `margin_mm` is the least of what is left to an end of travel and to the smallest gap of two sliders.
    """

    x_mm: Floats
    y_mm: Floats
    condition: Floats
    margin_mm: Floats


def level_map(machine: MachineFile, workspace: Workspace) -> LevelMap:
    """Compute the slice through the middle of a workspace."""
    centre = np.array(workspace.centre_mm)
    side = np.linspace(-BEYOND, BEYOND, PLACES) * workspace.radius_mm
    x_mm, y_mm = centre[0] + side, centre[1] + side
    across, up = np.meshgrid(x_mm, y_mm)
    places = np.column_stack([across.ravel(), up.ravel(), np.full(across.size, centre[2])])
    every = Poses.of(machine, places, np.zeros_like(places))
    poses = every.some(every.reached)
    condition, margin = np.full(len(every), np.nan), np.full(len(every), np.nan)
    if len(poses):
        legs = Legs.at(machine, poses.position_mm, poses.rotation, poses.sliders_mm)
        condition[every.reached] = legs.condition(LEVER_MM)
        travels_mm = np.array(machine.sliders.travels_mm)
        to_end = np.minimum(poses.sliders_mm - travels_mm[:, 0], travels_mm[:, 1] - poses.sliders_mm).min(axis=1)
        gaps = poses.sliders_mm[:, 1::2] - poses.sliders_mm[:, 0::2] - machine.sliders.min_gap_mm
        margin[every.reached] = np.minimum(to_end, gaps.min(axis=1))
    return LevelMap(x_mm, y_mm, condition.reshape(across.shape), margin.reshape(across.shape))
