"""Friction between slider and guideway, and the spring (screw, nut, coupling) between drive and slider.

Model of `reversal_spike`: after a reversal the slider sticks while the drive winds up the spring; at the breakaway
windup it slides again, and the windup decays with a time constant. Phases: sliding, sticking; the windup e = drive -
slider obeys e' = drive velocity while sticking, e' = -e / tau while sliding.
Model of `stick_slip`: within a window of time and below a speed, the lag of the slider grows over a short distance and
then drops to zero: a sawtooth along the path.
"""

from __future__ import annotations

import math
from typing import ClassVar, Literal

import numpy as np

from hexdbb.files.validation import NotNegative, Positive
from hexdbb.machine import MachineFile
from hexdbb.rig.mechanisms.base import Mechanism, Motion, Push, Window
from hexdbb.rig.mechanisms.transmission import SliderTable


class ReversalSpike(SliderTable):
    """Stiction of one slider at its reversals: `breakaway_um` of windup, decaying with `decay_s`."""

    sizes: ClassVar = ("breakaway_um",)
    has_memory: ClassVar = True
    kind: Literal["reversal_spike"] = "reversal_spike"
    breakaway_um: NotNegative
    decay_s: Positive = 0.3

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        return Stiction(self.slider - 1, self.breakaway_um * 1e-3, self.decay_s)


class Stiction:
    """Stiction with inner state: windup and direction; starts sliding, without windup."""

    def __init__(self, slider: int, breakaway_mm: float, decay_s: float) -> None:
        self._slider, self._breakaway_mm, self._decay_s = slider, breakaway_mm, decay_s
        self._pushed_mm: float | None = None
        self._windup_mm = 0.0
        self._direction = 0.0
        self._sticks = False

    def act(self, motion: Motion, push: Push) -> None:
        """See `Mechanism.act`."""
        pushed = motion.drive_mm[:, self._slider] + push.slider_mm[:, self._slider]
        first = float(pushed[0]) if self._pushed_mm is None else self._pushed_mm
        decay, path = math.exp(-motion.dt_s / self._decay_s), []
        for moved in np.diff(pushed, prepend=first).tolist():
            self._step(moved, decay)
            path.append(self._windup_mm)
        self._pushed_mm = float(pushed[-1])
        push.slider_mm[:, self._slider] -= np.array(path)

    def _step(self, moved_mm: float, decay: float) -> None:
        if moved_mm != 0.0 and math.copysign(1.0, moved_mm) != self._direction:
            # The first motion is not a reversal.
            self._sticks = self._direction != 0.0
            self._direction = math.copysign(1.0, moved_mm)
        if not self._sticks:
            self._windup_mm *= decay
            return
        self._windup_mm += moved_mm
        if self._windup_mm * self._direction >= self._breakaway_mm:
            self._windup_mm = self._direction * self._breakaway_mm
            self._sticks = False


class StickSlip(SliderTable):
    """A burst of stick-slip of one slider; no effect in the catalogue."""

    sizes: ClassVar = ("tooth_um",)
    has_memory: ClassVar = True
    kind: Literal["stick_slip"] = "stick_slip"
    tooth_um: NotNegative
    way_mm: Positive = 1.5
    begin_s: Window = 0.0
    duration_s: Positive
    below_mm_min: Positive = 1000.0

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        return Sawtooth(self)


class Sawtooth:
    """Stick-slip with inner state: phase of the sawtooth; the lag grows to one tooth over each `way_mm` of travel."""

    def __init__(self, table: StickSlip) -> None:
        self._slider, self._tooth_mm, self._way_mm = table.slider - 1, table.tooth_um * 1e-3, table.way_mm
        self._begin_s, self._end_s = table.begin_s, table.begin_s + table.duration_s
        self._below_mm_s = table.below_mm_min / 60.0
        self._pushed_mm: float | None = None
        self._phase = 0.0

    def act(self, motion: Motion, push: Push) -> None:
        """See `Mechanism.act`."""
        pushed = motion.drive_mm[:, self._slider] + push.slider_mm[:, self._slider]
        first = float(pushed[0]) if self._pushed_mm is None else self._pushed_mm
        moved = np.diff(pushed, prepend=first)
        self._pushed_mm = float(pushed[-1])
        bursting = (motion.time_s >= self._begin_s) & (motion.time_s < self._end_s)
        bursting &= np.abs(moved) < self._below_mm_s * motion.dt_s
        way = np.cumsum(np.where(bursting, np.abs(moved), 0.0)) / self._way_mm + self._phase
        self._phase = float(way[-1] % 1.0)
        lag = np.where(bursting, self._tooth_mm * (way % 1.0) * np.sign(moved), 0.0)
        push.slider_mm[:, self._slider] -= lag
