"""What happens in the true machine besides geometry: mechanisms that displace sliders, legs or the reading.

Model: every cycle each mechanism sees the machine's state and adds to its displacements. A mechanism is two small
classes: its table in the truth file (a pydantic model, `kind` names it) and its stepper; `MECHANISMS` is the table of
kinds. A new mechanism is a new row.
Units: files in um and min, steppers in mm and s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated, Literal, Protocol

import numpy as np
from pydantic import Field

from hexdbb.rig.geometry import Array
from hexdbb.validation import Number, Positive, StrictModel

Axis = Annotated[int, Field(ge=1, le=6)]


@dataclass
class Displaced:
    """The machine at one instant: where the drives are, and what mechanisms have added so far; mm."""

    time_s: float
    drive_mm: Array
    slider_mm: Array = field(default_factory=lambda: np.zeros(6))
    leg_mm: Array = field(default_factory=lambda: np.zeros(6))
    reading_mm: float = 0.0


class Stepper(Protocol):
    """A mechanism at work."""

    def step(self, machine: Displaced, dt_s: float) -> None:
        """Add this mechanism's displacements for the instant `machine`, `dt_s` after the one before."""


class MechanismTable(StrictModel):
    """What every ``[[mechanism]]`` of a truth file has."""

    kind: str

    def stepper(self) -> Stepper:
        """Make the mechanism."""
        raise NotImplementedError


class Backlash(MechanismTable):
    """Play between the drive of one slider (where the encoder is) and the slider: a play operator."""

    kind: Literal["backlash"]
    slider: Axis
    width_um: Positive

    def stepper(self) -> Stepper:
        """See `MechanismTable.stepper`."""
        return PlayOperator(self.slider - 1, self.width_um * 1e-3)


class PlayOperator:
    """y(t) = min(max(y(t - dt), x - w/2), x + w/2): the slider moves only once the drive has taken up the play."""

    def __init__(self, slider: int, width_mm: float) -> None:
        self._slider, self._half_mm = slider, width_mm / 2.0
        self._position_mm: float | None = None

    def step(self, machine: Displaced, dt_s: float) -> None:
        """See `Stepper.step`."""
        drive = float(machine.drive_mm[self._slider])
        before = drive if self._position_mm is None else self._position_mm
        self._position_mm = min(max(before, drive - self._half_mm), drive + self._half_mm)
        machine.slider_mm[self._slider] += self._position_mm - drive


class ScrewPeriod(MechanismTable):
    """Periodic error of one slider's screw: amplitude sin(2 pi s / period + phase)."""

    kind: Literal["screw_period"]
    slider: Axis
    amplitude_um: Positive
    period_mm: Positive
    phase_deg: Number = 0.0

    def stepper(self) -> Stepper:
        """See `MechanismTable.stepper`."""
        return _Wave(self)


class _Wave:
    def __init__(self, table: ScrewPeriod) -> None:
        self._slider, self._amplitude_mm = table.slider - 1, table.amplitude_um * 1e-3
        self._per_mm, self._phase_rad = 2.0 * math.pi / table.period_mm, math.radians(table.phase_deg)

    def step(self, machine: Displaced, dt_s: float) -> None:
        angle = self._per_mm * float(machine.drive_mm[self._slider]) + self._phase_rad
        machine.slider_mm[self._slider] += self._amplitude_mm * math.sin(angle)


class GaugeDrift(MechanismTable):
    """The gauge's reading drifts with time."""

    kind: Literal["gauge_drift"]
    rate_um_min: Number

    def stepper(self) -> Stepper:
        """See `MechanismTable.stepper`."""
        return _Drift(self.rate_um_min * 1e-3 / 60.0)


class _Drift:
    def __init__(self, rate_mm_s: float) -> None:
        self._rate_mm_s = rate_mm_s

    def step(self, machine: Displaced, dt_s: float) -> None:
        machine.reading_mm += self._rate_mm_s * machine.time_s


MECHANISMS: dict[str, type[MechanismTable]] = {
    "backlash": Backlash,
    "screw_period": ScrewPeriod,
    "gauge_drift": GaugeDrift,
}
"""Kinds of ``[[mechanism]]`` a truth file may have."""
