"""Faults outside the catalogue of guideways, legs and platform; see `outside_blind_three`."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, signed, slider, unit_vector
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.history import History, monotone
from hexdbb_truth.forms.labels import SAME_LEG, Equivalent, slider_too
from hexdbb_truth.forms.operators import lost_motion, lowpass, pushed_ahead, relay
from hexdbb_truth.forms.ports import Action, Scene

# --- guideways and base -----------------------------------------------------------------------------------------------


def _rail_creeps_in_bed(draw: Draw) -> Fault:
    """A guideway's rail is not pinned: friction in its bed holds it until both legs' push along it has changed enough.

    Then it follows the push, and both sliders go along. Size: from one end of its creeping to the other.
    """
    guideway, held = int(draw.integers(0, 3)), float(draw.uniform(0.1, 0.25))
    pair = (2 * guideway, 2 * guideway + 1)

    def crept(history: History, whole_n: Array) -> Array:
        push = history.push_n[:, list(pair)].sum(axis=1)
        return np.asarray(push + lost_motion(push, held * np.ptp(whole_n), monotone(push)))

    def values(scene: Scene, size: float) -> Array:
        sampled = scene.sampled
        whole_n = sampled.history.push_n[sampled.rows][:, pair].sum(axis=1)
        way = np.ptp(crept(sampled.history, whole_n)[sampled.rows])
        there = (crept(scene.history, whole_n)[scene.rows] - whole_n.mean()) / way
        return 1e-3 * size * column(there) * np.ones(2)

    why = "the push rises while its sliders go one way and falls while they go the other"
    both = (pair[0] + 1, pair[1] + 1)
    same = [Equivalent("slider", "velocity", both, why)]
    same += [Equivalent("leg", each, both, why) for each in ("direction", "velocity", "joint_turning", "leg_force")]
    same += [Equivalent("reading", each, None, why + ": a wave per direction") for each in ("angle", "direction")]
    return Fault(Action("slider", pair, values), tuple(same))


def _swarf_piles_up(draw: Draw) -> Fault:
    """Both carriages of a guideway push swarf in oil ahead to an end of their strokes, from where it slowly flows back.

    A carriage that comes near the pile climbs it; how far the strokes before went decides where it lies.
    """
    guideway, outward = int(draw.integers(0, 3)), signed(draw)
    back_mm_s, reach_mm = float(draw.uniform(0.02, 0.1)), float(draw.uniform(4.0, 12.0))

    def values(scene: Scene, size: float) -> Array:
        history, both = scene.history, np.zeros((len(scene.rows), 4))
        for j, way in enumerate((-outward, outward)):
            at = way * history.drive_mm[:, 2 * guideway + j]
            # It lies where the first circle, driven before, has left it.
            front = pushed_ahead(at, history.time_s, back_mm_s, float(at[history.run == 0].max()))
            off = (front - at)[scene.rows]
            both[:, 2 * j + 1] = 1e-3 * size * np.exp(-off / reach_mm)
        return both

    pair = (2 * guideway + 1, 2 * guideway + 2)
    same = tuple(Equivalent(port, "position", pair, SAME_LEG) for port in ("leg", "slider"))
    return Fault(Action("guideway", (guideway,), values), same)


def _sun_wanders(draw: Draw) -> Fault:
    """The sun through a window falls on one guideway's beam after another: each in turn warms, bows and cools again."""
    order, begin = draw.permutation(3), float(draw.uniform(0.1, 0.3))
    apart, width, tau = (
        float(draw.uniform(0.15, 0.25)),
        float(draw.uniform(0.06, 0.12)),
        float(draw.uniform(60.0, 250.0)),
    )
    angle = float(draw.uniform(0.2, 1.3))
    across = np.array([math.cos(angle), math.sin(angle)])

    def values(scene: Scene, size: float) -> Array:
        history, moved = scene.history, np.zeros((len(scene.rows), 12))
        for turn, guideway in enumerate(order):
            off = (history.time_s / scene.duration_s() - begin - apart * turn) / width
            warm = lowpass(np.exp(-0.5 * off**2), history.dt_s, tau)[scene.rows]
            moved[:, 4 * guideway : 4 * guideway + 4] = 1e-3 * size * column(warm) * np.tile(across, 2)
        return moved

    legs = "a guideway that moves pushes both its legs"
    whole = "guideways that move unlike each other move the platform as a body"
    same = [Equivalent(port, "time", tuple(range(1, 7)), legs) for port in ("leg", "slider")]
    same += [Equivalent(port, "time", None, whole) for port in ("cup", "ball")]
    return Fault(Action("guideway", (0, 1, 2), values), tuple(same))


# --- legs and platform ------------------------------------------------------------------------------------------------


