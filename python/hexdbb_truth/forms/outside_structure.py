"""Faults outside the catalogue of guideways, legs, joints and platform."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, signed, slider, unit_vector
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.labels import Equivalent
from hexdbb_truth.forms.ports import Action, Scene, unit_range
from hexdbb_truth.forms.slider_forms import warmed

# --- guideways --------------------------------------------------------------------------------------------------------


def _dent(draw: Draw) -> Fault:
    """A guideway has a dip where one of its sliders passes."""
    k, place, width = slider(draw), float(draw.uniform(-0.6, 0.6)), float(draw.uniform(4.0, 15.0))
    guideway = k // 2

    def values(scene: Scene, size: float) -> Array:
        drive = scene.sampled.drive_mm(k)
        at_mm = 0.5 * (drive.max() + drive.min()) + 0.5 * place * (drive.max() - drive.min())
        both = np.zeros((len(scene.rows), 4))
        for j in range(2):
            off = (scene.drive_mm(2 * guideway + j) - at_mm) / width
            both[:, 2 * j + 1] = -1e-3 * size * np.exp(-0.5 * off**2)
        return both

    return Fault(Action("guideway", (guideway,), values), _one_slider(k, guideway))


def _one_slider(k: int, guideway: int) -> tuple[Equivalent, ...]:
    why = "only one of the sliders passes there, and its leg leans little while it does"
    lateral = "lateral for vertical: one slider's joint at one place is pushed along its leg either way"
    return (
        Equivalent("slider", "position", (k + 1,), why),
        Equivalent("leg", "joint_angle", (k + 1,), why),
        Equivalent("guideway", "position", (guideway + 1,), lateral),
    )


def _rail_waves(draw: Draw) -> Fault:
    """Balls that circulate in the carriage: the guideway seems to wave, some tens of millimetres long."""
    guideway, period = int(draw.integers(0, 3)), float(draw.uniform(25.0, 70.0))
    phase, across = draw.uniform(0.0, 2.0 * math.pi), unit_vector(draw, 2)

    def values(scene: Scene, size: float) -> Array:
        at = [2.0 * math.pi / period * scene.drive_mm(2 * guideway + j) + phase for j in range(2)]
        return np.hstack([1e-3 * size * np.sin(each)[:, None] * across for each in at])

    return Fault(Action("guideway", (guideway,), values))


def _guideway_warms(draw: Draw) -> Fault:
    """A guideway warms on one side and bows more and more."""
    guideway, tau, across = int(draw.integers(0, 3)), float(draw.uniform(300.0, 2000.0)), unit_vector(draw, 2)

    def values(scene: Scene, size: float) -> Array:
        low, high = scene.history.machine.sliders.guideway_travels_mm[guideway]
        bows = [1.0 - ((2.0 * scene.drive_mm(2 * guideway + j) - low - high) / (high - low)) ** 2 for j in range(2)]
        return np.hstack([1e-3 * size * (warmed(scene, tau) * bow)[:, None] * across for bow in bows])

    pair = (2 * guideway + 1, 2 * guideway + 2)
    same = (
        Equivalent("guideway", "time", (guideway + 1,), "over the range driven the bow is nearly a displacement"),
        Equivalent("leg", "time", pair, "a guideway that rises pushes both its legs"),
        Equivalent("slider", "time", pair, "a guideway that moves outward pushes both its legs' feet"),
    )
    return Fault(Action("guideway", (guideway,), values), same)


# --- legs -------------------------------------------------------------------------------------------------------------


def _leg_slips(draw: Draw) -> Fault:
    """A leg's clamp slips once."""
    k, moment, sign = slider(draw), draw.uniform(0.15, 0.85), signed(draw)

    def values(scene: Scene, size: float) -> Array:
        return column(sign * 1e-3 * size * (scene.time_s > moment * scene.duration_s()).astype(float))

    return Fault(Action("leg", (k,), values), (_foot_of(k, "time"),))


def _foot_of(k: int, variable: str) -> Equivalent:
    return Equivalent("slider", variable, (k + 1,), "a slider moves its leg's foot along the leg, but for its leaning")


def _leg_warms(draw: Draw) -> Fault:
    """One leg stands in the sun, where the catalogue knows all alike."""
    k, tau, sign = slider(draw), float(draw.uniform(200.0, 1500.0)), signed(draw)
    return Fault(
        Action("leg", (k,), lambda scene, size: column(sign * 1e-3 * size * warmed(scene, tau))),
        (_foot_of(k, "time"),),
    )


def _joint_sticks(draw: Draw) -> Fault:
    """A joint binds near one angle: the leg is drawn or pressed while it turns through it."""
    k, place, width = slider(draw), float(draw.uniform(-0.5, 0.5)), float(draw.uniform(0.08, 0.25))

    def values(scene: Scene, size: float) -> Array:
        history = scene.history
        sampled, angle = scene.sampled, history.slider_joint_angle_rad[scene.rows, k]
        at = unit_range(angle, sampled.history.slider_joint_angle_rad[sampled.rows, k])
        way = np.tanh(history.slider_joint_rate_rad_s[scene.rows, k] / 0.005)
        return column(1e-3 * size * way * np.exp(-0.5 * ((at - place) / width) ** 2))

    same = Equivalent(
        "slider", "direction", (k + 1,), "the joint's angle follows its slider's position, and turns with it"
    )
    return Fault(Action("leg", (k,), values), (same,))


