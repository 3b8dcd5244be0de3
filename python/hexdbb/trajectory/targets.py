"""Mapping of platform poses to slider targets, as a table of targets needs it.

`NominalTargets` is the nominal machine: inverse kinematics in closed form. A compensating controller is another
(`hexdbb.compensation`). Poses come in order of motion, one row per cycle, because a compensated target may depend on
the direction of travel.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hexdbb.kinematics import forward, inverse, rpy_from_rotation, status_name
from hexdbb.machine import MachineFile
from hexdbb.trajectory.poses import Array, Poses


@dataclass(frozen=True)
class TargetRows:
    """Slider targets of poses in order of motion.

    Attributes
    ----------
    sliders_mm : (n, 6) targets, mm
    refused : first row without a target and the reason in words; None where every row has one
    first_travel : (6,) assumed direction of travel of each slider at the first row, -1 to 1
    """

    sliders_mm: Array
    refused: tuple[int, str] | None
    first_travel: Array


class Targets(Protocol):
    """Mapping of poses to slider targets and back."""

    def sliders(
        self,
        position_mm: Array,
        rpy_rad: Array,
        cycle_s: float,
        before: Array | None = None,
        after: Array | None = None,
    ) -> TargetRows:
        """Compute the targets of poses, one per cycle; the machine is at rest before and after them.

        Parameters
        ----------
        position_mm, rpy_rad : ndarray, shape (n, 3)
            Platform reference point, mm, and roll, pitch, yaw, rad.
        cycle_s : float
            Time between two rows, s.
        before, after : ndarray, shape (6,), optional
            Directions of travel of the sliders at the first row and after the last one; default: those of the first
            and of the last motion.
        """
        ...

    def pose(self, sliders_mm: Array) -> tuple[Poses, str | None]:
        """Return the pose (1, 3) mm, (1, 3) rad with these targets (6,), and the reason where there is none."""
        ...


@dataclass(frozen=True)
class NominalTargets:
    """Slider targets of the nominal machine."""

    machine: MachineFile

    def sliders(
        self,
        position_mm: Array,
        rpy_rad: Array,
        cycle_s: float,
        before: Array | None = None,
        after: Array | None = None,
    ) -> TargetRows:
        """See `Targets.sliders`; the directions of travel make no difference."""
        sliders_mm, status = inverse(self.machine, position_mm, rpy_rad)
        return TargetRows(sliders_mm, first_refused(status), np.zeros(6))

    def pose(self, sliders_mm: Array) -> tuple[Poses, str | None]:
        """See `Targets.pose`."""
        position_mm, rotation, status = forward(self.machine, sliders_mm[None, :])
        pose = (position_mm, rpy_from_rotation(rotation[0])[None, :])
        return pose, f"{status_name(int(status[0]))} (expected a pose of the nominal machine)" if status[0] else None


def first_refused(status: NDArray[np.integer]) -> tuple[int, str] | None:
    """Return the first row whose status (n,) is not 0, with the reason in words; None where all are 0."""
    failed = np.flatnonzero(status)
    if not failed.size:
        return None
    row = int(failed[0])
    return row, f"{status_name(int(status[row]))} (expected every pose within reach and travel)"
