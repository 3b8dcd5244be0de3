"""Mapping of platform poses to slider targets, as a table of targets needs it.

`NominalTargets` is the nominal machine: inverse kinematics in closed form. A compensating controller is another
(`hexdbb.compensation`). Poses come in order of motion, one row per cycle, because a compensated target may depend on
the direction of travel; targets are computed for parts of the rows, so that memory does not grow with their number.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hexdbb.kinematics import forward, inverse, rpy_from_rotation, status_name
from hexdbb.machine import MachineFile
from hexdbb.trajectory.poses import Array, Poses

Refused = tuple[int, str] | None
"""First row without a target and the reason in words; None where every row has one."""


class PoseRows(Protocol):
    """Poses in order of motion, computed for any part of their rows.

    Attributes
    ----------
    rows : int
        Number of poses.
    """

    @property
    def rows(self) -> int:
        """Number of poses."""

    def poses(self, first: int, last: int) -> Poses:
        """Compute the poses of rows `first` to `last`, the last one left out."""


@dataclass(frozen=True)
class HeldPoses:
    """Poses in memory: position (n, 3) mm, roll, pitch, yaw (n, 3) rad."""

    position_mm: Array
    rpy_rad: Array

    @property
    def rows(self) -> int:
        """Number of poses."""
        return len(self.position_mm)

    def poses(self, first: int, last: int) -> Poses:
        """Return the poses of rows `first` to `last`."""
        return self.position_mm[first:last], self.rpy_rad[first:last]


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
    refused: Refused
    first_travel: Array


@dataclass(frozen=True)
class TargetParts:
    """Slider targets of poses in order of motion, computed for any part of their rows.

    Attributes
    ----------
    first_travel : (6,) assumed direction of travel of each slider at the first row, -1 to 1
    part : rows `first` to `last` -> targets (n, 6), mm, and the first row of all without one; the result does not
        depend on how the rows are divided
    """

    first_travel: Array
    part: Callable[[int, int], tuple[Array, Refused]]


class Targets(ABC):
    """Mapping of poses to slider targets and back."""

    @abstractmethod
    def along(
        self, poses: PoseRows, cycle_s: float, before: Array | None = None, after: Array | None = None
    ) -> TargetParts:
        """Prepare the targets of poses, one per cycle; the machine is at rest before and after them.

        Parameters
        ----------
        poses : PoseRows
            Platform reference point, mm, and roll, pitch, yaw, rad.
        cycle_s : float
            Time between two rows, s.
        before, after : ndarray, shape (6,), optional
            Directions of travel of the sliders at the first row and after the last one; default: those of the first
            and of the last motion.
        """

    @abstractmethod
    def pose(self, sliders_mm: Array) -> tuple[Poses, str | None]:
        """Return the pose (1, 3) mm, (1, 3) rad with these targets (6,), and the reason where there is none."""

    def sliders(
        self,
        position_mm: Array,
        rpy_rad: Array,
        cycle_s: float,
        before: Array | None = None,
        after: Array | None = None,
    ) -> TargetRows:
        """Compute the targets of poses (n, 3) mm, (n, 3) rad at once; see `along`."""
        parts = self.along(HeldPoses(position_mm, rpy_rad), cycle_s, before, after)
        return TargetRows(*parts.part(0, len(position_mm)), parts.first_travel)


@dataclass(frozen=True)
class NominalTargets(Targets):
    """Slider targets of the nominal machine."""

    machine: MachineFile

    def along(
        self, poses: PoseRows, cycle_s: float, before: Array | None = None, after: Array | None = None
    ) -> TargetParts:
        """See `Targets.along`; the directions of travel make no difference."""

        def part(first: int, last: int) -> tuple[Array, Refused]:
            sliders_mm, status = inverse(self.machine, *poses.poses(first, last))
            refused = first_refused(status)
            return sliders_mm, None if refused is None else (first + refused[0], refused[1])

        return TargetParts(np.zeros(6), part)

    def pose(self, sliders_mm: Array) -> tuple[Poses, str | None]:
        """See `Targets.pose`."""
        position_mm, rotation, status = forward(self.machine, sliders_mm[None, :])
        pose = (position_mm, rpy_from_rotation(rotation[0])[None, :])
        return pose, f"{status_name(int(status[0]))} (expected a pose of the nominal machine)" if status[0] else None


def first_refused(status: NDArray[np.integer]) -> Refused:
    """Return the first row whose status (n,) is not 0, with the reason in words; None where all are 0."""
    failed = np.flatnonzero(status)
    if not failed.size:
        return None
    row = int(failed[0])
    return row, f"{status_name(int(status[row]))} (expected every pose within reach and travel)"