def _joint_eccentric(draw: Draw) -> Fault:
    """A slider joint's bearing runs out: the leg's length has a wave over the joint's angle."""
    k, order, phase = slider(draw), float(draw.uniform(2.0, 6.0)), draw.uniform(0.0, 2.0 * math.pi)

    def values(scene: Scene, size: float) -> Array:
        return column(1e-3 * size * np.sin(order * scene.history.slider_joint_angle_rad[scene.rows, k] + phase))

    same = (
        Equivalent("slider", "position", (k + 1,), "the joint's angle follows its slider's position"),
        Equivalent("leg", "position", (k + 1,), "the joint's angle follows its slider's position"),
    )
    return Fault(Action("leg", (k,), values), same)


def _joint_unloads(draw: Draw) -> Fault:
    """A preloaded joint gives only beyond a load."""
    k, threshold = slider(draw), float(draw.uniform(0.2, 0.6))

    def values(scene: Scene, size: float) -> Array:
        whole = scene.sampled.history.leg_force_n(scene.sampled.rows)[:, k]
        over = scene.history.leg_force_n(scene.rows)[:, k] - np.quantile(whole, threshold)
        return column(-1e-3 * size * np.maximum(over, 0.0) / np.ptp(whole))

    same = Equivalent("leg", "joint_angle", (k + 1,), "on these circles a leg's load follows its leaning")
    return Fault(Action("leg", (k,), values), (same, _foot_of(k, "leg_force"), _foot_of(k, "position")))


# --- platform ---------------------------------------------------------------------------------------------------------


def _plate_bends(draw: Draw) -> Fault:
    """The corner of the platform that holds one pair's joint hangs down as the platform tilts."""
    corner, axis, sign = int(draw.integers(0, 3)), int(draw.integers(0, 2)), signed(draw)

    def values(scene: Scene, size: float) -> Array:
        leaning = scene.history.rotation[scene.rows, 2, axis]
        bent = np.zeros((len(scene.rows), 6))
        bent[:, [2, 5]] = column(sign * 1e-3 * size * np.abs(leaning) / 0.2)
        return bent

    pair = (2 * corner + 1, 2 * corner + 2)
    same = (
        Equivalent("leg", "tilt", pair, "the pair's joint moves mostly along its two legs"),
        Equivalent("ball", "tilt", None, "the platform turns about its other corners: the ball moves"),
        Equivalent("cup", "tilt", None, "the platform turns about its other corners: the ball moves"),
    )
    return Fault(Action("platform_joint", (2 * corner, 2 * corner + 1), values), same)


def _cable_drags(draw: Draw) -> Fault:
    """The cable pulls the platform aside the more it is yawed: legs give under the force."""
    pull, rest = draw.uniform(0.0, 2.0 * math.pi), float(draw.uniform(-0.3, 0.3))
    force = np.array([math.cos(pull), math.sin(pull), 0.0])

    def values(scene: Scene, size: float) -> Array:
        history, rows = scene.history, scene.rows
        unit = history.leg_direction[rows]
        arms = history.nominal.joints_mm @ np.swapaxes(history.rotation[rows], 1, 2)
        yaw = np.arctan2(history.rotation[rows, 1, 0], history.rotation[rows, 0, 0])
        load = np.zeros((len(rows), 6, 1))
        load[:, :3, 0] = column(rest + yaw / 0.2) * force
        wrench = np.concatenate([unit, np.cross(arms, unit)], axis=2)
        return 1e-3 * size * np.linalg.solve(np.swapaxes(wrench, 1, 2), load)[:, :, 0]

    same = (
        Equivalent("load", "yaw", None, "it is a load on the platform, shared among the legs"),
        Equivalent("ball", "yaw", None, "all legs together move the platform as a whole"),
        Equivalent("cup", "yaw", None, "all legs together move the platform as a whole"),
        Equivalent("reading", "yaw", None, "what the ball's motion does to the reading"),
    )
    return Fault(Action("leg", tuple(range(6)), values), same)


TABLE: dict[str, Outside] = {
    "dent": Outside("um", 20.0, 2000.0, ("position",), _dent),
    "rail_waves": Outside("um", 15.0, 1000.0, ("position",), _rail_waves),
    "guideway_warms": Outside("um", 50.0, 2000.0, ("time", "position"), _guideway_warms),
    "leg_slips": Outside("um", 10.0, 1500.0, ("time",), _leg_slips),
    "leg_warms": Outside("um", 15.0, 1500.0, ("time",), _leg_warms),
    "joint_sticks": Outside("um", 8.0, 1000.0, ("joint_angle", "joint_turning"), _joint_sticks),
    "joint_eccentric": Outside("um", 15.0, 1000.0, ("joint_angle",), _joint_eccentric),
    "joint_unloads": Outside("um", 15.0, 1500.0, ("leg_force",), _joint_unloads),
    "plate_bends": Outside("um", 30.0, 2000.0, ("tilt",), _plate_bends),
    "cable_drags": Outside("um", 15.0, 1500.0, ("yaw",), _cable_drags, "varied"),
}
"""Kinds by name."""
