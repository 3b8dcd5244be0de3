"""Forms of what happens where a slider turns round: play, stiction."""

from __future__ import annotations

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, Exact, Family, bumpless, column, signed, slider
from hexdbb_truth.forms.history import History
from hexdbb_truth.forms.operators import Release, lost_motion, presliding, windup
from hexdbb_truth.forms.ports import Scene, Values, unit_range

LEAST_PLAY = 0.05
"""Smallest part of the nominal play: it never closes altogether where a form makes it vary."""

# --- backlash ---------------------------------------------------------------------------------------------------------


def _backlash(draw: Draw) -> Exact:
    k = slider(draw)
    return Exact("slider", (k,), lambda scene, size: _play(scene, k, size, None))


def _play(scene: Scene, k: int, size: float, shape: Array | None) -> Array:
    """Play of `size` um, times 1 + shape along the whole history."""
    history = scene.history
    half = 0.5e-3 * size
    width = half if shape is None else half * np.maximum(1.0 + shape, LEAST_PLAY)
    return column(lost_motion(history.drive_mm[:, k], width, history.pieces(k))[scene.rows])


def _whole_place(scene: Scene, k: int) -> Array:
    drive = scene.history.drive_mm[:, k]
    return unit_range(drive, scene.sampled.drive_mm(k))


def _play_by_place(draw: Draw, exact: Exact) -> Values:
    """The nut is worn more towards one end or in the middle."""
    (k,), shape = exact.elements, bumpless(draw, (1, 2, 3))
    return lambda scene, size: _play(scene, k, size, 0.5 * shape(_whole_place(scene, k)))


def _play_by_direction_and_place(draw: Draw, exact: Exact) -> Values:
    """The two flanks are worn unlike each other."""
    (k,), there, back = exact.elements, bumpless(draw, (1, 2)), bumpless(draw, (1, 2))

    def values(scene: Scene, size: float) -> Array:
        forward = np.gradient(scene.history.drive_mm[:, k]) > 0.0
        place = _whole_place(scene, k)
        return _play(scene, k, size, 0.5 * np.where(forward, there(place), back(place)))

    return values


def _play_worn(draw: Draw, exact: Exact) -> Values:
    """A stretch where the machine mostly works is worn."""
    (k,), centre, width = exact.elements, draw.uniform(-0.6, 0.6), draw.uniform(0.2, 0.5)

    def values(scene: Scene, size: float) -> Array:
        worn = np.exp(-0.5 * ((_whole_place(scene, k) - centre) / width) ** 2)
        return _play(scene, k, size, 1.5 * worn - 0.5)

    return values


def _play_elastic(draw: Draw, exact: Exact) -> Values:
    """The flank gives: the last of the play closes only within millimetres of travel."""
    (k,), stretch = exact.elements, float(draw.uniform(4.0, 25.0))

    def values(scene: Scene, size: float) -> Array:
        history = scene.history
        return column(-0.5e-3 * size * presliding(history.drive_mm[:, k], history.pieces(k), stretch)[scene.rows])

    return values


# --- reversal_spike ---------------------------------------------------------------------------------------------------


def _spike(draw: Draw) -> Exact:
    k, tau = slider(draw), float(draw.uniform(0.15, 0.6))

    def formula(scene: Scene, size: float) -> Array:
        return _stuck(scene, k, size, lambda since: np.exp(-since / tau))

    def slower(scene: Scene, size: float) -> Array:
        return _stuck(scene, k, size, lambda since: np.exp(-since / (1.1 * tau))) - formula(scene, size)

    return Exact("slider", (k,), formula, (slower,), {"tau_s": tau})


def _stuck(scene: Scene, k: int, size: float, release: Release, shape: Array | float = 0.0) -> Array:
    """Windup of `size` um times 1 + shape (by reversal)."""
    history = scene.history
    heights = 1e-3 * size * np.maximum(1.0 + shape, LEAST_PLAY)
    wound = windup(history.drive_mm[:, k], history.time_s, history.pieces(k), heights, release)
    return column(-wound[scene.rows])


def _tau(exact: Exact) -> float:
    assert exact.known is not None
    return exact.known["tau_s"]


def _spike_by_place(draw: Draw, exact: Exact) -> Values:
    """Friction differs along the guideway."""
    (k,), tau, shape = exact.elements, _tau(exact), bumpless(draw, (1, 2))

    def values(scene: Scene, size: float) -> Array:
        place = _whole_place(scene, k)[scene.history.pieces(k).begin]
        return _stuck(scene, k, size, lambda since: np.exp(-since / tau), 0.7 * shape(place))

    return values


def _spike_by_direction(draw: Draw, exact: Exact) -> Values:
    """It sticks more one way than the other, and each reversal a little otherwise."""
    (k,), tau, way, seed = exact.elements, _tau(exact), signed(draw), int(draw.integers(1 << 31))

    def values(scene: Scene, size: float) -> Array:
        sign = scene.history.pieces(k).sign
        each = np.random.default_rng(seed).normal(0.0, 0.3, len(sign))
        return _stuck(scene, k, size, lambda since: np.exp(-since / tau), 0.6 * way * sign + each)

    return values


def _spike_two_decays(draw: Draw, exact: Exact) -> Values:
    """After the breakaway the rest of the windup creeps."""
    (k,), tau, share = exact.elements, _tau(exact), float(draw.uniform(0.3, 0.6))
    slow = tau * float(draw.uniform(4.0, 10.0))
    return lambda scene, size: _stuck(
        scene, k, size, lambda since: (1.0 - share) * np.exp(-since / tau) + share * np.exp(-since / slow)
    )


def _turning(history: History, k: int) -> Array:
    """Return the acceleration of a drive at each of its reversals."""
    size: Array = np.abs(history.acceleration_mm_s2[history.pieces(k).begin, k])
    return size


def _spike_by_speed(draw: Draw, exact: Exact) -> Values:
    """The faster the drive turns over, the sooner the slider breaks away; released by a power law."""
    (k,), tau, power = exact.elements, _tau(exact), float(draw.uniform(1.0, 2.0))

    def values(scene: Scene, size: float) -> Array:
        history = scene.history
        turning, usual = _turning(history, k), _turning(scene.sampled.history, k)
        shape = -0.5 * turning / (turning + float(np.median(usual)))
        return _stuck(scene, k, size, lambda since: (1.0 + since / tau) ** -power, shape)

    return values


FAMILIES: dict[str, Family] = {
    "backlash": Family(
        "um",
        15.0,
        1000.0,
        _backlash,
        (_play_by_place, _play_by_direction_and_place),
        (_play_worn, _play_elastic),
    ),
    "reversal_spike": Family(
        "um", 25.0, 500.0, _spike, (_spike_by_place, _spike_by_direction), (_spike_two_decays, _spike_by_speed)
    ),
}
