"""Faults outside the catalogue of drives, structure and measuring, added after those of the other files."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, signed, slider, unit_vector
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.labels import Equivalent, leg_too, slider_too
from hexdbb_truth.forms.ports import Action, Scene

# --- drives and guideways ---------------------------------------------------------------------------------------------


def _torque_turns_over(draw: Draw) -> Fault:
    """The drive's coupling has play in torque: the slider jumps where the drive changes from pushing to braking."""
    k, sign = slider(draw), signed(draw)

    def values(scene: Scene, size: float) -> Array:
        acceleration = scene.history.acceleration_mm_s2[:, k]
        sampled = scene.sampled
        soft = float(np.std(sampled.history.acceleration_mm_s2[sampled.rows, k])) * 0.1
        return column(sign * 1e-3 * size * np.tanh(acceleration[scene.rows] / soft))

    return Fault(Action("slider", (k,), values), (leg_too(k, "acceleration"), slider_too(k, "position")))


def _neighbour_disturbs(draw: Draw) -> Fault:
    """Two drives share a supply: one slider is off while the other on its guideway runs fast."""
    k, sign = slider(draw), signed(draw)

    def values(scene: Scene, size: float) -> Array:
        sampled, other = scene.sampled, scene.history.velocity_mm_s[:, k ^ 1]
        largest = float(np.abs(sampled.history.velocity_mm_s[sampled.rows, k ^ 1]).max())
        return column(sign * 1e-3 * size * (other[scene.rows] / largest) ** 2)

    return Fault(Action("slider", (k,), values), (slider_too(k, "velocity"), leg_too(k, "velocity")))


def _sticky_patch(draw: Draw) -> Fault:
    """A dry patch of the guideway holds the slider back, whichever way it goes, there and nowhere else."""
    k, place, width = slider(draw), float(draw.uniform(-0.5, 0.5)), float(draw.uniform(0.2, 0.4))

    def values(scene: Scene, size: float) -> Array:
        way = np.tanh(scene.history.velocity_mm_s[scene.rows, k] / 0.2)
        return column(-1e-3 * size * way * np.exp(-0.5 * ((scene.place(k) - place) / width) ** 2))

    play = Equivalent("slider", "direction", (k + 1,), "play that is wider at one place", "backlash")
    return Fault(Action("slider", (k,), values), (play, leg_too(k, "joint_turning"), leg_too(k, "direction")))


def _carriage_gives(draw: Draw) -> Fault:
    """The carriage yields along the guideway under its leg's force, more than in proportion."""
    k, power = slider(draw), int(draw.choice([2, 3]))

    def values(scene: Scene, size: float) -> Array:
        whole = scene.sampled.history.leg_force_n(scene.sampled.rows)[:, k]
        force = (scene.history.leg_force_n(scene.rows)[:, k] - whole.mean()) / np.ptp(whole)
        return column(1e-3 * size * force**power)

    same = (leg_too(k, "leg_force"), slider_too(k, "position"), leg_too(k, "joint_angle"))
    return Fault(Action("slider", (k,), values), same)


def _rail_joint(draw: Draw) -> Fault:
    """Two rails meet with a step in height: a carriage climbs it over its own length."""
    guideway, place, length = int(draw.integers(0, 3)), float(draw.uniform(-0.4, 0.4)), float(draw.uniform(8.0, 30.0))

    def values(scene: Scene, size: float) -> Array:
        drive = scene.sampled.drive_mm(2 * guideway)
        at_mm = 0.5 * (drive.max() + drive.min()) + 0.5 * place * (drive.max() - drive.min())
        both = np.zeros((len(scene.rows), 4))
        for j in range(2):
            both[:, 2 * j + 1] = 1e-3 * size * np.tanh((scene.drive_mm(2 * guideway + j) - at_mm) / length)
        return both

    why = "one of the sliders may pass the joint alone"
    same = tuple(slider_too(2 * guideway + j, "position") for j in range(2))
    bow = Equivalent("guideway", "position", (guideway + 1,), why, "straightness")
    return Fault(Action("guideway", (guideway,), values), (*same, bow))


# --- legs and platform ------------------------------------------------------------------------------------------------


def _leg_whips(draw: Draw) -> Fault:
    """A slender leg bends under its own inertia and becomes shorter, whichever way it is accelerated."""
    k = slider(draw)

    def values(scene: Scene, size: float) -> Array:
        sampled, acceleration = scene.sampled, scene.history.acceleration_mm_s2[:, k]
        largest = float(np.abs(sampled.history.acceleration_mm_s2[sampled.rows, k]).max())
        return column(-1e-3 * size * (acceleration[scene.rows] / largest) ** 2)

    return Fault(Action("leg", (k,), values), (slider_too(k, "acceleration"), leg_too(k, "velocity")))


