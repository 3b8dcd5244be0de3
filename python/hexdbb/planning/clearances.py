"""Clearances of a circle: to the ends of slider travel, between sliders, bar angle in the cups, singular poses.

Bar: a cup holds its ball from one side, so the bar may leave the plane across the cup's axis by a limited angle only (a
220 degree arc of a common bar goes 20 degrees beyond that plane, and supports stand in the way soon after). Both ends
count: at the tool cup against the base's xy plane, at the centre ball against the platform's.

Singular poses: with u the unit vector of a leg from slider to platform joint, r = R Q the joint's lever arm and d the
guideway, the leg's fixed length gives (d.u) ds = u.v + (r x u).w (thesis 2.6, differentiated). The condition of the six
rows [u, (r x u)/LEVER] / (d.u) measures how unequally slider motion becomes platform motion.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.identifiability.redundancy import LEVER_MM
from hexdbb.kinematics import engine_machine, inverse, rotation_from_rpy
from hexdbb.machine import MachineFile
from hexdbb.plan import Circle
from hexdbb.trajectory.extent import FEED_IN_MM

Floats = NDArray[np.float64]

ANGLES = 72
"""Angles of a circle at which clearances are computed: every 5 deg. Between two of them the path bulges by
R (1 - cos 2.5 deg), 0.1 mm for a circle of 100 mm, far less than the clearances required."""
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

    def met_by(self, found: Clearances) -> bool:
        """Return whether a circle keeps all of them."""
        return (
            found.to_end_of_travel_mm >= self.to_end_of_travel_mm
            and found.to_min_gap_mm >= self.to_min_gap_mm
            and found.bar_angle_deg <= self.bar_angle_deg
            and found.condition <= self.condition
        )


def circle_clearances(machine: MachineFile, circle: Circle, cup_mm: tuple[float, float, float]) -> Clearances | None:
    """Compute the clearances of a circle.

    The feed-in counts at every angle, because it may start at any: near the end of the legs' reach half a millimetre
    outwards brings two sliders together.

    Parameters
    ----------
    machine : MachineFile
    circle : Circle
    cup_mm : tuple of float
        Nominal cup centre, base frame, mm.

    Returns
    -------
    Clearances or None
        None where the machine cannot follow the circle.
    """
    angle_rad = np.arange(ANGLES) * (2.0 * np.pi / ANGLES)
    outside = circle.model_copy(update={"radius_mm": circle.radius_mm + FEED_IN_MM})
    position_mm = np.vstack([each.poses(angle_rad, cup_mm) for each in (circle, outside)])
    sliders_mm, status = inverse(machine, position_mm, circle.platform_rpy_rad)
    if status.any():
        return None
    low_mm, high_mm = machine.sliders.travel_mm
    rotation = rotation_from_rpy(circle.platform_rpy_rad)
    bar = (circle.ball_mm(angle_rad, cup_mm) - np.asarray(cup_mm)) / circle.radius_mm
    out_of_plane = max(float(np.abs(bar[:, 2]).max()), float(np.abs(bar @ rotation[:, 2]).max()))
    few = slice(None, None, CONDITION_EVERY)
    return Clearances(
        to_end_of_travel_mm=float(min(sliders_mm.min() - low_mm, high_mm - sliders_mm.max())),
        to_min_gap_mm=float((sliders_mm[:, 1::2] - sliders_mm[:, 0::2]).min() - machine.sliders.min_gap_mm),
        bar_angle_deg=float(np.degrees(np.arcsin(min(out_of_plane, 1.0)))),
        condition=pose_condition(machine, position_mm[few], rotation, sliders_mm[few]),
    )


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
    engine = engine_machine(machine)
    rows = np.empty((len(position_mm), 6, 6))
    for leg in range(6):
        along = _core.guideway_direction(leg // 2)
        lever_mm = rotation @ _core.platform_joint(engine, leg // 2)
        slider_mm = _core.guideway_vertex(engine, leg // 2) + sliders_mm[:, leg, None] * along
        unit = (position_mm + lever_mm - slider_mm) / machine.legs.length_mm
        motion = np.hstack([unit, np.cross(lever_mm, unit) / LEVER_MM])
        rows[:, leg] = motion / (unit @ along)[:, None]
    return float(np.linalg.cond(rows).max())
