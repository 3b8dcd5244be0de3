"""The legs of the nominal machine at poses: their joints' angles, and how near the machine is to a singular pose.

Condition: with u the unit vector of a leg from slider to platform joint, r = R Q the joint's lever arm and d the
guideway, the leg's fixed length gives (d.u) ds = u.v + (r x u).w (thesis 2.6, differentiated). The condition of the six
rows [u, (r x u) / lever] / (d.u) measures how unequally slider motion becomes platform motion; it is infinite where the
platform can move with locked sliders, and where sliders can move with the platform at rest.
Angles: those that joints can be limited in, as the machine file's `[joints]` names them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.kinematics.points import platform_points, slider_points
from hexdbb.machine import MachineFile

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Legs:
    """The six legs at n poses.

    Attributes
    ----------
    unit : ndarray, shape (n, 6, 3)
        From slider to platform joint, base frame.
    lever_mm : ndarray, shape (n, 6, 3)
        From the platform's reference point to the ball joints, base frame.
    along : ndarray, shape (6, 3)
        Directions of the guideways.
    normal : ndarray, shape (n, 3)
        The platform's z axis.
    """

    unit: Floats
    lever_mm: Floats
    along: Floats
    normal: Floats

    @classmethod
    def at(cls, machine: MachineFile, position_mm: Floats, rotation: Floats, sliders_mm: Floats) -> Legs:
        """Return the legs at poses, shapes (n, 3), (3, 3) or (n, 3, 3) and (n, 6)."""
        rotation = np.broadcast_to(rotation, (len(position_mm), 3, 3))
        lever_mm = np.einsum("nij,kj->nki", rotation, platform_points(machine))
        vector_mm = position_mm[:, None] + lever_mm - slider_points(machine, sliders_mm)
        ends = slider_points(machine, np.array([np.zeros(6), np.ones(6)]))
        return cls(
            vector_mm / np.array(machine.legs.lengths_mm)[:, None], lever_mm, ends[1] - ends[0], rotation[:, :, 2]
        )

    def condition(self, lever_mm: float) -> Floats:
        """Return the condition of the machine's Jacobian, a turn counted at a lever, shape (n,)."""
        motion = np.concatenate([self.unit, np.cross(self.lever_mm, self.unit) / lever_mm], axis=2)
        with np.errstate(divide="ignore", invalid="ignore"):
            rows = motion / np.einsum("nki,ki->nk", self.unit, self.along)[..., None]
        found = np.full(len(rows), np.inf)
        whole = np.isfinite(rows).all(axis=(1, 2))
        found[whole] = np.linalg.cond(rows[whole])
        return found

    def guideway_angle_rad(self) -> Floats:
        """Return the acute angle of each leg and its guideway, shape (n, 6)."""
        found: Floats = np.arccos(np.clip(np.abs(np.einsum("nki,ki->nk", self.unit, self.along)), 0.0, 1.0))
        return found

    def normal_angle_rad(self) -> Floats:
        """Return the angle of each leg and the platform's normal, shape (n, 6)."""
        found: Floats = np.arccos(np.clip(np.einsum("nki,ni->nk", self.unit, self.normal), -1.0, 1.0))
        return found

    def swing_rad(self) -> Floats:
        """Return each pair's lean from the vertical about its guideway, inward positive, shape (n, 6); RSSR angles."""
        inward = np.column_stack([self.along[:, 1], -self.along[:, 0], np.zeros(6)])
        found: Floats = np.arctan2(np.einsum("nki,ki->nk", self.unit, inward), self.unit[..., 2])
        return found

    def to_joint_limit_rad(self, machine: MachineFile) -> Floats:
        """Return the least angle that each leg leaves to the machine file's limits, shape (n, 6); negative beyond."""
        left = np.full(self.unit.shape[:2], np.inf)
        limits = machine.joints
        if limits is None:
            return left
        if limits.leg_to_guideway_min_deg is not None:
            left = np.minimum(left, self.guideway_angle_rad() - np.radians(limits.leg_to_guideway_min_deg))
        if limits.leg_to_normal_max_deg is not None:
            left = np.minimum(left, np.radians(limits.leg_to_normal_max_deg) - self.normal_angle_rad())
        if limits.swing_deg is not None:
            least, largest = np.radians(limits.swing_deg)
            swing = self.swing_rad()
            left = np.minimum(left, np.minimum(swing - least, largest - swing))
        return left