def _leg_relaxes(draw: Draw) -> Fault:
    """After each way to a circle a glued leg end creeps back."""
    k, tau, sign = slider(draw), float(draw.uniform(5.0, 30.0)), signed(draw)

    def values(scene: Scene, size: float) -> Array:
        return column(sign * 1e-3 * size * np.exp(-scene.history.since_run_began_s(scene.rows) / tau))

    same = (leg_too(k, "time"), slider_too(k, "time"), leg_too(k, "time_in_run"))
    return Fault(Action("leg", (k,), values), same)


def _joint_seat_warms(draw: Draw) -> Fault:
    """The seat of one platform joint moves while the platform warms."""
    k, way, tau = slider(draw), unit_vector(draw), float(draw.uniform(300.0, 1500.0))
    why = "the seat's motion along the leg is the leg's length"
    return Fault(
        Action("platform_joint", (k,), lambda scene, size: -1e-3 * size * column(np.expm1(-scene.time_s / tau)) * way),
        (Equivalent("leg", "time", (k + 1,), why), Equivalent("slider", "time", (k + 1,), why)),
    )


# --- set-up and gauge -------------------------------------------------------------------------------------------------


def _table_breathes(draw: Draw) -> Fault:
    """The room's air conditioning goes on and off: the cup's table breathes with it."""
    way, period, phase = unit_vector(draw), float(draw.uniform(150.0, 500.0)), draw.uniform(0.0, 2.0 * math.pi)
    way[2] *= 0.3

    def values(scene: Scene, size: float) -> Array:
        return 1e-3 * size * column(np.sin(2.0 * math.pi * scene.time_s / period + phase)) * way

    same = (
        Equivalent("ball", "time", None, "cup and ball move alike while the platform is not turned"),
        Equivalent("reading", "time", None, "what the bar sees of it"),
    )
    return Fault(Action("cup", (), values), same)


def _ball_is_flat(draw: Draw) -> Fault:
    """The ball is worn on one side: the bar grows longer to the eye where it rests on the flat."""
    place, width = draw.uniform(-math.pi, math.pi), float(draw.uniform(0.2, 0.6))

    def values(scene: Scene, size: float) -> Array:
        bar = np.einsum("nij,ni->nj", scene.history.rotation[scene.rows], scene.history.bar_direction(scene.rows))
        off = np.angle(np.exp(1j * (np.arctan2(bar[:, 1], bar[:, 0]) - place)))
        return column(-1e-3 * size * np.exp(-0.5 * (off / width) ** 2))

    return Fault(
        Action("reading", (), values), (Equivalent("ball", "angle", None, "along the bar, ball and reading are one"),)
    )


def _gauge_lags_load(draw: Draw) -> Fault:
    """The gauge's plunger rubs: it reads too little while it is pressed and too much while it is let out."""

    def values(scene: Scene, size: float) -> Array:
        history = scene.history
        turn = history.direction(scene.rows)
        angle = history.angle_rad[scene.rows]
        return column(1e-3 * size * np.tanh(3.0 * turn * np.sin(angle + phase)))

    phase = draw.uniform(0.0, 2.0 * math.pi)
    same = (Equivalent("reading", "direction", None, "its sign turns over with the direction of the circle"),)
    return Fault(Action("reading", (), values), same)


def _gauge_compresses(draw: Draw) -> Fault:
    """The gauge's amplifier compresses large deflections to either side."""

    def values(scene: Scene, size: float) -> Array:
        largest = float(np.abs(scene.sampled.deflection_mm).max())
        return column(-1e-3 * size * (scene.deflection_mm / largest) ** 3)

    why = "what a straight gain explains of a bent one"
    return Fault(Action("reading", (), values), (Equivalent("reading", "deflection", None, why, "bar_gain"),))


TABLE: dict[str, Outside] = {
    "torque_turns_over": Outside("um", 10.0, 1500.0, ("acceleration",), _torque_turns_over),
    "neighbour_disturbs": Outside("um", 10.0, 1500.0, ("velocity",), _neighbour_disturbs),
    "sticky_patch": Outside("um", 10.0, 1500.0, ("direction", "position"), _sticky_patch),
    "carriage_gives": Outside("um", 20.0, 2000.0, ("leg_force",), _carriage_gives),
    "rail_joint": Outside("um", 15.0, 2000.0, ("position",), _rail_joint),
    "leg_whips": Outside("um", 10.0, 1500.0, ("acceleration",), _leg_whips),
    "leg_relaxes": Outside("um", 10.0, 1500.0, ("time_in_run",), _leg_relaxes),
    "joint_seat_warms": Outside("um", 15.0, 1500.0, ("time",), _joint_seat_warms),
    "table_breathes": Outside("um", 8.0, 800.0, ("time",), _table_breathes),
    "ball_is_flat": Outside("um", 8.0, 500.0, ("angle",), _ball_is_flat),
    "gauge_lags_load": Outside("um", 5.0, 500.0, ("angle", "direction"), _gauge_lags_load),
    "gauge_compresses": Outside("um", 10.0, 500.0, ("deflection",), _gauge_compresses),
}
"""Kinds by name."""
