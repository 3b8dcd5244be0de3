"""Clearances of a circle: to the ends of slider travel, between sliders, bar angle in the cups, singular poses.

Bar: a cup holds its ball from one side, so the bar may leave the plane across the cup's axis by a limited angle only (a
220 degree arc of a common bar goes 20 degrees beyond that plane, and supports stand in the way soon after). Both ends
count: at the tool cup against the base's xy plane, at the centre ball against the platform's.

Singular poses: the condition of `hexdbb.kinematics.legs`. Joints: the limits of the machine file, where it has them.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb.identifiability.redundancy import LEVER_MM
from hexdbb.kinematics import inverse, rotation_from_rpy
from hexdbb.kinematics.legs import Legs
from hexdbb.kinematics.margins import NearestEnd, NearestSliders, nearest_end, nearest_sliders
from hexdbb.machine import MachineFile
from hexdbb.plan import Circle
from hexdbb.trajectory.extent import FEED_IN_MM

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

ANGLES = 72
"""Angles of a circle at which clearances are computed: every 5 deg. Between two of them the path bulges by
R (1 - cos 2.5 deg), 0.1 mm for a circle of 100 mm, far less than the clearances required."""
ANGLES_RAD: Floats = np.arange(ANGLES, dtype=np.float64) * (2.0 * np.pi / ANGLES)
CONDITION_EVERY = 6
"""Every sixth of these angles, 30 deg apart, is used for the condition, which changes slowly along a circle."""


@dataclass(frozen=True)
class Clearances:
    """Smallest clearances of one circle, feed-in included."""

    to_end_of_travel_mm: float
    to_min_gap_mm: float
    bar_angle_deg: float
    """Largest angle of the bar, at the cup or at the platform's ball."""
    condition: float
    """Largest condition of the machine's own Jacobian along the circle, a turn counted at `LEVER_MM`."""
    to_joint_limit_deg: float = np.inf
    """Least angle left to a limit of the joints; infinite where the machine file has none."""
    nearest: NearestSliders | None = None
    """Which two sliders come nearest, how near, and at which of the circle's angles."""
    nearest_end: NearestEnd | None = None
    """Which slider comes nearest to an end of its travel."""


@dataclass(frozen=True)
class RequiredClearances:
    """Clearances that a proposed circle must keep."""

    to_end_of_travel_mm: float = 5.0
    """Margin for a misplaced cup and for compensation, which may move a slider by 1 mm."""
    to_min_gap_mm: float = 5.0
    """As for the ends of travel."""
    bar_angle_deg: float = 25.0
    """Slightly beyond the 20 deg of the 220 deg arcs that common bars measure; depends on cup and supports
    (`--bar-angle`)."""
    condition: float = 16.5
    """Just above the worst circle of the shipped plan `standard` on the shipped machine, 16.3."""

    def met_by(self, found: Clearances | CirclePath) -> bool:
        """Return whether a circle keeps all of them; those that take least time are asked first."""
        return (
            found.bar_angle_deg <= self.bar_angle_deg
            and found.to_end_of_travel_mm >= self.to_end_of_travel_mm
            and found.to_min_gap_mm >= self.to_min_gap_mm
            and found.to_joint_limit_deg >= 0.0
            and found.condition <= self.condition
        )


@dataclass(frozen=True)
class CirclePath:
    """Poses of the nominal machine along a circle, each clearance computed when it is first asked for.

    The feed-in counts at every angle, because it may start at any: near the end of the legs' reach half a millimetre
    outwards brings two sliders together.

    Parameters
    ----------
    machine : MachineFile
    circle : Circle
    cup_mm : tuple of float
        Nominal cup centre, base frame, mm.
    """

    machine: MachineFile
    circle: Circle
    cup_mm: tuple[float, float, float]

    @cached_property
    def is_reached(self) -> bool:
        """Whether the machine can follow the circle."""
        return not self._inverse[1].any()

    @cached_property
    def bar_angle_deg(self) -> float:
        """Largest angle of the bar, at the cup or at the platform's ball."""
        bar = (self.circle.ball_mm(ANGLES_RAD, self.cup_mm) - np.asarray(self.cup_mm)) / self.circle.radius_mm
        out_of_plane = max(float(np.abs(bar[:, 2]).max()), float(np.abs(bar @ self._rotation[:, 2]).max()))
        return float(np.degrees(np.arcsin(min(out_of_plane, 1.0))))

    @cached_property
    def to_end_of_travel_mm(self) -> float:
        """Least distance to an end of travel; negative and infinite where the circle cannot be followed."""
        return self.nearest_end.left_mm if self.is_reached else -np.inf

    @cached_property
    def to_min_gap_mm(self) -> float:
        """Least distance beyond the smallest gap between two sliders."""
        return self.nearest.distance_mm - self.machine.sliders.min_gap_mm

    @cached_property
    def nearest_end(self) -> NearestEnd:
        """Which slider comes nearest to an end of its travel."""
        return nearest_end(self.machine, self._inverse[0])

    @cached_property
    def nearest(self) -> NearestSliders:
        """Which two sliders come nearest."""
        return nearest_sliders(self._inverse[0])

    @cached_property
    def to_joint_limit_deg(self) -> float:
        """Least angle left to a limit of the joints; infinite where there is none."""
        if self.machine.joints is None:
            return np.inf
        legs = Legs.at(self.machine, self._position_mm, self._rotation, self._inverse[0])
        return float(np.degrees(legs.to_joint_limit_rad(self.machine).min()))

    @cached_property
    def condition(self) -> float:
        """Largest condition of the machine's own Jacobian."""
        few = slice(None, None, CONDITION_EVERY)
        return pose_condition(self.machine, self._position_mm[few], self._rotation, self._inverse[0][few])

    @cached_property
    def _rotation(self) -> Floats:
        return rotation_from_rpy(self.circle.platform_rpy_rad)

    @cached_property
    def _position_mm(self) -> Floats:
        outside = self.circle.model_copy(update={"radius_mm": self.circle.radius_mm + FEED_IN_MM})
        return np.vstack([each.poses(ANGLES_RAD, self.cup_mm) for each in (self.circle, outside)])

    @cached_property
    def _inverse(self) -> tuple[Floats, Ints]:
        return inverse(self.machine, self._position_mm, self.circle.platform_rpy_rad)


def circle_clearances(machine: MachineFile, circle: Circle, cup_mm: tuple[float, float, float]) -> Clearances | None:
    """Compute the clearances of a circle; None where the machine cannot follow it. Parameters as of `CirclePath`."""
    path = CirclePath(machine, circle, cup_mm)
    if not path.is_reached:
        return None
    return Clearances(**{each.name: getattr(path, each.name) for each in fields(Clearances)})


def angle_of_row(row: int) -> float:
    """Return the angle of the circle, deg, of a row of what `circle_clearances` looks at."""
    return 360.0 / ANGLES * (row % ANGLES)


def pose_condition(machine: MachineFile, position_mm: Floats, rotation: Floats, sliders_mm: Floats) -> float:
    """Return the largest condition of the machine's own Jacobian over poses of one orientation.

    Parameters
    ----------
    machine : MachineFile
    position_mm : ndarray, shape (n, 3)
        Platform positions, base frame, mm.
    rotation : ndarray, shape (3, 3)
        Platform orientation.
    sliders_mm : ndarray, shape (n, 6)
        Slider coordinates of these poses, mm.
    """
    return float(Legs.at(machine, position_mm, rotation, sliders_mm).condition(LEVER_MM).max())
