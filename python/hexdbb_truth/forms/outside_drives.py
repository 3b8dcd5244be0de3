"""Faults outside the catalogue between drive and slider."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, signed, slider
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.labels import Equivalent
from hexdbb_truth.forms.ports import Action, Scene

NEAR_THE_LEAD = 0.15
"""Periods this near, relatively, to the screw's lead or its double are not drawn: they would be pitch error."""


def _tape_period(draw: Draw) -> Fault:
    """A rack, belt or tape errs with a period of its own."""
    k, period, phase = slider(draw), _period_mm(draw), draw.uniform(0.0, 2.0 * math.pi)

    def values(scene: Scene, size: float) -> Array:
        return column(1e-3 * size * np.sin(2.0 * math.pi / period * scene.drive_mm(k) + phase))

    return Fault(Action("slider", (k,), values))


def _period_mm(draw: Draw) -> float:
    while True:
        period = float(np.exp(draw.uniform(math.log(7.0), math.log(60.0))))
        if min(abs(period / (5.0 * order) - 1.0) for order in (1.0, 2.0)) > NEAR_THE_LEAD:
            return period


def _tape_bump(draw: Draw) -> Fault:
    """The encoder's tape is glued over a chip: a bump of the position at one place."""
    k, place, width = slider(draw), float(draw.uniform(-0.6, 0.6)), float(draw.uniform(0.03, 0.12))
    sign = signed(draw)

    def values(scene: Scene, size: float) -> Array:
        return column(sign * 1e-3 * size * np.exp(-0.5 * ((scene.place(k) - place) / width) ** 2))

    return Fault(Action("slider", (k,), values))


def _cogging(draw: Draw) -> Fault:
    """The motor's poles: a ripple several times per turn of the screw, where the catalogue knows once and twice."""
    k, order, phase = slider(draw), int(draw.integers(3, 6)), draw.uniform(0.0, 2.0 * math.pi)

    def values(scene: Scene, size: float) -> Array:
        turn = 2.0 * math.pi / scene.history.machine.sliders.screw_lead_mm * scene.drive_mm(k)
        return column(1e-3 * size * np.sin(order * turn + phase))

    return Fault(Action("slider", (k,), values))


def _count_loss(draw: Draw) -> Fault:
    """The encoder loses counts now and then: steps in time, all the same way."""
    k, sign = slider(draw), signed(draw)
    moments = np.sort(draw.uniform(0.1, 0.9, int(draw.integers(1, 4))))

    def values(scene: Scene, size: float) -> Array:
        lost = np.searchsorted(moments, scene.time_s / scene.duration_s())
        return column(sign * 1e-3 * size * lost.astype(float))

    return Fault(Action("slider", (k,), values), (_leg_of(k, "time"),))


def _leg_of(k: int, variable: str) -> Equivalent:
    return Equivalent(
        "leg", variable, (k + 1,), "a slider moves its leg's foot along the leg, but for the leg's leaning"
    )


def _amplifier_offset(draw: Draw) -> Fault:
    """The following error has a part that does not turn over with the velocity."""
    k, soft, sign = slider(draw), float(draw.uniform(5.0, 20.0)), signed(draw)

    def values(scene: Scene, size: float) -> Array:
        speed = np.abs(scene.history.velocity_mm_s[scene.rows, k])
        return column(sign * 1e-3 * size * np.tanh(speed / soft))

    return Fault(Action("slider", (k,), values))


def _belt_stretch(draw: Draw) -> Fault:
    """The transmission gives under the slider's inertia, more than in proportion."""
    k, power = slider(draw), float(draw.uniform(1.0, 1.5))

    def values(scene: Scene, size: float) -> Array:
        acceleration = scene.history.acceleration_mm_s2[scene.rows, k] / 20.0
        return column(-1e-3 * size * np.sign(acceleration) * np.abs(acceleration) ** power)

    return Fault(Action("slider", (k,), values))


def _resonance(draw: Draw) -> Fault:
    """The screw's turning excites a resonance: a ripple of the screw's period, but only near one speed."""
    k, critical, width = slider(draw), float(draw.uniform(8.0, 30.0)), float(draw.uniform(2.0, 5.0))
    phase = draw.uniform(0.0, 2.0 * math.pi)

    def values(scene: Scene, size: float) -> Array:
        off = (np.abs(scene.history.velocity_mm_s[scene.rows, k]) - critical) / width
        turn = 2.0 * math.pi / scene.history.machine.sliders.screw_lead_mm * scene.drive_mm(k)
        return column(1e-3 * size / (1.0 + off**2) * np.sin(turn + phase + np.arctan(off)))

    same = Equivalent("slider", "position", (k + 1,), "most of it is the screw's period", "pitch_cyclic")
    return Fault(Action("slider", (k,), values), (same,))


def _thermal_click(draw: Draw) -> Fault:
    """A bearing's outer ring creeps with warming and snaps back: a sawtooth in time."""
    k, period, phase = slider(draw), float(draw.uniform(200.0, 600.0)), draw.uniform(0.0, 1.0)

    def values(scene: Scene, size: float) -> Array:
        return column(1e-3 * size * ((scene.time_s / period + phase) % 1.0))

    return Fault(Action("slider", (k,), values), (_leg_of(k, "time"),))


TABLE: dict[str, Outside] = {
    "tape_period": Outside("um", 8.0, 500.0, ("position",), _tape_period),
    "tape_bump": Outside("um", 15.0, 1500.0, ("position",), _tape_bump),
    "cogging": Outside("um", 8.0, 500.0, ("position",), _cogging),
    "count_loss": Outside("um", 15.0, 1500.0, ("time",), _count_loss),
    "amplifier_offset": Outside("um", 15.0, 1500.0, ("velocity",), _amplifier_offset),
    "belt_stretch": Outside("um", 15.0, 1500.0, ("acceleration",), _belt_stretch),
    "resonance": Outside("um", 15.0, 1000.0, ("velocity", "position"), _resonance),
    "thermal_click": Outside("um", 20.0, 1500.0, ("time",), _thermal_click),
}
"""Kinds by name."""
