"""Forms of what happens between drive and slider away from reversals: pitch, lead, lag, a warming screw."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, Exact, Family, bumpless, column, signed, slider, waves
from hexdbb_truth.forms.operators import lowpass
from hexdbb_truth.forms.ports import Scene, Values

# --- pitch_cyclic -----------------------------------------------------------------------------------------------------


def _pitch(draw: Draw) -> Exact:
    k, first, second = slider(draw), draw.uniform(0.0, 2.0 * math.pi), draw.uniform(0.0, 2.0 * math.pi)
    share = draw.uniform(0.1, 0.5)

    def formula(scene: Scene, size: float) -> Array:
        turn = _turn(scene, k)
        return column(1e-3 * size * (np.sin(turn + first) + share * np.sin(2.0 * turn + second)))

    others = tuple(_harmonic(k, order, phase) for order in (1, 2) for phase in (0.0, 0.5 * math.pi))
    return Exact("slider", (k,), formula, others, {"phase": first})


def _turn(scene: Scene, k: int) -> Array:
    return 2.0 * math.pi / scene.history.machine.sliders.screw_lead_mm * scene.drive_mm(k)


def _harmonic(k: int, order: int, phase: float) -> Values:
    return lambda scene, size: column(1e-3 * size * np.sin(order * _turn(scene, k) + phase))


def _pitch_third(draw: Draw, exact: Exact) -> Values:
    """A third harmonic."""
    (k,), phase = exact.elements, draw.uniform(0.0, 2.0 * math.pi)
    return _harmonic(k, 3, phase)


def _pitch_fading(draw: Draw, exact: Exact) -> Values:
    """The amplitude changes slowly along the screw."""
    (k,), shape, phase = exact.elements, bumpless(draw, (1, 2)), draw.uniform(0.0, 2.0 * math.pi)
    return lambda scene, size: column(1e-3 * size * shape(scene.place(k)) * np.sin(_turn(scene, k) + phase))


def _pitch_wandering(draw: Draw, exact: Exact) -> Values:
    """The phase wanders along the screw, as a lead that is not even makes it."""
    (k,), shape = exact.elements, waves(draw, 1.0, 3.0)
    assert exact.known is not None
    phase = exact.known["phase"]
    return lambda scene, size: column(1e-3 * size * np.sin(_turn(scene, k) + phase + 0.5 * shape(scene.place(k))))


def _pitch_sharp(draw: Draw, exact: Exact) -> Values:
    """A sharp error once per turn: harmonics 3 to 6."""
    (k,), heights = exact.elements, draw.uniform(0.5, 1.0, 4) / np.arange(1.0, 5.0)
    phases = draw.uniform(0.0, 2.0 * math.pi, 4)

    def values(scene: Scene, size: float) -> Array:
        turn = _turn(scene, k)
        waves_ = [h * np.sin((3 + j) * turn + phase) for j, (h, phase) in enumerate(zip(heights, phases, strict=True))]
        return column(1e-3 * size * np.sum(waves_, axis=0))

    return values


# --- lead_error -------------------------------------------------------------------------------------------------------


def _lead(draw: Draw) -> Exact:
    k, sign = slider(draw), signed(draw)
    return Exact("slider", (k,), lambda scene, size: column(sign * 1e-6 * size * _from_middle_mm(scene, k)))


def _from_middle_mm(scene: Scene, k: int) -> Array:
    return np.asarray(scene.drive_mm(k) - sum(scene.history.machine.sliders.travels_mm[k]) / 2.0)


def _shaped(exact: Exact, shape: object) -> Values:
    (k,) = exact.elements
    assert callable(shape)
    return lambda scene, size: column(0.1e-3 * size * shape(scene.place(k)))


def _lead_curved(draw: Draw, exact: Exact) -> Values:
    """The lead changes along the screw."""
    return _shaped(exact, bumpless(draw, (2, 3)))


def _lead_kinked(draw: Draw, exact: Exact) -> Values:
    """The screw has two stretches of unlike lead."""
    at, soft = draw.uniform(-0.5, 0.5), draw.uniform(0.05, 0.2)
    return _shaped(exact, lambda place: np.hypot(place - at, soft))


def _lead_wavy(draw: Draw, exact: Exact) -> Values:
    """Waves that are long against the lead."""
    return _shaped(exact, waves(draw, 1.2, 2.5))


# --- servo_lag --------------------------------------------------------------------------------------------------------


def _lag(draw: Draw) -> Exact:
    k = slider(draw)
    return Exact("slider", (k,), lambda scene, size: column(-1e-3 * size * _velocity(scene, k)))


def _velocity(scene: Scene, k: int) -> Array:
    return np.asarray(scene.history.velocity_mm_s[scene.rows, k])


def _lag_second_pole(draw: Draw, exact: Exact) -> Values:
    """A part follows through a slow pole."""
    (k,), tau = exact.elements, float(draw.uniform(0.2, 1.0))

    def values(scene: Scene, size: float) -> Array:
        history = scene.history
        return column(-1e-3 * size * lowpass(history.velocity_mm_s[:, k], history.dt_s, tau)[scene.rows])

    return values


def _lag_by_place(draw: Draw, exact: Exact) -> Values:
    """The loop is tuned at one place and slack at another."""
    (k,), shape = exact.elements, bumpless(draw, (1, 2))
    return lambda scene, size: column(-1e-3 * size * shape(scene.place(k)) * _velocity(scene, k))


def _lag_by_speed(draw: Draw, exact: Exact) -> Values:
    """The loop saturates: it lags more than in proportion at speed."""
    (k,), power = exact.elements, float(draw.uniform(1.6, 2.5))

    def values(scene: Scene, size: float) -> Array:
        velocity = _velocity(scene, k)
        return column(-1e-3 * size * np.sign(velocity) * np.abs(velocity / 30.0) ** power * 30.0)

    return values


def _lag_by_direction(draw: Draw, exact: Exact) -> Values:
    """It lags more one way than the other, and the more the harder it is accelerated."""
    (k,), way = exact.elements, signed(draw)

    def values(scene: Scene, size: float) -> Array:
        velocity = _velocity(scene, k)
        return column(-1e-3 * size * (way * np.abs(velocity) + 0.2 * scene.history.acceleration_mm_s2[scene.rows, k]))

    return values


# --- screw_thermal ----------------------------------------------------------------------------------------------------


def _screw_warm(draw: Draw) -> Exact:
    k, tau, sign = slider(draw), float(draw.uniform(600.0, 3000.0)), signed(draw)

    def grown(scene: Scene, size: float, constant_s: float) -> Array:
        return column(sign * 1e-6 * size * warmed(scene, constant_s) * _from_middle_mm(scene, k))

    def slower(scene: Scene, size: float) -> Array:
        return grown(scene, size, 1.1 * tau) - grown(scene, size, tau)

    return Exact("slider", (k,), lambda scene, size: grown(scene, size, tau), (slower,), {"warm_s": tau})


def warmed(scene: Scene, tau_s: float) -> Array:
    """Return the share of a rise in temperature that a body has followed."""
    return np.asarray(-np.expm1(-scene.time_s / tau_s))


def _screw_two_constants(draw: Draw, exact: Exact) -> Values:
    """The nut warms the screw quickly, the room slowly."""
    (k,), fast = exact.elements, float(draw.uniform(60.0, 200.0))
    return lambda scene, size: column(1e-6 * size * warmed(scene, fast) * _from_middle_mm(scene, k))


def _screw_held(draw: Draw, exact: Exact) -> Values:
    """It is held at an end, not in the middle: all of it moves as it grows."""
    tau = float(draw.uniform(400.0, 2500.0))
    return lambda scene, size: column(1e-4 * size * warmed(scene, tau))


def _screw_local(draw: Draw, exact: Exact) -> Values:
    """It is warm where the nut works, cold at its ends."""
    (k,), tau, shape = exact.elements, float(draw.uniform(300.0, 2000.0)), bumpless(draw, (2, 3))
    return lambda scene, size: column(1e-4 * size * warmed(scene, tau) * shape(scene.place(k)))


def _screw_cooled(draw: Draw, exact: Exact) -> Values:
    """Its temperature swings with the cooling."""
    (k,), swing = exact.elements, waves(draw, 300.0, 900.0)
    return lambda scene, size: column(1e-6 * size * swing(scene.time_s) * _from_middle_mm(scene, k))


FAMILIES: dict[str, Family] = {
    "pitch_cyclic": Family("um", 8.0, 500.0, _pitch, (_pitch_third, _pitch_fading), (_pitch_wandering, _pitch_sharp)),
    "lead_error": Family("um/m", 600.0, 6000.0, _lead, (_lead_curved,), (_lead_kinked, _lead_wavy)),
    "servo_lag": Family("ms", 1.0, 100.0, _lag, (_lag_second_pole, _lag_by_place), (_lag_by_speed, _lag_by_direction)),
    "screw_thermal": Family(
        "um/m",
        100.0,
        1000.0,
        _screw_warm,
        (_screw_two_constants, _screw_held),
        (_screw_local, _screw_cooled),
    ),
}
