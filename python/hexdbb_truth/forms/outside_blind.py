"""Faults outside the catalogue that wear, warmth, load and shaking make: at drives, guideways, legs, set-up, gauge."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, signed, slider, unit_vector
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.history import History, monotone
from hexdbb_truth.forms.labels import Equivalent, leg_too, slider_too
from hexdbb_truth.forms.operators import lost_motion, lowpass
from hexdbb_truth.forms.ports import Action, Scene

# --- drives -----------------------------------------------------------------------------------------------------------


def _ball_chipped(draw: Draw) -> Fault:
    """A chipped ball of the nut comes round once in five to nine turns of the screw and lets the slider dip."""
    k, period_mm = slider(draw), float(draw.uniform(27.0, 43.0))
    phase, width = float(draw.uniform(0.0, 1.0)), float(draw.uniform(0.06, 0.12))

    def values(scene: Scene, size: float) -> Array:
        off = (scene.drive_mm(k) / period_mm + phase) % 1.0 - 0.5
        return column(-1e-3 * size * np.exp(-0.5 * (off / width) ** 2))

    return Fault(Action("slider", (k,), values), (leg_too(k, "position"),))


def _motor_warms(draw: Draw) -> Fault:
    """A motor heats itself by its work, then the block of the screw's bearing, which carries the slider along."""
    k, sign = slider(draw), signed(draw)
    motor_s, block_s = float(draw.uniform(40.0, 120.0)), float(draw.uniform(300.0, 900.0))

    def warmth(history: History) -> Array:
        # Cold before the first instant.
        heat = np.concatenate([[0.0], history.velocity_mm_s[:, k] ** 2])
        return lowpass(lowpass(heat, history.dt_s, motor_s), history.dt_s, block_s)[1:]

    def values(scene: Scene, size: float) -> Array:
        sampled = scene.sampled
        largest = float(warmth(sampled.history)[sampled.rows].max())
        return column(sign * 1e-3 * size * warmth(scene.history)[scene.rows] / largest)

    why = "one slowly pushed leg carries the ball nearly alike all over these circles"
    same = tuple(Equivalent(port, "time", None, why) for port in ("cup", "ball"))
    return Fault(Action("slider", (k,), values), (leg_too(k, "time"), *same))


def _drive_pulls_weaker(draw: Draw) -> Fault:
    """One half of a drive's amplifier is weak: the slider falls behind its speed one way and follows the other way."""
    k, way = slider(draw), signed(draw)

    def values(scene: Scene, size: float) -> Array:
        sampled = scene.sampled
        largest = float(np.abs(sampled.history.velocity_mm_s[sampled.rows, k]).max())
        there = np.maximum(way * scene.history.velocity_mm_s[scene.rows, k], 0.0)
        return column(-way * 1e-3 * size * there / largest)

    return Fault(Action("slider", (k,), values), (leg_too(k, "velocity"),))


# --- guideways --------------------------------------------------------------------------------------------------------


def _carriages_tip(draw: Draw) -> Fault:
    """The carriages of a guideway have lost their preload: each tips in its clearance when its leg presses harder."""
    guideway, across = int(draw.integers(0, 3)), unit_vector(draw, 2)
    share, soft = float(draw.uniform(0.3, 0.7)), float(draw.uniform(0.03, 0.1))

    def pressed(scene: Scene) -> Array:
        force, angle = scene.history.leg_force_n(scene.rows), scene.history.slider_joint_angle_rad[scene.rows]
        return np.asarray((force * np.sin(angle))[:, 2 * guideway : 2 * guideway + 2])

    def values(scene: Scene, size: float) -> Array:
        whole, now = pressed(scene.sampled), pressed(scene)
        over = (now - np.quantile(whole, share)) / (soft * np.ptp(whole))
        return np.hstack([0.5e-3 * size * column(1.0 + np.tanh(over[:, j])) * across for j in range(2)])

    return Fault(Action("guideway", (guideway,), values))


