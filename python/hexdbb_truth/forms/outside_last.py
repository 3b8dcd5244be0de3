"""Faults outside the catalogue of drives, guideways, legs, platform, set-up and gauge."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, signed, slider, unit_vector
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.labels import Equivalent, leg_too, slider_too
from hexdbb_truth.forms.ports import Action, Scene

# --- drives and guideways ---------------------------------------------------------------------------------------------


def _screw_bent(draw: Draw) -> Fault:
    """A bent screw whips: once a turn, most in the middle of its span and not at all at its ends."""
    k, phase = slider(draw), draw.uniform(0.0, 2.0 * math.pi)

    def values(scene: Scene, size: float) -> Array:
        sliders = scene.history.machine.sliders
        low, high = sliders.travels_mm[k]
        along = (scene.drive_mm(k) - low) / (high - low)
        turn = 2.0 * math.pi / sliders.screw_lead_mm * scene.drive_mm(k)
        return column(1e-3 * size * np.sin(math.pi * along) ** 2 * np.sin(turn + phase))

    why = "a wave of the screw's turn, of one size on each circle"
    return Fault(
        Action("slider", (k,), values),
        (Equivalent("slider", "position", (k + 1,), why, "pitch_cyclic"), leg_too(k, "position")),
    )


def _grease_drags(draw: Draw) -> Fault:
    """Grease drags the carriage most where it creeps: the lag falls with speed, and turns over with it."""
    k, slow_mm_s = slider(draw), float(draw.uniform(1.0, 4.0))

    def values(scene: Scene, size: float) -> Array:
        velocity = scene.history.velocity_mm_s[scene.rows, k]
        return column(-1e-3 * size * np.tanh(velocity / 0.2) * np.exp(-np.abs(velocity) / slow_mm_s))

    why = "near a reversal every slider is slow"
    same = (
        Equivalent("slider", "direction", (k + 1,), why),
        Equivalent("slider", "since_reversal", (k + 1,), why, "reversal_spike"),
        leg_too(k, "velocity"),
        leg_too(k, "joint_turning"),
    )
    return Fault(Action("slider", (k,), values), same)


def _drive_saturates(draw: Draw) -> Fault:
    """A weak drive follows slow motion well and falls behind by no more than its integrator lets it."""
    k, knee = slider(draw), float(draw.uniform(0.15, 0.5))

    def values(scene: Scene, size: float) -> Array:
        sampled = scene.sampled
        largest = float(np.abs(sampled.history.velocity_mm_s[sampled.rows, k]).max())
        return column(-1e-3 * size * np.tanh(scene.history.velocity_mm_s[scene.rows, k] / (knee * largest)))

    why = "a lag that stops growing"
    same = (
        Equivalent("slider", "velocity", (k + 1,), why, "servo_lag"),
        Equivalent("slider", "direction", (k + 1,), "where it hardly changes between reversals"),
        leg_too(k, "velocity"),
    )
    return Fault(Action("slider", (k,), values), same)


def _chain_pushes(draw: Draw) -> Fault:
    """The cable chain between two sliders of a guideway presses one of them aside where they come near."""
    k, reach_mm = slider(draw), float(draw.uniform(20.0, 60.0))

    def values(scene: Scene, size: float) -> Array:
        sampled = scene.sampled
        gap = np.abs(scene.drive_mm(k) - scene.drive_mm(k ^ 1))
        least = float(np.abs(sampled.drive_mm(k) - sampled.drive_mm(k ^ 1)).min())
        return column(1e-3 * size * np.exp(-(gap - least) / reach_mm))

    both = tuple(slider_too(each, "position") for each in (k, k ^ 1))
    angle = Equivalent("leg", "joint_angle", (k + 1,), "the joint's angle follows its slider's position")
    return Fault(Action("slider", (k,), values), (*both, leg_too(k, "position"), angle))


def _carriages_float(draw: Draw) -> Fault:
    """An oil film lifts the carriages of a guideway the more, the faster they run."""
    guideway = int(draw.integers(0, 3))

    def values(scene: Scene, size: float) -> Array:
        sampled, both = scene.sampled, np.zeros((len(scene.rows), 4))
        for j in range(2):
            k = 2 * guideway + j
            largest = float(np.abs(sampled.history.velocity_mm_s[sampled.rows, k]).max())
            both[:, 2 * j + 1] = 1e-3 * size * np.sqrt(np.abs(scene.history.velocity_mm_s[scene.rows, k]) / largest)
        return both

    why = "one of the carriages may float more"
    same = [
        Equivalent(port, variable, (2 * guideway + j + 1,), why)
        for j in range(2)
        for port in ("slider", "leg")
        for variable in ("velocity", "joint_turning")
    ]
    return Fault(Action("guideway", (guideway,), values), tuple(same))


# --- legs and platform ------------------------------------------------------------------------------------------------


def _leg_sings(draw: Draw) -> Fault:
    """A leg swings at a frequency of its own all the time."""
    k, period_s, phase = slider(draw), float(draw.uniform(2.0, 12.0)), draw.uniform(0.0, 2.0 * math.pi)

    def values(scene: Scene, size: float) -> Array:
        return column(1e-3 * size * np.sin(2.0 * math.pi * scene.time_s / period_s + phase))

    reading = Equivalent("reading", "time", None, "one period, wherever it enters")
    return Fault(Action("leg", (k,), values), (slider_too(k, "time"), reading))


def _joint_is_loose(draw: Draw) -> Fault:
    """A platform joint has play: it lies on the side from which its slider pushes."""
    k, way = slider(draw), unit_vector(draw)

    def values(scene: Scene, size: float) -> Array:
        turning = np.tanh(scene.history.velocity_mm_s[scene.rows, k] / 0.2)
        return 1e-3 * size * column(turning) * way

    why = "its part along the leg turns over with the slider"
    same = (
        Equivalent("slider", "direction", (k + 1,), why, "backlash"),
        Equivalent("leg", "joint_turning", (k + 1,), why, "joint_friction"),
        leg_too(k, "direction"),
    )
    return Fault(Action("platform_joint", (k,), values), same)


def _leg_bows(draw: Draw) -> Fault:
    """A leg bows under its own weight the more it lies down, and becomes shorter."""
    k = slider(draw)

    def values(scene: Scene, size: float) -> Array:
        sampled = scene.sampled
        lying = 1.0 - scene.history.leg_direction[scene.rows, k, 2] ** 2
        whole = 1.0 - sampled.history.leg_direction[sampled.rows, k, 2] ** 2
        return column(-1e-3 * size * ((lying - whole.min()) / np.ptp(whole)) ** 2)

    why = "how a leg lies follows where its foot is"
    same = tuple(
        Equivalent(port, variable, (k + 1,), why)
        for port in ("leg", "slider")
        for variable in ("position", "leg_force")
    )
    return Fault(Action("leg", (k,), values), same)


# --- set-up and gauge -------------------------------------------------------------------------------------------------


def _gauge_wanders(draw: Draw) -> Fault:
    """The gauge follows the room: one slow swing during the test."""
    period_s, phase = float(draw.uniform(900.0, 2400.0)), draw.uniform(0.0, 2.0 * math.pi)

    def values(scene: Scene, size: float) -> Array:
        return column(1e-3 * size * np.sin(2.0 * math.pi * scene.time_s / period_s + phase))

    why = "a part of a slow swing is a drift"
    same = (
        Equivalent("reading", "time", None, why, "bar_drift"),
        Equivalent("leg", "time", None, "legs that grow alike lift the platform, and what the bar sees of it"),
        Equivalent("cup", "time", None, "what the bar sees of it"),
        Equivalent("ball", "time", None, "what the bar sees of it"),
    )
    return Fault(Action("reading", (), values), same)


def _stem_leans(draw: Draw) -> Fault:
    """The ball's stem is loose in its thread: it leans to the side from which the bar is drawn around."""
    share, sign = float(draw.uniform(0.5, 1.0)), signed(draw)

    def values(scene: Scene, size: float) -> Array:
        history, rows = scene.history, scene.rows
        bar = history.bar_direction(rows)
        side = np.cross(np.array([0.0, 0.0, 1.0]), bar) * history.direction(rows)[:, None]
        lean = sign * share * side + math.sqrt(1.0 - share**2) * history.direction(rows)[:, None] * bar
        return np.asarray(1e-3 * size * np.einsum("nij,ni->nj", history.rotation[rows], lean))

    why = "along the bar it is a step between the directions"
    same = tuple(
        Equivalent(port, variable, None, why) for port in ("reading", "cup") for variable in ("direction", "angle")
    )
    return Fault(Action("ball", (), values), same)


TABLE: dict[str, Outside] = {
    "screw_bent": Outside("um", 8.0, 500.0, ("position",), _screw_bent),
    "grease_drags": Outside("um", 10.0, 1000.0, ("velocity",), _grease_drags),
    "drive_saturates": Outside("um", 10.0, 1000.0, ("velocity",), _drive_saturates),
    "chain_pushes": Outside("um", 15.0, 1500.0, ("position",), _chain_pushes),
    "carriages_float": Outside("um", 15.0, 1500.0, ("velocity",), _carriages_float),
    "leg_sings": Outside("um", 8.0, 500.0, ("time",), _leg_sings),
    "joint_is_loose": Outside("um", 10.0, 1000.0, ("direction",), _joint_is_loose),
    "leg_bows": Outside("um", 30.0, 3000.0, ("inclination", "joint_angle"), _leg_bows),
    "gauge_wanders": Outside("um", 5.0, 500.0, ("time",), _gauge_wanders),
    "stem_leans": Outside("um", 5.0, 500.0, ("direction", "angle"), _stem_leans),
}
"""Kinds by name."""
