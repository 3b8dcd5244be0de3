"""Faults outside the catalogue of controllers, encoders and screws.

With those of `outside_blind_three_structure` and `outside_blind_three_measuring` they were written without knowledge of
the verdicts' rules and of the estimator's effects. They couple axes, remember, or depend on place and load together.
"""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, slider, waves
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.history import History
from hexdbb_truth.forms.labels import Equivalent, leg_too
from hexdbb_truth.forms.ports import Action, Scene, unit_range

CREEP_MM_S = 0.2
"""Speed of a slider over which friction turns over with it: 1 % of what it has in the middle of a slow circle."""

# --- controller and encoder -------------------------------------------------------------------------------------------


def _table_of_other_axis(draw: Draw) -> Fault:
    """A wrong index: a slider's compensation table is looked up at the position of a slider on another guideway.

    Its screw's own error stays, and the same error taken at the other's place is subtracted.
    """
    k = slider(draw)
    other = (2 * (k // 2) + int(draw.integers(2, 6))) % 6
    error = waves(draw, 1.0, 3.0)

    def values(scene: Scene, size: float) -> Array:
        return column(0.5e-3 * size * (error(scene.place(k)) - error(scene.place(other))))

    why = "on a circle both sliders' positions follow the bar's angle"
    angle = tuple(Equivalent(port, "angle", (k + 1,), why) for port in ("slider", "leg"))
    return Fault(Action("slider", (k,), values), (leg_too(k, "position"), *angle))


def _vernier_slips(draw: Draw) -> Fault:
    """An absolute encoder compares two tracks; where one is dirty it takes the next period of the other for its own.

    The tracks are read one after the other, so that such a stretch begins and ends later the faster the slider goes.
    Size: that period.
    """
    k, late_s = slider(draw), float(draw.uniform(0.02, 0.1))
    number = int(draw.integers(2, 4))
    places, halves = np.sort(draw.uniform(-0.8, 0.8, number)), draw.uniform(0.04, 0.12, number)
    signs = draw.choice([-1.0, 1.0], number)

    def values(scene: Scene, size: float) -> Array:
        seen = scene.drive_mm(k) - late_s * scene.history.velocity_mm_s[scene.rows, k]
        at = unit_range(seen, scene.sampled.drive_mm(k))
        periods = sum(sign * (np.abs(at - p) < half) for p, half, sign in zip(places, halves, signs, strict=True))
        return column(1e-3 * size * periods)

    angle = Equivalent("leg", "joint_angle", (k + 1,), "the joint's angle follows its slider's position")
    return Fault(Action("slider", (k,), values), (leg_too(k, "position"), angle))


def _chords_for_arc(draw: Draw) -> Fault:
    """The controller splits the circle at even angles and drives all sliders straight from knot to knot.

    Size: how far the slider that errs most stands from its place in the middle of a chord, what smoothing leaves of it.
    """
    step_rad, first = 2.0 * math.pi / float(draw.integers(20, 49)), float(draw.uniform(0.0, 1.0))

    def chords_mm(history: History) -> Array:
        off = np.zeros_like(history.drive_mm)
        for run in history.runs:
            rows = np.flatnonzero(history.run == run.sweep)
            turned = history.angle_rad[rows] * run.direction
            whole = np.arange(math.ceil(turned[0] / step_rad - first), turned[-1] / step_rad - first)
            knots = np.concatenate([turned[:1], (whole + first) * step_rad, turned[-1:]])
            for k in range(6):
                drive = history.drive_mm[rows, k]
                off[rows, k] = np.interp(turned, knots, np.interp(knots, turned, drive)) - drive
        return off

    def values(scene: Scene, size: float) -> Array:
        sampled = scene.sampled
        largest = float(np.abs(chords_mm(sampled.history)[sampled.rows]).max())
        return np.asarray(1e-3 * size * chords_mm(scene.history)[scene.rows] / largest)

    why = "all sliders together drive the ball along a chord, and the knots stand at angles of the circle"
    same = tuple(Equivalent(port, "angle", None, why) for port in ("reading", "ball", "cup"))
    return Fault(Action("slider", tuple(range(6)), values), same)


def _buses_beat(draw: Draw) -> Fault:
    """Three drives hang on a second bus whose clock runs a little slow: they follow later and later, up to one cycle.

    Size: that cycle; then they miss one and are in time again.
    """
    three = ((0, 1, 2), (3, 4, 5), (0, 2, 4), (1, 3, 5))[int(draw.integers(4))]
    period_s, phase = float(draw.uniform(60.0, 400.0)), float(draw.uniform(0.0, 1.0))

    def values(scene: Scene, size: float) -> Array:
        late_s = 1e-3 * size * ((scene.time_s / period_s + phase) % 1.0)
        return np.asarray(-column(late_s) * scene.history.velocity_mm_s[scene.rows][:, three])

    same = Equivalent("leg", "velocity", tuple(k + 1 for k in three), "one slider moves one leg")
    return Fault(Action("slider", three, values), (same,))


# --- screws and rails -------------------------------------------------------------------------------------------------


def _screw_heats_where_used(draw: Draw) -> Fault:
    """A tight nut heats its screw where it works; the heat spreads along it and goes into the air.

    The slider is off by the growth between the fixed bearing and the nut, largest first where it has worked hard.
    """
    k, fixed_low, air_s = slider(draw), bool(draw.integers(2)), float(draw.uniform(400.0, 1500.0))

    def values(scene: Scene, size: float) -> Array:
        sampled = scene.sampled
        largest = float(np.abs(_grown(sampled.history, k, fixed_low, air_s)[sampled.rows]).max())
        return column(1e-3 * size * _grown(scene.history, k, fixed_low, air_s)[scene.rows] / largest)

    why = "one slowly pushed leg carries the ball nearly alike all over these circles"
    same = (
        Equivalent("slider", "time", (k + 1,), "the same growth, evenly along the screw", "screw_thermal"),
        leg_too(k, "time"),
        Equivalent("cup", "time", None, why),
        Equivalent("ball", "time", None, why),
    )
    return Fault(Action("slider", (k,), values), same)


CELLS, STEP_S, NUT_MM = 40, 1.0, 25.0
"""Cells of the screw, as long as half a nut; step of the diffusion, 1/30 of the largest stable one; half a nut."""
STEEL_MM2_S = 12.0
"""Thermal diffusivity of carbon steel."""


def _grown(history: History, k: int, fixed_low: bool, air_s: float) -> Array:
    """Return the growth between fixed bearing and nut at all instants, no unit; positive away from slider 0."""
    every = max(1, round(STEP_S / history.dt_s))
    low, high = history.machine.sliders.travels_mm[k]
    edges, cell_mm, step_s = np.linspace(low, high, CELLS + 1), (high - low) / CELLS, every * history.dt_s
    middles = 0.5 * (edges[1:] + edges[:-1])
    at, speed = history.drive_mm[::every, k], np.abs(history.velocity_mm_s[::every, k])
    heat = np.exp(-0.5 * ((middles - at[:, None]) / NUT_MM) ** 2) * speed[:, None]
    warm, grown = np.zeros(CELLS), np.zeros((len(at), CELLS + 1))
    for i, added in enumerate(heat):
        spread = np.diff(np.diff(warm), prepend=0.0, append=0.0) * STEEL_MM2_S / cell_mm**2
        warm = warm + step_s * (added - warm / air_s + spread)
        grown[i, 1:] = np.cumsum(warm)
    if not fixed_low:
        grown -= grown[:, -1:]
    rows, place = np.arange(len(history)) // every, (history.drive_mm[:, k] - low) / cell_mm
    cell = np.clip(place.astype(int), 0, CELLS - 1)
    return np.asarray(grown[rows, cell] + (place - cell) * (grown[rows, cell + 1] - grown[rows, cell]))


def _flank_held_by_load(draw: Draw) -> Fault:
    """A nut with play lies on that flank to which leg, balance spring and friction press it together.

    It changes flanks where the leg's push along the guideway passes the spring's, one way earlier than the other.
    Size: the play.
    """
    k, share = slider(draw), float(draw.uniform(0.35, 0.65))
    friction, soft = float(draw.uniform(0.03, 0.1)), float(draw.uniform(0.03, 0.08))

    def push_n(scene: Scene) -> Array:
        return np.asarray(scene.history.push_n[scene.rows, k])

    def values(scene: Scene, size: float) -> Array:
        whole, way = push_n(scene.sampled), np.tanh(scene.history.velocity_mm_s[scene.rows, k] / CREEP_MM_S)
        net = (push_n(scene) - np.quantile(whole, share)) / np.ptp(whole) - friction * way
        return column(0.5e-3 * size * np.tanh(net / soft))

    why = "the leg's push along the guideway follows where its slider stands"
    place = tuple(Equivalent(port, "position", (k + 1,), why) for port in ("slider", "leg"))
    return Fault(Action("slider", (k,), values), (leg_too(k, "leg_force"), leg_too(k, "direction"), *place))


TABLE: dict[str, Outside] = {
    "table_of_other_axis": Outside("um", 10.0, 300.0, ("position",), _table_of_other_axis),
    "vernier_slips": Outside("um", 10.0, 200.0, ("position",), _vernier_slips),
    "chords_for_arc": Outside("um", 10.0, 300.0, ("angle",), _chords_for_arc),
    "buses_beat": Outside("ms", 0.5, 20.0, ("velocity", "time"), _buses_beat),
    "screw_heats_where_used": Outside("um", 20.0, 300.0, ("time", "position"), _screw_heats_where_used),
    "flank_held_by_load": Outside("um", 10.0, 300.0, ("leg_force", "direction"), _flank_held_by_load),
}
"""Kinds by name."""
