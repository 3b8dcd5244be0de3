"""Legs and joints: thermal growth, compliance, joint centres that do not coincide.

Model of warming: the temperature of a body follows a step of its surroundings as a first-order lag, T(t) = rise (1 -
exp(-t / tau)), and its growth is proportional. The temperature can be recorded.
Model of sag: legs are springs; `plant` computes the equilibrium of the moved mass on the true geometry.
"""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np

from hexdbb.files.validation import NotNegative, Number, Positive, Vector3
from hexdbb.machine import MachineFile
from hexdbb.rig.geometry import Array
from hexdbb.rig.mechanisms.base import Axis, Mechanism, MechanismTable, Momentary, Motion, Push
from hexdbb.rig.mechanisms.transmission import SliderTable


def warmed(motion: Motion, time_constant_s: float) -> Array:
    """Return the share of the temperature rise reached, shape (n,)."""
    share: Array = -np.expm1(-motion.time_s / time_constant_s)
    return share


class LegThermal(MechanismTable):
    """Growth of all legs as the room warms."""

    sizes: ClassVar = ("growth_um",)
    kind: Literal["leg_thermal"] = "leg_thermal"
    growth_um: Number
    """Growth at the end of warming."""
    rise_c: Number = 2.0
    time_constant_s: Positive = 1800.0

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""

        def action(motion: Motion, push: Push) -> None:
            share = warmed(motion, self.time_constant_s)
            push.leg_mm += (self.growth_um * 1e-3 * share)[:, None]
            push.temperature_c += self.rise_c * share

        return Momentary(action)


class ScrewThermal(SliderTable):
    """Growth of one screw from its fixed bearing as it warms."""

    sizes: ClassVar = ("growth_um_m",)
    kind: Literal["screw_thermal"] = "screw_thermal"
    growth_um_m: Number
    """Growth at the end of warming."""
    rise_c: Number = 2.0
    time_constant_s: Positive = 1800.0
    held_at_mm: Number | None = None
    """Slider coordinate of the fixed bearing; the middle of travel if not given."""

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        slider = self.slider - 1
        middle_mm = sum(machine.sliders.travels_mm[slider]) / 2.0
        held_mm = middle_mm if self.held_at_mm is None else self.held_at_mm

        def action(motion: Motion, push: Push) -> None:
            share = warmed(motion, self.time_constant_s)
            push.slider_mm[:, slider] += self.growth_um_m * 1e-6 * share * (motion.drive_mm[:, slider] - held_mm)
            push.temperature_c += self.rise_c * share

        return Momentary(action)


class GravitySag(MechanismTable):
    """Compliance of the legs under the weight of platform and tool, whose mass is in the machine file."""

    sizes: ClassVar = ("compliance_um_n",)
    kind: Literal["gravity_sag"] = "gravity_sag"
    compliance_um_n: NotNegative

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""

        def action(motion: Motion, push: Push) -> None:
            push.compliance_mm_n = push.compliance_mm_n + self.compliance_um_n * 1e-3

        return Momentary(action)


class JointOffset(MechanismTable):
    """Displacement of the platform ball of one leg from the joint centre it should share with its neighbour."""

    sizes: ClassVar = ("offset_um",)
    kind: Literal["joint_offset"] = "joint_offset"
    leg: Axis
    offset_um: Vector3
    """Platform frame."""

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""

        def action(motion: Motion, push: Push) -> None:
            push.platform_joint_mm[:, self.leg - 1] += np.array(self.offset_um) * 1e-3

        return Momentary(action)