def _beam_sags(draw: Draw) -> Fault:
    """The beam under a guideway sags under what its two sliders carry, by where each of them stands.

    Size: in the middle, under a third of the machine's weight there.
    """
    guideway, beyond_mm = int(draw.integers(0, 3)), float(draw.uniform(20.0, 100.0))
    pair = (2 * guideway, 2 * guideway + 1)

    def values(scene: Scene, size: float) -> Array:
        history, rows = scene.history, scene.rows
        low, high = history.machine.sliders.guideway_travels_mm[guideway]
        length = high - low + 2.0 * beyond_mm
        load = history.leg_force_n(rows) * history.leg_direction[rows, :, 2] / (history.nominal.weight_n / 3.0)
        at = {k: (scene.drive_mm(k) - low + beyond_mm) / length for k in pair}
        both = np.zeros((len(rows), 4))
        for j, here in enumerate(pair):
            both[:, 2 * j + 1] = -1e-3 * size * sum(load[:, k] * _sag(at[here], at[k]) for k in pair)
        return both

    return Fault(Action("guideway", (guideway,), values))


def _sag(at: Array, load_at: Array) -> Array:
    """Return the sag of a beam on two supports under one load, places as shares of its length; 1 in the middle."""
    near, far = np.minimum(at, load_at), 1.0 - np.maximum(at, load_at)
    return np.asarray(8.0 * near * far * (1.0 - near**2 - far**2))


# --- legs and platform ------------------------------------------------------------------------------------------------


def _boot_relaxes(draw: Draw) -> Fault:
    """The rubber boot of a slider joint presses on the leg when the joint has turned, and relaxes within seconds."""
    k, tau, sign = slider(draw), float(draw.uniform(5.0, 25.0)), signed(draw)

    def strain(history: History) -> Array:
        angle = history.slider_joint_angle_rad[:, k]
        return np.asarray(angle - lowpass(angle, history.dt_s, tau))

    def values(scene: Scene, size: float) -> Array:
        sampled = scene.sampled
        largest = float(np.abs(strain(sampled.history)[sampled.rows]).max())
        return column(sign * 1e-3 * size * strain(scene.history)[scene.rows] / largest)

    same = (slider_too(k, "joint_angle"), slider_too(k, "joint_turning"))
    return Fault(Action("leg", (k,), values), same)


def _hose_tautens(draw: Draw) -> Fault:
    """A hose tied to both legs of a pair hangs slack until they spread, then presses both shorter."""
    first, share = 2 * int(draw.integers(0, 3)), float(draw.uniform(0.4, 0.7))
    pair = (first, first + 1)

    def values(scene: Scene, size: float) -> Array:
        # Over the gap of the sliders each leg's angle to the guideway follows: the pair meets in one joint.
        whole = np.abs(scene.sampled.drive_mm(first) - scene.sampled.drive_mm(first + 1))
        gap, slack = np.abs(scene.drive_mm(first) - scene.drive_mm(first + 1)), float(np.quantile(whole, share))
        taut = np.maximum(gap - slack, 0.0) / (whole.max() - slack)
        return -1e-3 * size * column(taut) * np.ones(2)

    why = "two feet that spread lower their legs' joint as two shorter legs do"
    same = (Equivalent("slider", each, (first + 1, first + 2), why) for each in ("gap", "joint_angle"))
    return Fault(Action("leg", pair, values), tuple(same))


def _plate_warms(draw: Draw) -> Fault:
    """A spindle warms the platform's middle, later its rim: all joints move outward after a slow beginning."""
    quick, slow = float(draw.uniform(60.0, 250.0)), float(draw.uniform(500.0, 1500.0))

    def values(scene: Scene, size: float) -> Array:
        out = scene.history.nominal.joints_mm - scene.history.nominal.joints_mm.mean(axis=0)
        out = out / np.linalg.norm(out, axis=1).max()
        time_s = scene.time_s
        cold = (slow * np.exp(-time_s / slow) - quick * np.exp(-time_s / quick)) / (slow - quick)
        return np.asarray(1e-3 * size * column(1.0 - cold) * out.reshape(-1))

    same = (
        Equivalent("cup", "time", None, "legs whose ends spread let the platform sink: the cup rises"),
        Equivalent("reading", "time", None, "a platform that sinks changes the bar alike all round a circle"),
    )
    return Fault(Action("platform_joint", tuple(range(6)), values), same)


# --- set-up and gauge -------------------------------------------------------------------------------------------------


