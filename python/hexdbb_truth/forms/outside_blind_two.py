"""Faults outside the catalogue that resemble what it has.

They were written without knowledge of the verdicts' rules and after the last of them was fixed; no rule was changed
for them.
"""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, signed, slider
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.history import History
from hexdbb_truth.forms.labels import SAME_LEG, Equivalent, leg_too, slider_too
from hexdbb_truth.forms.operators import lowpass
from hexdbb_truth.forms.ports import Action, Scene
from hexdbb_truth.forms.slider_forms import warmed

CREEP_MM_S = 0.2
"""Speed of a slider over which friction turns over with it."""


def _way(scene: Scene, k: int) -> Array:
    return np.asarray(np.tanh(scene.history.velocity_mm_s[scene.rows, k] / CREEP_MM_S))


# --- drives -----------------------------------------------------------------------------------------------------------


def _droops_when_pushed(draw: Draw) -> Fault:
    """A drive lacks current where its leg pushes hard along the guideway: only there it falls behind its speed."""
    k, share = slider(draw), float(draw.uniform(0.3, 0.6))

    def push_n(scene: Scene) -> Array:
        history, rows = scene.history, scene.rows
        return np.asarray(np.abs(history.leg_force_n(rows)[:, k] * np.cos(history.slider_joint_angle_rad[rows, k])))

    def values(scene: Scene, size: float) -> Array:
        sampled, whole = scene.sampled, push_n(scene.sampled)
        enough = float(np.quantile(whole, share))
        lacks = np.maximum(push_n(scene) - enough, 0.0) / (whole.max() - enough)
        largest = float(np.abs(sampled.history.velocity_mm_s[sampled.rows, k]).max())
        return column(-1e-3 * size * lacks * scene.history.velocity_mm_s[scene.rows, k] / largest)

    return Fault(Action("slider", (k,), values), (leg_too(k, "velocity"), leg_too(k, "leg_force")))


def _seal_runs_in(draw: Draw) -> Fault:
    """A new wiper drags at the carriage, one way and the other, until oil has wetted it in some minutes of work."""
    k, tau = slider(draw), float(draw.uniform(200.0, 700.0))

    def values(scene: Scene, size: float) -> Array:
        return column(-1e-3 * size * _way(scene, k) * np.exp(-scene.time_s / tau))

    return Fault(Action("slider", (k,), values), (leg_too(k, "direction"), leg_too(k, "time")))


# --- guideways --------------------------------------------------------------------------------------------------------


def _base_grows(draw: Draw) -> Fault:
    """The beams that hold the three guideways apart warm: all guideways move outward, while the legs stay cold."""
    tau = float(draw.uniform(400.0, 2500.0))

    def values(scene: Scene, size: float) -> Array:
        return np.asarray(1e-3 * size * column(warmed(scene, tau)) * np.tile([1.0, 0.0, 1.0, 0.0], 3))

    why = "guideways that move outward turn all legs as joints that move inward do"
    return Fault(Action("guideway", (0, 1, 2), values), (Equivalent("platform_joint", "time", None, why),))


def _carriages_skew(draw: Draw) -> Fault:
    """The screw drives beside the rail: friction skews both carriages in it, this way and that, and joints go across.

    Size: across, of each joint either way.
    """
    guideway, sign = int(draw.integers(0, 3)), signed(draw)

    def values(scene: Scene, size: float) -> Array:
        both = np.zeros((len(scene.rows), 4))
        for j in range(2):
            both[:, 2 * j] = sign * 1e-3 * size * _way(scene, 2 * guideway + j)
        return both

    why = "each leg feels what of the way across lies along it, and it leans nearly alike towards the guideway"
    same = Equivalent("leg", "direction", (2 * guideway + 1, 2 * guideway + 2), why)
    return Fault(Action("guideway", (guideway,), values), (same,))


def _carriage_nods(draw: Draw) -> Fault:
    """A rail waves between its bolts: both carriages nod as they pass, and their joints, standing high, sway.

    The rise itself is some times smaller than what a joint as high as the carriage is long makes of its slope.
    """
    guideway, bolts_mm = int(draw.integers(0, 3)), float(draw.uniform(60.0, 130.0))
    phase = draw.uniform(0.0, 2.0 * math.pi)
    pair = (2 * guideway, 2 * guideway + 1)

    def values(scene: Scene, size: float) -> Array:
        at = np.stack([scene.drive_mm(k) for k in pair], axis=1)
        return np.asarray(1e-3 * size * np.sin(2.0 * math.pi * at / bolts_mm + phase))

    same = Equivalent("leg", "position", (pair[0] + 1, pair[1] + 1), SAME_LEG)
    return Fault(Action("slider", pair, values), (same,))


# --- legs and platform ------------------------------------------------------------------------------------------------


def _leg_yields_late(draw: Draw) -> Fault:
    """A rubber washer in a leg's end yields under the leg's load, but only seconds after the load has changed."""
    k, tau = slider(draw), float(draw.uniform(3.0, 12.0))

    def load_n(history: History) -> Array:
        # Between runs the load goes evenly from one pose to the next.
        force = history.leg_force_n(history.samples)[:, k]
        whole = np.interp(np.arange(len(history)), history.samples, force)
        return lowpass(whole, history.dt_s, tau)

    def values(scene: Scene, size: float) -> Array:
        sampled = scene.sampled
        force = sampled.history.leg_force_n(sampled.rows)[:, k]
        return column(-1e-3 * size * (load_n(scene.history)[scene.rows] - force.mean()) / np.ptp(force))

    return Fault(Action("leg", (k,), values), (slider_too(k, "leg_force"),))


