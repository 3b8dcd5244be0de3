"""Errors of the measurement: bar, gauge, ball and cup.

Model: the gauge shows (1 + gain) (true length - nominal length) + drift + pick-up, at a time that may differ from the
encoders'; ball and cup may be displaced in one set-up, or from some time on.
"""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from hexdbb.files.validation import NotNegative, Number, Positive, Vector3
from hexdbb.machine import MachineFile
from hexdbb.rig.mechanisms.base import Mechanism, MechanismTable, Momentary, Motion, Push, Window

Identity = Annotated[int, Field(ge=0)]


class BarDrift(MechanismTable):
    """Linear drift of the reading with time since power-on."""

    sizes: ClassVar = ("rate_um_min",)
    kind: Literal["bar_drift"] = "bar_drift"
    rate_um_min: Number

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""

        def action(motion: Motion, push: Push) -> None:
            push.reading_mm += self.rate_um_min * 1e-3 / 60.0 * motion.time_s

        return Momentary(action)


class BarGain(MechanismTable):
    """Scale error of the gauge."""

    sizes: ClassVar = ("error_percent",)
    kind: Literal["bar_gain"] = "bar_gain"
    error_percent: Number

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""

        def action(motion: Motion, push: Push) -> None:
            push.gain += self.error_percent * 1e-2

        return Momentary(action)


class SampleDelay(MechanismTable):
    """Delay of the gauge reading relative to the encoders (negative: the gauge shows an old value)."""

    sizes: ClassVar = ("delay_ms",)
    kind: Literal["sample_delay"] = "sample_delay"
    delay_ms: Number

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""

        def action(motion: Motion, push: Push) -> None:
            push.delay_s += self.delay_ms * 1e-3

        return Momentary(action)


class BallEccentricity(MechanismTable):
    """Displacement of the ball in one mount or on one circle.

    The bus does not carry the circle: on the bus, use the mount.
    """

    sizes: ClassVar = ("offset_um",)
    kind: Literal["ball_eccentricity"] = "ball_eccentricity"
    offset_um: Vector3
    """Platform frame."""
    mount: Identity | None = None
    circle: Identity | None = None

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""

        def action(motion: Motion, push: Push) -> None:
            if self.mount in (None, motion.mount) and self.circle in (None, motion.circle):
                push.ball_mm += np.array(self.offset_um) * 1e-3

        return Momentary(action)


class MainsPickup(MechanismTable):
    """Pick-up of the mains frequency in the gauge signal, aliased by sampling; no effect in the catalogue."""

    sizes: ClassVar = ("amplitude_um",)
    kind: Literal["mains_pickup"] = "mains_pickup"
    amplitude_um: NotNegative
    frequency_hz: Positive = 50.0
    phase_deg: Number = 0.0

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""

        def action(motion: Motion, push: Push) -> None:
            angle = 2.0 * math.pi * self.frequency_hz * motion.time_s + math.radians(self.phase_deg)
            push.reading_mm += self.amplitude_um * 1e-3 * np.sin(angle)

        return Momentary(action)


class LooseCup(MechanismTable):
    """A single permanent shift of the cup; no effect in the catalogue."""

    sizes: ClassVar = ("shift_um",)
    kind: Literal["loose_cup"] = "loose_cup"
    shift_um: Vector3
    """Base frame."""
    at_s: Window

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""

        def action(motion: Motion, push: Push) -> None:
            shifted = (motion.time_s >= self.at_s)[:, None]
            push.cup_mm += np.where(shifted, np.array(self.shift_um) * 1e-3, 0.0)

        return Momentary(action)
