"""Transmission between drive and slider: nut, screw, servo. Each mechanism displaces one slider along its guideway.

Model: play operator y(t) = min(max(y(t - dt), x - w/2), x + w/2) for the nut; first-order lag tau y' = x - y between
the drive's encoder and the slider; periodic pitch error (harmonics 1 and 2 of the screw angle), lead error, and
interpolation error of the encoder within its signal period.
Source: play operator as in Krasnosel'skii and Pokrovskii, Systems with Hysteresis (1989), chapter 1.
"""

from __future__ import annotations

import math
from typing import ClassVar, Literal

import numpy as np

from hexdbb.files.validation import NotNegative, Number, Positive
from hexdbb.machine import MachineFile
from hexdbb.rig.geometry import Array
from hexdbb.rig.mechanisms.base import Axis, Mechanism, MechanismTable, Momentary, Motion, Push


class SliderTable(MechanismTable):
    """A mechanism of one slider."""

    slider: Axis


class Backlash(SliderTable):
    """Play between the drive of one slider, where the encoder is, and the slider; `width_um` is the whole play."""

    sizes: ClassVar = ("width_um",)
    has_memory: ClassVar = True
    kind: Literal["backlash"] = "backlash"
    width_um: NotNegative

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        return PlayOperator(self.slider - 1, self.width_um * 1e-3)


class PlayOperator:
    """Play operator: the slider moves only when the drive has taken up the play; starts in its middle."""

    def __init__(self, slider: int, width_mm: float) -> None:
        self._slider, self._half_mm = slider, width_mm / 2.0
        self._at_mm: float | None = None

    def act(self, motion: Motion, push: Push) -> None:
        """See `Mechanism.act`."""
        pushed = motion.drive_mm[:, self._slider] + push.slider_mm[:, self._slider]
        half, at, path = self._half_mm, self._at_mm, []
        at = float(pushed[0]) if at is None else at
        for x in pushed.tolist():
            at = min(max(at, x - half), x + half)
            path.append(at)
        self._at_mm = at
        push.slider_mm[:, self._slider] += np.array(path) - pushed


class ServoLag(SliderTable):
    """First-order lag of one slider behind its drive."""

    sizes: ClassVar = ("lag_ms",)
    has_memory: ClassVar = True
    kind: Literal["servo_lag"] = "servo_lag"
    lag_ms: NotNegative

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        return Lag(self.slider - 1, self.lag_ms * 1e-3)


class Lag:
    """First-order lag tau y' = x - y, exact for an x that is linear between instants; starts at rest."""

    def __init__(self, slider: int, tau_s: float) -> None:
        self._slider, self._tau_s = slider, tau_s
        self._pushed_mm: float | None = None
        self._behind_mm = 0.0

    def act(self, motion: Motion, push: Push) -> None:
        """See `Mechanism.act`."""
        if self._tau_s == 0.0:
            return
        pushed = motion.drive_mm[:, self._slider] + push.slider_mm[:, self._slider]
        first = float(pushed[0]) if self._pushed_mm is None else self._pushed_mm
        # x - y tends to tau x'; a stretch of zero duration does not change it.
        decay = math.exp(-motion.dt_s / self._tau_s)
        gain = self._tau_s / motion.dt_s * (1.0 - decay) if motion.dt_s > 0.0 else 1.0
        behind, path = self._behind_mm, []
        for moved in np.diff(pushed, prepend=first).tolist():
            behind = behind * decay + gain * moved
            path.append(behind)
        self._behind_mm, self._pushed_mm = behind, float(pushed[-1])
        push.slider_mm[:, self._slider] -= np.array(path)


class PitchCyclic(SliderTable):
    """Periodic pitch error of the screw of one slider: harmonics 1 and 2 of the screw angle."""

    sizes: ClassVar = ("amplitude_um", "second_amplitude_um")
    kind: Literal["pitch_cyclic"] = "pitch_cyclic"
    amplitude_um: NotNegative
    phase_deg: Number = 0.0
    second_amplitude_um: NotNegative = 0.0
    second_phase_deg: Number = 0.0

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        return periodic(
            self.slider - 1,
            machine.sliders.screw_lead_mm,
            [(self.amplitude_um * 1e-3, self.phase_deg), (self.second_amplitude_um * 1e-3, self.second_phase_deg)],
        )


class EncoderInterpolation(SliderTable):
    """Interpolation error of the encoder within its signal period; no effect in the catalogue."""

    sizes: ClassVar = ("amplitude_um",)
    kind: Literal["encoder_interpolation"] = "encoder_interpolation"
    amplitude_um: NotNegative
    period_um: Positive = 20.0
    phase_deg: Number = 0.0

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        return periodic(self.slider - 1, self.period_um * 1e-3, [(self.amplitude_um * 1e-3, self.phase_deg)])


def periodic(slider: int, period_mm: float, harmonics: list[tuple[float, float]]) -> Mechanism:
    """Return a mechanism with a periodic displacement of one slider.

    Parameters
    ----------
    slider : int
        From 0.
    period_mm : float
        Travel per period.
    harmonics : list of (float, float)
        Amplitude (mm) and phase (degrees) of harmonics 1, 2, ... of sine form.
    """

    def action(motion: Motion, push: Push) -> None:
        turn_rad = 2.0 * math.pi / period_mm * motion.drive_mm[:, slider]
        for order, (amplitude_mm, phase_deg) in enumerate(harmonics, start=1):
            push.slider_mm[:, slider] += amplitude_mm * np.sin(order * turn_rad + math.radians(phase_deg))

    return Momentary(action)


class LeadError(SliderTable):
    """Lead error of the screw of one slider; zero in the middle of travel."""

    sizes: ClassVar = ("error_um_m",)
    kind: Literal["lead_error"] = "lead_error"
    error_um_m: Number

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        slider, per_mm = self.slider - 1, self.error_um_m * 1e-6
        middle_mm = sum(machine.sliders.travels_mm[slider]) / 2.0

        def action(motion: Motion, push: Push) -> None:
            from_middle_mm: Array = motion.drive_mm[:, slider] - middle_mm
            push.slider_mm[:, slider] += per_mm * from_middle_mm

        return Momentary(action)
