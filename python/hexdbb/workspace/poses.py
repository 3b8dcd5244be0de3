"""The poses at which a workspace is looked at: rings of places at several heights, level and tilted to all sides.

Between two neighbours of the finest ring (radius R, 24 places) the boundary bulges by R (1 - cos 7.5 deg), 0.9 % of R.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.kinematics import inverse, rotation_from_rpy
from hexdbb.machine import MachineFile, Workspace

Floats = NDArray[np.float64]

RINGS = (1.0 / 3.0, 2.0 / 3.0, 1.0)
"""Radii of the rings, of the workspace's; the centre counts besides."""
AZIMUTHS = 24
"""Places on a ring."""
HEIGHTS = 5
"""Heights, both ends included, where the workspace has a height."""
TILT_AZIMUTHS = 12
"""Directions of tilt, where the workspace has a tilt; level counts besides."""


@dataclass(frozen=True)
class Poses:
    """Platform poses, and what the machine's inverse kinematics says of them.

    Attributes
    ----------
    position_mm, rpy_rad : ndarray, shape (n, 3)
    sliders_mm : ndarray, shape (n, 6)
    status : ndarray of int, shape (n,)
        0 where the pose is reached within travel and gap; see `hexdbb.kinematics.status_name`.
    """

    position_mm: Floats
    rpy_rad: Floats
    sliders_mm: Floats
    status: NDArray[np.int32]

    @classmethod
    def of(cls, machine: MachineFile, position_mm: Floats, rpy_rad: Floats) -> Poses:
        """Solve poses, shapes (n, 3)."""
        return cls(position_mm, rpy_rad, *inverse(machine, position_mm, rpy_rad))

    def __len__(self) -> int:
        return len(self.status)

    @property
    def reached(self) -> NDArray[np.bool_]:
        """Which poses are reached, shape (n,)."""
        found: NDArray[np.bool_] = self.status == 0
        return found

    @property
    def rotation(self) -> Floats:
        """Orientations, shape (n, 3, 3)."""
        several, member = np.unique(self.rpy_rad, axis=0, return_inverse=True)
        found: Floats = rotation_from_rpy(several)[member.ravel()]
        return found

    def some(self, rows: NDArray[np.bool_]) -> Poses:
        """Return some of them."""
        return Poses(self.position_mm[rows], self.rpy_rad[rows], self.sliders_mm[rows], self.status[rows])

    def words(self, row: int) -> str:
        """Return a pose for people: ``x 12, y 0, z 280 mm, roll 0, pitch 12, yaw 0 deg``."""
        # Rounded here, because -0.4 would be shown as -0.
        x, y, z = np.round(self.position_mm[row]) + 0.0
        roll, pitch, yaw = np.round(np.degrees(self.rpy_rad[row])) + 0.0
        return f"x {x:.0f}, y {y:.0f}, z {z:.0f} mm, roll {roll:.0f}, pitch {pitch:.0f}, yaw {yaw:.0f} deg"


def workspace_poses(machine: MachineFile, workspace: Workspace) -> Poses:
    """Return the poses at which a workspace is looked at, solved."""
    azimuth = np.arange(AZIMUTHS) * (2.0 * np.pi / AZIMUTHS)
    ring = np.column_stack([np.cos(azimuth), np.sin(azimuth)])
    flat = workspace.radius_mm * np.vstack([[[0.0, 0.0]], *(each * ring for each in RINGS)])
    half_mm = 0.5 * workspace.height_mm
    heights = np.linspace(-half_mm, half_mm, HEIGHTS) if half_mm else np.zeros(1)
    places = np.array([[x, y, z] for z in heights for x, y in flat]) + np.array(workspace.centre_mm)
    side = np.arange(TILT_AZIMUTHS) * (2.0 * np.pi / TILT_AZIMUTHS)
    tilts = np.radians(workspace.tilt_deg) * np.column_stack([np.cos(side), np.sin(side), np.zeros(TILT_AZIMUTHS)])
    turns = np.vstack([np.zeros((1, 3)), *([tilts] if workspace.tilt_deg else [])])
    return Poses.of(machine, np.repeat(places, len(turns), axis=0), np.tile(turns, (len(places), 1)))
