"""How far a circle stays from what stops it: slider travel, slider gaps, the bar's angle in its cups, singular poses.

Bar: a cup holds its ball from one side, so the bar may leave the plane across the cup's axis by a limited angle only (a
220 degree arc of a common bar goes 20 degrees beyond that plane, and supports stand in the way soon after). Both ends
count: at the tool cup against the base's xy plane, at the centre ball against the platform's.

Singular poses: with u the unit vector of a leg from slider to platform joint, r = R Q the joint's lever arm and d the
guideway, the leg's fixed length gives (d.u) ds = u.v + (r x u).w (thesis 2.6, differentiated). The condition of the six
rows [u, (r x u)/LEVER] / (d.u) says how unequally slider motion becomes platform motion.
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
from hexdbb.trajectory.runs import FEED_IN_MM

Floats = NDArray[np.float64]

ANGLES = 72
"""Places on a circle at which it is looked at."""
FEW = 6
"""Of these every sixth is enough for the condition, which changes slowly along a circle."""


@dataclass(frozen=True)
class Clearances:
    """The least clearances of one circle, and of the way in from where the bar is mounted."""

    to_end_of_travel_mm: float
    to_min_gap_mm: float
    bar_angle_deg: float
    """Largest angle of the bar, at the cup or at the platform's ball."""
    condition: float
    """Largest condition of the machine's own Jacobian along the circle, a turn counted at `LEVER_MM`."""


@dataclass(frozen=True)
class Demands:
    """What a circle must keep to be proposed."""

    to_end_of_travel_mm: float = 5.0
    to_min_gap_mm: float = 5.0
    bar_angle_deg: float = 25.0
    condition: float = 16.5
    """As the worst of the shipped plan `standard` on the shipped machine, 16.3."""

    def met_by(self, found: Clearances) -> bool:
        """Say whether a circle keeps all of them."""
        return (
            found.to_end_of_travel_mm >= self.to_end_of_travel_mm
            and found.to_min_gap_mm >= self.to_min_gap_mm
            and found.bar_angle_deg <= self.bar_angle_deg
            and found.condition <= self.condition
        )


def circle_clearances(machine: MachineFile, circle: Circle, cup_mm: tuple[float, float, float]) -> Clearances | None:
    """Find the clearances of a circle; None where the machine cannot follow it.

    The way in counts at every angle, as one may feed in at any: near the end of the legs' reach it takes half a
    millimetre outwards to bring two sliders together.
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
    few = slice(None, None, FEW)
    return Clearances(
        to_end_of_travel_mm=float(min(sliders_mm.min() - low_mm, high_mm - sliders_mm.max())),
        to_min_gap_mm=float((sliders_mm[:, 1::2] - sliders_mm[:, 0::2]).min() - machine.sliders.min_gap_mm),
        bar_angle_deg=float(np.degrees(np.arcsin(min(out_of_plane, 1.0)))),
        condition=pose_condition(machine, position_mm[few], rotation, sliders_mm[few]),
    )


def pose_condition(machine: MachineFile, position_mm: Floats, rotation: Floats, sliders_mm: Floats) -> float:
    """Largest condition of the machine's own Jacobian over some poses of one orientation.

    Parameters
    ----------
    machine : MachineFile
    position_mm : ndarray, shape (n, 3)
    rotation : ndarray, shape (3, 3)
    sliders_mm : ndarray, shape (n, 6)
        The poses' slider coordinates.
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
