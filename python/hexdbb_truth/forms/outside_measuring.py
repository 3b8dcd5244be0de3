"""Faults outside the catalogue of cup, ball, bar and gauge."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, signed, unit_vector
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.labels import Equivalent
from hexdbb_truth.forms.ports import Action, Scene

BAR = "the bar sees of a displacement what lies along it: a wave of the angle"


def _cup_rocks(draw: Draw) -> Fault:
    """The cup is loose in one direction: the friction of the turning bar carries it there, this way or that."""
    way, share = unit_vector(draw), float(draw.uniform(0.3, 0.7))
    way[2] *= 0.2

    def values(scene: Scene, size: float) -> Array:
        direction = scene.history.direction(scene.rows)
        tangent = np.cross([0.0, 0.0, 1.0], scene.history.bar_direction(scene.rows))
        return 1e-3 * size * column(direction * (1.0 - share + share * (tangent @ way))) * way

    same = (
        Equivalent("reading", "angle", None, BAR + " per direction"),
        Equivalent("ball", "direction", None, BAR + " per direction, while the platform is not turned"),
    )
    return Fault(Action("cup", (), values), same)


def _cup_slips(draw: Draw) -> Fault:
    """The cup shifts once and stays there."""
    way, moment = unit_vector(draw), draw.uniform(0.15, 0.85)
    way[2] *= 0.2

    def values(scene: Scene, size: float) -> Array:
        return 1e-3 * size * column((scene.time_s > moment * scene.duration_s()).astype(float)) * way

    return Fault(Action("cup", (), values), (_ball_too("time"),))


def _ball_too(variable: str) -> Equivalent:
    return Equivalent("ball", variable, None, "cup and ball move alike while the platform is not turned")


def _cup_settles(draw: Draw) -> Fault:
    """The cup's post warms and leans."""
    way, tau = unit_vector(draw), float(draw.uniform(200.0, 1200.0))
    way[2] *= 0.2
    return Fault(
        Action("cup", (), lambda scene, size: 1e-3 * size * column(-np.expm1(-scene.time_s / tau)) * way),
        (_ball_too("time"),),
    )


def _gauge_creeps(draw: Draw) -> Fault:
    """After each approach the gauge settles anew."""
    tau, sign = float(draw.uniform(4.0, 20.0)), signed(draw)

    def values(scene: Scene, size: float) -> Array:
        return column(sign * 1e-3 * size * np.exp(-scene.history.since_run_began_s(scene.rows) / tau))

    same = Equivalent("reading", "angle", None, "the time since a run began is its angle, at one feed and one lap")
    return Fault(Action("reading", (), values), (same,))


def _hum(draw: Draw) -> Fault:
    """A motor nearby: a tone in the gauge's signal, folded by sampling."""
    frequency, phase = float(draw.uniform(7.0, 60.0)), draw.uniform(0.0, 2.0 * math.pi)

    def values(scene: Scene, size: float) -> Array:
        return column(1e-3 * size * np.sin(2.0 * math.pi * frequency * scene.time_s + phase))

    return Fault(Action("reading", (), values))


def _ball_lobes(draw: Draw) -> Fault:
    """The ball is not round: lobes over the bar's direction in the platform."""
    lobes, phase = int(draw.integers(2, 8)), draw.uniform(0.0, 2.0 * math.pi)

    def values(scene: Scene, size: float) -> Array:
        bar = np.einsum("nij,ni->nj", scene.history.rotation[scene.rows], scene.history.bar_direction(scene.rows))
        return column(1e-3 * size * np.cos(lobes * np.arctan2(bar[:, 1], bar[:, 0]) + phase))

    return Fault(
        Action("reading", (), values), (Equivalent("ball", "angle", None, "along the bar, ball and reading are one"),)
    )


def _bar_whirls(draw: Draw) -> Fault:
    """The bar is drawn longer by its speed: more than in proportion, another value at each feed."""
    power = float(draw.uniform(1.5, 2.2))

    def values(scene: Scene, size: float) -> Array:
        return column(1e-3 * size * (scene.history.feed_mm_s(scene.rows) / 50.0) ** power)

    same = Equivalent("reading", "velocity", None, "the feed is the ball's velocity")
    return Fault(Action("reading", (), values), (same,))


def _gauge_jumps(draw: Draw) -> Fault:
    """A bad contact: the gauge's zero jumps back and forth."""
    seed, number = int(draw.integers(1 << 31)), int(draw.integers(2, 6))

    def values(scene: Scene, size: float) -> Array:
        moments = np.sort(np.random.default_rng(seed).uniform(0.05, 0.95, number))
        return column(1e-3 * size * (np.searchsorted(moments, scene.time_s / scene.duration_s()) % 2).astype(float))

    return Fault(Action("reading", (), values))


TABLE: dict[str, Outside] = {
    "cup_rocks": Outside("um", 5.0, 800.0, ("direction",), _cup_rocks),
    "cup_slips": Outside("um", 10.0, 800.0, ("time",), _cup_slips),
    "cup_settles": Outside("um", 10.0, 800.0, ("time",), _cup_settles),
    "gauge_creeps": Outside("um", 5.0, 800.0, ("time_in_run",), _gauge_creeps),
    "hum": Outside("um", 2.0, 300.0, ("time",), _hum),
    "ball_lobes": Outside("um", 3.0, 500.0, ("angle",), _ball_lobes),
    "bar_whirls": Outside("um", 5.0, 500.0, ("feed",), _bar_whirls),
    "gauge_jumps": Outside("um", 5.0, 500.0, ("time",), _gauge_jumps),
}
"""Kinds by name."""
