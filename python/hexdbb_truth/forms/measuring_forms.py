"""Forms of what happens to bar, gauge and ball."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, Exact, Family, bumpless, column, signed, unit_vector, waves
from hexdbb_truth.forms.ports import Scene, Values

# --- bar_drift --------------------------------------------------------------------------------------------------------


def _drift(draw: Draw) -> Exact:
    sign = signed(draw)
    return Exact("reading", (), lambda scene, size: column(sign * 1e-3 * size * scene.time_s / 3600.0))


def _drift_settles(draw: Draw, exact: Exact) -> Values:
    """The gauge warms up quickly, the bar slowly."""
    tau = float(draw.uniform(100.0, 500.0))
    return lambda scene, size: column(1e-3 * size * -np.expm1(-scene.time_s / tau))


def _drift_bends(draw: Draw, exact: Exact) -> Values:
    """The drift speeds up or slows down."""
    shape = bumpless(draw, (2, 3))
    return lambda scene, size: column(1e-3 * size * shape(2.0 * scene.time_s / scene.duration_s() - 1.0))


def _drift_swings(draw: Draw, exact: Exact) -> Values:
    """The air conditioning swings."""
    swing = waves(draw, 250.0, 900.0)
    return lambda scene, size: column(1e-3 * size * swing(scene.time_s))


def _drift_touched(draw: Draw, exact: Exact) -> Values:
    """Whenever a circle is set up a hand warms the bar."""
    heights, tau = draw.uniform(0.3, 1.0, 64), float(draw.uniform(60.0, 200.0))

    def values(scene: Scene, size: float) -> Array:
        circle = scene.history.circle(scene.rows).astype(int)
        every = scene.sampled.history.circle(scene.sampled.rows)
        begin = np.array([scene.sampled.time_s[every == k].min() for k in range(int(every.max()) + 1)])
        since = scene.time_s - begin[circle]
        return column(1e-3 * size * heights[circle % 64] * np.exp(-np.maximum(since, 0.0) / tau))

    return values


# --- bar_gain ---------------------------------------------------------------------------------------------------------


def _gain(draw: Draw) -> Exact:
    sign = signed(draw)
    return Exact("reading", (), lambda scene, size: column(sign * 1e-2 * size * scene.deflection_mm))


def _gain_bends(draw: Draw, exact: Exact) -> Values:
    """The gauge is not linear: square and cube of the deflection."""
    square, cube = unit_vector(draw, 2)

    def values(scene: Scene, size: float) -> Array:
        y = scene.deflection_mm
        return column(1e-2 * size * (square * y**2 / 0.5 + cube * y**3 / 0.25))

    return values


def _gain_of_sides(draw: Draw, exact: Exact) -> Values:
    """Another gain for pressed than for drawn."""
    soft = float(draw.uniform(0.02, 0.1))
    return lambda scene, size: column(1e-2 * size * np.hypot(scene.deflection_mm, soft))


def _gain_saturates(draw: Draw, exact: Exact) -> Values:
    """It saturates towards the ends of its range."""
    full = float(draw.uniform(0.2, 0.5))
    return lambda scene, size: column(1e-2 * size * full * np.tanh(scene.deflection_mm / full))


# --- sample_delay -----------------------------------------------------------------------------------------------------


def _delay(draw: Draw) -> Exact:
    del draw
    return Exact("delay", (), lambda scene, size: np.full((len(scene.rows), 1), 1e-3 * size))


def _delay_jitters(draw: Draw, exact: Exact) -> Values:
    """The reading comes when the bus is free."""
    seed = int(draw.integers(1 << 31))

    def values(scene: Scene, size: float) -> Array:
        each = np.random.default_rng(seed).uniform(0.0, 2.0, len(scene.history.samples))
        nearest = np.searchsorted(scene.history.samples, scene.rows, side="right") - 1
        return column(1e-3 * size * each[np.maximum(nearest, 0)])

    return values


def _delay_creeps(draw: Draw, exact: Exact) -> Values:
    """Two clocks drift apart."""
    shape = bumpless(draw, (1, 2))
    return lambda scene, size: column(1e-3 * size * shape(2.0 * scene.time_s / scene.duration_s() - 1.0))


def _delay_beats(draw: Draw, exact: Exact) -> Values:
    """Two clocks of nearly the same rate: a sawtooth."""
    period, phase = float(draw.uniform(3.0, 40.0)), draw.uniform(0.0, 1.0)
    return lambda scene, size: column(1e-3 * size * ((scene.time_s / period + phase) % 1.0))


def _delay_by_feed(draw: Draw, exact: Exact) -> Values:
    """A filter whose delay falls with speed."""
    feed = float(draw.uniform(15.0, 40.0))
    return lambda scene, size: column(1e-3 * size / (1.0 + scene.history.feed_mm_s(scene.rows) / feed))


# --- ball_eccentricity ------------------------------------------------------------------------------------------------


def _eccentric(draw: Draw) -> Exact:
    vector = unit_vector(draw)

    def along(direction: Array) -> Values:
        return lambda scene, size: column(1e-3 * size * _second(scene)) * direction

    return Exact("ball", (), along(vector), tuple(along(axis) for axis in np.eye(3)))


def _second(scene: Scene) -> Array:
    """1 in the second fixing of the cup, 0 in the first."""
    return np.asarray(scene.history.mount(scene.rows) == 1.0).astype(float)


def _ball_by_circle(draw: Draw, exact: Exact) -> Values:
    """The ball sits otherwise in every circle."""
    places = draw.normal(size=(64, 3))
    return lambda scene, size: 1e-3 * size * places[scene.history.circle(scene.rows).astype(int) % 64]


def _ball_creeps(draw: Draw, exact: Exact) -> Values:
    """The ball settles in its magnet."""
    way, tau = unit_vector(draw), float(draw.uniform(200.0, 800.0))
    return lambda scene, size: column(1e-3 * size * np.exp(-scene.time_s / tau)) * way


def _ball_oval(draw: Draw, exact: Exact) -> Values:
    """The ball is not round: its centre depends on where the cup touches it."""
    lobes, phase = int(draw.integers(2, 5)), draw.uniform(0.0, 2.0 * math.pi)

    def values(scene: Scene, size: float) -> Array:
        bar = np.einsum("nij,ni->nj", scene.history.rotation[scene.rows], scene.history.bar_direction(scene.rows))
        turned = np.arctan2(bar[:, 1], bar[:, 0])
        return np.asarray(1e-3 * size * column(np.cos(lobes * turned + phase)) * bar)

    return values


def _ball_tilts(draw: Draw, exact: Exact) -> Values:
    """The ball's shaft bends as the bar pulls: the centre goes where the bar points, in the second fixing."""
    soft = draw.normal(size=3)

    def values(scene: Scene, size: float) -> Array:
        bar = scene.history.bar_direction(scene.rows)
        return 1e-3 * size * column(_second(scene)) * bar * soft

    return values


FAMILIES: dict[str, Family] = {
    "bar_drift": Family("um/h", 30.0, 2000.0, _drift, (_drift_settles, _drift_bends), (_drift_swings, _drift_touched)),
    "bar_gain": Family("%", 1.0, 20.0, _gain, (_gain_bends,), (_gain_of_sides, _gain_saturates), "off_radius"),
    "sample_delay": Family("ms", 50.0, 450.0, _delay, (_delay_jitters, _delay_creeps), (_delay_beats, _delay_by_feed)),
    "ball_eccentricity": Family(
        "um",
        20.0,
        800.0,
        _eccentric,
        (_ball_by_circle, _ball_creeps),
        (_ball_oval, _ball_tilts),
        "two_mounts",
    ),
}