def _machine_rocks(draw: Draw) -> Fault:
    """The machine stands softly one way: its carriages' acceleration rocks it against the cup on the floor."""
    angle = float(draw.uniform(0.0, math.pi))
    way = np.array([math.cos(angle), math.sin(angle), 0.0])

    def kick(scene: Scene) -> Array:
        history = scene.history
        return np.asarray(history.acceleration_mm_s2[scene.rows] @ history.nominal.directions @ way)

    def values(scene: Scene, size: float) -> Array:
        largest = float(np.abs(kick(scene.sampled)).max())
        return np.asarray(1e-3 * size * column(kick(scene) / largest) * way)

    why = "cup and ball move alike while the platform is not turned"
    return Fault(Action("cup", (), values), (Equivalent("ball", "acceleration", None, why),))


def _floor_shakes(draw: Draw) -> Fault:
    """Traffic shakes the cup's table on its air springs now and then, and each time it swings out."""
    way, number = unit_vector(draw), int(draw.integers(8, 17))
    moments = np.sort(draw.uniform(0.02, 0.95, number))
    period_s, decay_s = float(draw.uniform(0.5, 1.2)), float(draw.uniform(2.0, 6.0))
    way[2] *= 0.5

    def values(scene: Scene, size: float) -> Array:
        swing = np.zeros(len(scene.rows))
        for moment in moments:
            since = np.maximum(scene.time_s - moment * scene.duration_s(), 0.0)
            swing += np.exp(-since / decay_s) * np.sin(2.0 * math.pi * since / period_s)
        return 1e-3 * size * column(swing) * way

    same = (
        Equivalent("ball", "time", None, "cup and ball move alike while the platform is not turned"),
        Equivalent("reading", "time", None, "while it swings the bar hardly turns at the slow feed"),
    )
    return Fault(Action("cup", (), values), same)


def _stem_sags(draw: Draw) -> Fault:
    """The ball's stem is loose in its clamp: as the platform tilts it sags that way, up to the clamp's clearance."""
    soft = float(draw.uniform(0.05, 0.15))

    def values(scene: Scene, size: float) -> Array:
        # What of the weight's direction lies in the platform.
        sideways = -scene.history.rotation[scene.rows, 2, :] * np.array([1.0, 1.0, 0.0])
        leaning = np.maximum(np.linalg.norm(sideways, axis=1), 1e-12)
        return np.asarray(1e-3 * size * column(np.tanh(leaning / soft) / leaning) * sideways)

    why = "the platform keeps its tilt for a circle: cup and ball move alike"
    return Fault(Action("ball", (), values), (Equivalent("cup", "tilt", None, why),))


def _lever_has_play(draw: Draw) -> Fault:
    """The gauge's worn lever has play, more where it is drawn out: it rests when the deflection turns, then follows.

    Size: half the play in the middle.
    """
    wear = float(draw.uniform(0.2, 0.6))

    def values(scene: Scene, size: float) -> Array:
        rows = scene.history.samples
        deflection = scene.deflect(rows)
        half = 1e-3 * size * (1.0 + wear * deflection / np.abs(scene.sampled.deflection_mm).max())
        behind = lost_motion(deflection, half, monotone(deflection))
        return column(np.interp(scene.rows, rows, behind))

    return Fault(Action("reading", (), values))


TABLE: dict[str, Outside] = {
    "ball_chipped": Outside("um", 15.0, 300.0, ("position",), _ball_chipped),
    "motor_warms": Outside("um", 15.0, 500.0, ("time", "velocity_lingering"), _motor_warms),
    "drive_pulls_weaker": Outside("um", 15.0, 800.0, ("velocity",), _drive_pulls_weaker),
    "carriages_tip": Outside("um", 15.0, 500.0, ("leg_force",), _carriages_tip),
    "beam_sags": Outside("um", 30.0, 600.0, ("position", "leg_force"), _beam_sags),
    "boot_relaxes": Outside("um", 10.0, 300.0, ("joint_angle", "joint_turning"), _boot_relaxes),
    "hose_tautens": Outside("um", 15.0, 600.0, ("gap", "joint_angle", "position"), _hose_tautens),
    "plate_warms": Outside("um", 20.0, 300.0, ("time",), _plate_warms),
    "machine_rocks": Outside("um", 8.0, 200.0, ("acceleration",), _machine_rocks),
    "floor_shakes": Outside("um", 15.0, 300.0, ("time",), _floor_shakes),
    "stem_sags": Outside("um", 10.0, 500.0, ("tilt",), _stem_sags, "varied"),
    "lever_has_play": Outside("um", 3.0, 200.0, ("deflection",), _lever_has_play),
}
"""Kinds by name."""
