"""Straightness errors of guideways: they displace the joints of both sliders across the guideway.

Model: a bow is a circular arc through the ends of travel with a given height at mid-span; a dent is a Gaussian dip.
Directions are local to the guideway: lateral x (outward from the base centre), vertical z.
Assumption: the carriage does not tilt on a curved guideway; the joint centre is displaced like the carriage's centre.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import ClassVar, Literal

import numpy as np

from hexdbb.files.validation import NotNegative, Number, Positive
from hexdbb.machine import MachineFile
from hexdbb.rig.geometry import Array, rotation_z
from hexdbb.rig.mechanisms.base import Guideway, Mechanism, MechanismTable, Momentary, Motion, Push

Profile = Callable[[Motion, Array], Array]
"""Displacement, mm, shape (n,), of the joint of a slider at positions of shape (n,), mm, during a motion."""


class GuidewayTable(MechanismTable):
    """A mechanism of one guideway."""

    guideway: Guideway


def across(guideway: int, lateral: Profile, vertical: Profile) -> Mechanism:
    """Return a mechanism that displaces the joints of both sliders of `guideway` (1 to 3) across it."""
    x_base = rotation_z(2.0 * math.pi / 3.0 * (guideway - 1))[:, 0]
    z_base = np.array([0.0, 0.0, 1.0])

    def action(motion: Motion, push: Push) -> None:
        for k in (2 * guideway - 2, 2 * guideway - 1):
            at_mm = motion.drive_mm[:, k] + push.slider_mm[:, k]
            push.slider_joint_mm[:, k] += lateral(motion, at_mm)[:, None] * x_base
            push.slider_joint_mm[:, k] += vertical(motion, at_mm)[:, None] * z_base

    return Momentary(action)


def arc(height_mm: float, ends_mm: tuple[float, float]) -> Callable[[Array], Array]:
    """Return the height of a circular arc above its chord as a function of position; 0 at both ends."""
    low, high = ends_mm
    half = (high - low) / 2.0
    if height_mm == 0.0:
        return np.zeros_like
    radius = (half**2 + height_mm**2) / (2.0 * height_mm)

    def height(at_mm: Array) -> Array:
        square = (at_mm - low - half) ** 2
        # sqrt(radius^2 - square) - (radius - height) without cancellation.
        inside: Array = height_mm - square / (abs(radius) + np.sqrt(radius**2 - square)) * math.copysign(1.0, radius)
        return inside

    return height


class Straightness(GuidewayTable):
    """A bow of one guideway; heights at mid-span."""

    sizes: ClassVar = ("lateral_um", "vertical_um")
    kind: Literal["straightness"] = "straightness"
    lateral_um: Number = 0.0
    vertical_um: Number = 0.0

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        lateral = arc(self.lateral_um * 1e-3, machine.sliders.guideway_travels_mm[self.guideway - 1])
        vertical = arc(self.vertical_um * 1e-3, machine.sliders.guideway_travels_mm[self.guideway - 1])
        return across(self.guideway, lambda _, at_mm: lateral(at_mm), lambda _, at_mm: vertical(at_mm))


class GuidewayBend(GuidewayTable):
    """A bow of one guideway that grows with time, as by warming on one side; no effect in the catalogue."""

    sizes: ClassVar = ("vertical_um",)
    kind: Literal["guideway_bend"] = "guideway_bend"
    vertical_um: Number
    time_constant_s: Positive = 900.0

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        travel_mm, tau_s = machine.sliders.guideway_travels_mm[self.guideway - 1], self.time_constant_s
        height = arc(self.vertical_um * 1e-3, travel_mm)

        def grown(motion: Motion, at_mm: Array) -> Array:
            bow: Array = -np.expm1(-motion.time_s / tau_s) * height(at_mm)
            return bow

        return across(self.guideway, lambda _, at_mm: np.zeros_like(at_mm), grown)


class Dent(GuidewayTable):
    """A Gaussian dip of one guideway; no effect in the catalogue."""

    sizes: ClassVar = ("depth_um",)
    kind: Literal["dent"] = "dent"
    depth_um: NotNegative
    at_mm: Number
    width_mm: Positive = 4.0
    """Standard deviation of the Gaussian, mm."""

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        depth_mm, place_mm, width_mm = self.depth_um * 1e-3, self.at_mm, self.width_mm

        def dip(_: Motion, at_mm: Array) -> Array:
            depth: Array = -depth_mm * np.exp(-0.5 * ((at_mm - place_mm) / width_mm) ** 2)
            return depth

        return across(self.guideway, lambda _, at_mm: np.zeros_like(at_mm), dip)