def _leg_end_unscrews(draw: Draw) -> Fault:
    """A leg's end has lost its lock nut: as the platform turns about the leg's line, it turns in its thread, with play.

    The leg grows by the turn times the thread's lead over 2 pi. Size: at the largest turn.
    """
    k, sign, play = slider(draw), signed(draw), float(draw.uniform(0.1, 0.3))

    def twist_rad(history: History) -> Array:
        turn = history.rotation
        axis = np.stack(
            [turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]], 1
        )
        # A rotation's part about a line: tan(twist / 2) = (line . axis) sin(angle / 2) / cos(angle / 2).
        along = np.einsum("ni,ni->n", axis, history.leg_direction[:, k])
        return history.bridged(2.0 * np.arctan2(along, 1.0 + np.trace(turn, axis1=1, axis2=2)))

    def values(scene: Scene, size: float) -> Array:
        twist, sampled = twist_rad(scene.history), scene.sampled
        largest = float(np.abs(twist_rad(sampled.history)[sampled.rows]).max())
        turned = twist + lost_motion(twist, play * largest, monotone(twist))
        return column(sign * 1e-3 * size * turned[scene.rows] / largest)

    once = "each attitude of the platform is driven at a time of its own"
    whole = "one leg that is longer by the platform's attitude carries the ball nearly alike all round a circle"
    same = [slider_too(k, "yaw"), slider_too(k, "tilt")]
    same += [Equivalent(port, "time", (k + 1,), once) for port in ("leg", "slider")]
    same += [Equivalent(port, "tilt", None, whole) for port in ("cup", "ball")]
    return Fault(Action("leg", (k,), values), tuple(same))


def _seat_has_two_rests(draw: Draw) -> Fault:
    """The worn seat of a platform joint has two rests: the ball snaps over as its leg presses harder, and back later.

    Size: from one rest to the other.
    """
    k, way = slider(draw), unit_vector(draw)
    share, apart = float(draw.uniform(0.4, 0.6)), float(draw.uniform(0.04, 0.1))

    def values(scene: Scene, size: float) -> Array:
        sampled = scene.sampled
        whole = sampled.history.thrust_n[sampled.rows, k]
        over = relay(scene.history.thrust_n[:, k], *(float(np.quantile(whole, share + s * apart)) for s in (-1, 1)))
        return 1e-3 * size * column(over[scene.rows]) * way

    why = "its part along the leg is the leg's length"
    same = tuple(Equivalent(port, "leg_force", (k + 1,), why) for port in ("leg", "slider"))
    return Fault(Action("platform_joint", (k,), values), same)


def _platform_corner_swings(draw: Draw) -> Fault:
    """One of the two welds of a platform's corner is cracked: its legs swing the corner about the other weld.

    The crack opens as both together push across it beyond a preload. Size: under the largest push.
    """
    corner, share = int(draw.integers(0, 3)), float(draw.uniform(0.2, 0.5))
    held, legs = (corner + int(draw.integers(1, 3))) % 3, (2 * corner, 2 * corner + 1)

    def across(scene: Scene) -> Array:
        joints = scene.history.nominal.joints_mm
        side = joints[2 * corner] - joints[2 * held]
        return np.asarray(side / np.linalg.norm(side))

    def pushed_n(scene: Scene) -> Array:
        history, rows = scene.history, scene.rows
        along = history.platform_leg_direction(rows) @ across(scene) * history.thrust_n[rows]
        return np.asarray(along[:, legs].sum(axis=1))

    def values(scene: Scene, size: float) -> Array:
        whole = pushed_n(scene.sampled)
        preload = float(np.quantile(whole, share))
        opened = np.maximum(pushed_n(scene) - preload, 0.0) / (whole.max() - preload)
        return 1e-3 * size * column(opened) * np.tile(across(scene), 2)

    why = "the joint's motion is felt along its two legs"
    both, whole = (legs[0] + 1, legs[1] + 1), "the platform turns with its corner, nearly alike on all these circles"
    same = [Equivalent(port, "leg_force", both, why) for port in ("leg", "slider")]
    same += [Equivalent("leg", "position", both, why + ", whose load follows where they stand")]
    same += [Equivalent(port, "angle", None, whole) for port in ("ball", "cup")]
    return Fault(Action("platform_joint", legs, values), tuple(same))


TABLE: dict[str, Outside] = {
    "rail_creeps_in_bed": Outside("um", 15.0, 200.0, ("leg_force", "direction"), _rail_creeps_in_bed),
    "swarf_piles_up": Outside("um", 15.0, 300.0, ("position",), _swarf_piles_up),
    "sun_wanders": Outside("um", 20.0, 400.0, ("time",), _sun_wanders),
    "leg_end_unscrews": Outside("um", 10.0, 150.0, ("yaw", "tilt"), _leg_end_unscrews),
    "seat_has_two_rests": Outside("um", 10.0, 300.0, ("leg_force",), _seat_has_two_rests),
    "platform_corner_swings": Outside("um", 30.0, 300.0, ("leg_force",), _platform_corner_swings),
}
"""Kinds by name."""