def _pair_joint_hangs_back(draw: Draw) -> Fault:
    """The worn ball that holds both legs of a pair has play: the platform runs ahead of it by that, wherever it goes.

    Size: half the play.
    """
    first = 2 * int(draw.integers(0, 3))

    def values(scene: Scene, size: float) -> Array:
        history, rows = scene.history, scene.rows
        course = np.cross([0.0, 0.0, 1.0], history.bar_direction(rows)) * history.direction(rows)[:, None]
        behind = -1e-3 * size * np.einsum("nij,ni->nj", history.rotation[rows], course)
        return np.hstack([behind, behind])

    same = (
        Equivalent("leg", "direction", (first + 1, first + 2), "the joint's motion is felt along its two legs"),
        Equivalent("leg", "angle", (first + 1, first + 2), "the joint's motion is felt along its two legs"),
        Equivalent("reading", "angle", None, "a wave of the angle per direction, nearly the same on all circles"),
    )
    return Fault(Action("platform_joint", (first, first + 1), values), same)


# --- set-up and gauge -------------------------------------------------------------------------------------------------


def _stand_tips(draw: Draw) -> Fault:
    """The stand has a short foot: it tips onto it as the platform goes that way, and the cup on the floor stays."""
    angle, rise = float(draw.uniform(0.0, 2.0 * math.pi)), float(draw.uniform(0.3, 0.9))
    share, foot = float(draw.uniform(-0.3, 0.4)), np.array([math.cos(angle), math.sin(angle), 0.0])
    way = -math.sqrt(1.0 - rise**2) * foot + rise * np.array([0.0, 0.0, 1.0])

    def out_mm(scene: Scene) -> Array:
        return np.asarray(scene.history.position_mm[scene.rows] @ foot)

    def values(scene: Scene, size: float) -> Array:
        whole = out_mm(scene.sampled)
        edge = share * np.abs(whole).max()
        return 1e-3 * size * column(np.maximum(out_mm(scene) - edge, 0.0) / (whole.max() - edge)) * way

    same = (
        Equivalent("ball", "angle", None, "cup and ball move alike, seen from the base"),
        Equivalent("reading", "angle", None, "the bar sees what lies along it"),
    )
    return Fault(Action("cup", (), values), same)


def _ball_is_dragged_round(draw: Draw) -> Fault:
    """A ball off its stem's axis is loose in its clamp: the bar's friction drags it round by a share of its turning."""
    share, phase = float(draw.uniform(0.04, 0.15)), float(draw.uniform(0.0, 2.0 * math.pi))

    def turned(history: History) -> Array:
        # Between runs nothing turns; every run goes on from where the last one left the ball.
        steps = np.diff(history.angle_rad, prepend=history.angle_rad[0])
        going = (history.run >= 0) & (np.roll(history.run, 1) == history.run)
        return np.cumsum(np.where(going, steps, 0.0))

    def values(scene: Scene, size: float) -> Array:
        at = phase + share * turned(scene.history)[scene.rows]
        return 1e-3 * size * np.stack([np.cos(at), np.sin(at), np.zeros_like(at)], axis=1)

    along, alike = "along the bar, ball and reading are one", "cup and ball move alike while the platform is not turned"
    same = [
        Equivalent(port, variable, None, why)
        for port, why in (("reading", along), ("cup", alike))
        for variable in ("time", "angle")
    ]
    return Fault(Action("ball", (), values), tuple(same))


def _gain_swings(draw: Draw) -> Fault:
    """The gauge's supply swings as other machines draw on the mains, and the gauge's gain swings with it."""
    period_s, phase = float(draw.uniform(250.0, 900.0)), float(draw.uniform(0.0, 2.0 * math.pi))

    def values(scene: Scene, size: float) -> Array:
        swing = np.sin(2.0 * math.pi * scene.time_s / period_s + phase)
        return column(1e-2 * size * swing * scene.deflection_mm)

    return Fault(Action("reading", (), values))


TABLE: dict[str, Outside] = {
    "droops_when_pushed": Outside("um", 20.0, 800.0, ("velocity", "leg_force"), _droops_when_pushed),
    "seal_runs_in": Outside("um", 10.0, 400.0, ("direction", "time"), _seal_runs_in),
    "base_grows": Outside("um", 40.0, 300.0, ("time",), _base_grows, "tilted"),
    "carriages_skew": Outside("um", 10.0, 300.0, ("direction",), _carriages_skew),
    "carriage_nods": Outside("um", 15.0, 300.0, ("position",), _carriage_nods),
    "leg_yields_late": Outside("um", 20.0, 600.0, ("leg_force",), _leg_yields_late),
    "pair_joint_hangs_back": Outside("um", 10.0, 300.0, ("direction", "angle"), _pair_joint_hangs_back),
    "stand_tips": Outside("um", 15.0, 500.0, ("position", "angle"), _stand_tips),
    "ball_is_dragged_round": Outside("um", 15.0, 300.0, ("time", "angle"), _ball_is_dragged_round),
    "gain_swings": Outside("%", 1.0, 10.0, ("deflection", "time"), _gain_swings, "varied"),
}
"""Kinds by name."""
