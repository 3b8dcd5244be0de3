"""Where the sliders must be told to go for the platform to take poses: what a table of targets is computed with.

`NominalTargets` is the machine as it should be: inverse kinematics in closed form. A controller that compensates is
another (`hexdbb.compensation`). Poses come in order of motion, a row a cycle, because what a slider must be told
may depend on the side it comes from.
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
    sliders_mm : (n, 6)
    refused : the first row that has no targets and why, in words; None where all have
    first_side : (6,) side from which each slider is taken to come at the first row, -1 to 1
    """

    sliders_mm: Array
    refused: tuple[int, str] | None
    first_side: Array


class Targets(Protocol):
    """From poses to slider targets and back."""

    def sliders(
        self,
        position_mm: Array,
        rpy_rad: Array,
        cycle_s: float,
        before: Array | None = None,
        after: Array | None = None,
    ) -> TargetRows:
        """Give the targets of poses (n, 3), (n, 3), one per cycle; the machine is at rest before and after them.

        `before` and `after` (6,) are the sides from which each slider comes at the first row and at whatever follows
        the last one; None: those of the first and of the last motion.
        """
        ...

    def pose(self, sliders_mm: Array) -> tuple[Poses, str | None]:
        """Give the pose (1, 3), (1, 3) whose targets are these (6,), and in words why there is none."""
        ...


@dataclass(frozen=True)
class NominalTargets:
    """Targets of the nominal machine."""

    machine: MachineFile

    def sliders(
        self,
        position_mm: Array,
        rpy_rad: Array,
        cycle_s: float,
        before: Array | None = None,
        after: Array | None = None,
    ) -> TargetRows:
        """See `Targets.sliders`; from which side a slider comes is all the same."""
        sliders_mm, status = inverse(self.machine, position_mm, rpy_rad)
        return TargetRows(sliders_mm, first_refused(status), np.zeros(6))

    def pose(self, sliders_mm: Array) -> tuple[Poses, str | None]:
        """See `Targets.pose`."""
        position_mm, rotation, status = forward(self.machine, sliders_mm[None, :])
        pose = (position_mm, rpy_from_rotation(rotation[0])[None, :])
        return pose, f"{status_name(int(status[0]))} (expected a pose of the nominal machine)" if status[0] else None


def first_refused(status: NDArray[np.integer]) -> tuple[int, str] | None:
    """Give the first row whose status (n,) is not ok, and what was expected."""
    failed = np.flatnonzero(status)
    if not failed.size:
        return None
    row = int(failed[0])
    return row, f"{status_name(int(status[row]))} (expected every pose within reach and travel)"
