"""Forms of what happens to guideways, legs and joints."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, Exact, Family, Strange, bumpless, column, signed, slider, unit_vector, waves
from hexdbb_truth.forms.operators import presliding
from hexdbb_truth.forms.ports import Scene, Values, unit_range
from hexdbb_truth.forms.slider_forms import warmed

LEGS = tuple(range(6))

# --- straightness -----------------------------------------------------------------------------------------------------


def _bow(draw: Draw) -> Exact:
    guideway, angle = int(draw.integers(0, 3)), draw.uniform(0.0, 2.0 * math.pi)
    across = np.array([math.cos(angle), math.sin(angle)])

    def parabola(at: Array, scene: Scene) -> Array:
        low, high = scene.history.machine.sliders.guideway_travels_mm[guideway]
        return np.asarray(1.0 - ((2.0 * at - low - high) / (high - low)) ** 2)

    def along(weights: Array) -> Values:
        return lambda scene, size: _carried(scene, guideway, lambda at: 1e-3 * size * parabola(at, scene), weights)

    return Exact("guideway", (guideway,), along(across), (along(np.array([1.0, 0.0])), along(np.array([0.0, 1.0]))))


def _carried(scene: Scene, guideway: int, height: object, across: Array) -> Array:
    """Lateral and vertical displacement of both sliders' joints, shape (n, 4)."""
    assert callable(height)
    both = [height(scene.drive_mm(2 * guideway + j))[:, None] * across for j in range(2)]
    return np.hstack(both)


def _whole_range(scene: Scene, guideway: int, at: Array) -> Array:
    return unit_range(at, np.stack([scene.sampled.drive_mm(2 * guideway + j) for j in range(2)]))


def _bow_shaped(draw: Draw, exact: Exact, shape: object) -> Values:
    (guideway,), across = exact.elements, unit_vector(draw, 2)
    assert callable(shape)
    return lambda scene, size: _carried(
        scene, guideway, lambda at: 0.3e-3 * size * shape(_whole_range(scene, guideway, at)), across
    )


def _bow_cubic(draw: Draw, exact: Exact) -> Values:
    """Low-order content beside the parabola."""
    return _bow_shaped(draw, exact, bumpless(draw, (3, 4)))


def _bow_cubic_twisted(draw: Draw, exact: Exact) -> Values:
    """Another polynomial laterally than vertically."""
    lateral, vertical = bumpless(draw, (3, 4, 5)), bumpless(draw, (3, 4, 5))
    first, second = (_bow_part(exact, shape, axis) for axis, shape in enumerate((lateral, vertical)))
    return lambda scene, size: first(scene, size) + second(scene, size)


def _bow_part(exact: Exact, shape: object, axis: int) -> Values:
    (guideway,) = exact.elements
    assert callable(shape)
    return lambda scene, size: _carried(
        scene, guideway, lambda at: 0.3e-3 * size * shape(_whole_range(scene, guideway, at)), np.eye(2)[axis]
    )


def _bow_waves(draw: Draw, exact: Exact) -> Values:
    """The rail follows its screws: long waves."""
    return _bow_shaped(draw, exact, waves(draw, 1.2, 3.0))


def _bow_joined(draw: Draw, exact: Exact) -> Values:
    """Two rails butt at an angle."""
    at, soft = draw.uniform(-0.5, 0.5), draw.uniform(0.2, 0.5)
    return _bow_shaped(draw, exact, lambda place: np.hypot(place - at, soft))


# --- leg_thermal ------------------------------------------------------------------------------------------------------


def _legs_warm(draw: Draw) -> Exact:
    tau, sign = float(draw.uniform(500.0, 3000.0)), signed(draw)

    def grown(scene: Scene, size: float, constant_s: float) -> Array:
        return np.repeat(column(sign * 1e-3 * size * warmed(scene, constant_s)), 6, axis=1)

    def slower(scene: Scene, size: float) -> Array:
        return grown(scene, size, 1.1 * tau) - grown(scene, size, tau)

    return Exact("leg", LEGS, lambda scene, size: grown(scene, size, tau), (slower,), {"warm_s": tau})


def _legs_unequal(draw: Draw, exact: Exact) -> Values:
    """Some legs warm more than others."""
    shares = unit_vector(draw, 6) * math.sqrt(6.0)
    return lambda scene, size: exact.formula(scene, size) * shares


def _legs_later(draw: Draw, exact: Exact) -> Values:
    """Three legs follow with a time constant of their own."""
    tau, chosen = float(draw.uniform(100.0, 400.0)), draw.permutation(6)[:3]

    def values(scene: Scene, size: float) -> Array:
        some = np.zeros((len(scene.rows), 6))
        some[:, chosen] = column(1e-3 * size * warmed(scene, tau))
        return some

    return values


def _legs_gradient(draw: Draw, exact: Exact) -> Values:
    """One side of the machine stands in the sun, later more."""
    side, begin = draw.uniform(0.0, 2.0 * math.pi), draw.uniform(0.1, 0.5)
    shares = np.cos(side - math.pi / 3.0 * np.arange(6))

    def values(scene: Scene, size: float) -> Array:
        late = np.maximum(scene.time_s / scene.duration_s() - begin, 0.0)
        return np.asarray(column(1e-3 * size * late) * shares)

    return values


def _legs_draught(draw: Draw, exact: Exact) -> Values:
    """The door opens now and then."""
    swing = waves(draw, 200.0, 700.0)
    return lambda scene, size: np.repeat(column(1e-3 * size * swing(scene.time_s)), 6, axis=1)


# --- gravity_sag ------------------------------------------------------------------------------------------------------


def _sag(draw: Draw) -> Exact:
    del draw
    return Exact("compliance", LEGS, lambda scene, size: -1e-3 * size * scene.history.leg_force_n(scene.rows))


def _sag_unequal(draw: Draw, exact: Exact) -> Values:
    """Legs are not equally stiff."""
    shares = unit_vector(draw, 6) * math.sqrt(6.0)
    return lambda scene, size: exact.formula(scene, size) * shares


def _sag_of_pairs(draw: Draw, exact: Exact) -> Values:
    """The joints of one pair, or of one side, are softer."""
    weak = draw.permutation(3)[: int(draw.integers(1, 3))]
    shares = np.zeros(6)
    shares[np.concatenate([2 * weak, 2 * weak + 1])] = draw.uniform(0.5, 1.5, 2 * len(weak))
    return lambda scene, size: exact.formula(scene, size) * shares


def _sag_hertz(draw: Draw, exact: Exact) -> Values:
    """Contacts stiffen under load, in all legs alike."""
    power = float(draw.uniform(0.3, 0.7))

    def values(scene: Scene, size: float) -> Array:
        force = scene.history.leg_force_n(scene.rows)
        return np.asarray(-1e-3 * size * np.sign(force) * 25.0 * np.abs(force / 25.0) ** power)

    return values


def _sag_by_place(draw: Draw, exact: Exact) -> Values:
    """Guideways give more in the middle of their span than at their ends."""
    shape = bumpless(draw, (1, 2))

    def values(scene: Scene, size: float) -> Array:
        place = np.stack([scene.place(k) * (-1.0) ** k for k in range(6)], axis=1)
        return exact.formula(scene, size) * shape(place)

    return values


# --- joint_offset -----------------------------------------------------------------------------------------------------


def _offset(draw: Draw) -> Exact:
    leg, vector = slider(draw), unit_vector(draw)

    def along(direction: Array) -> Values:
        return lambda scene, size: np.repeat(1e-3 * size * direction[None, :], len(scene.rows), axis=0)

    return Exact("platform_joint", (leg,), along(vector), tuple(along(axis) for axis in np.eye(3)))


def _turned(scene: Scene, leg: int) -> Array:
    """How the leg leans in the platform frame, each component over its range."""
    whole = scene.sampled.history.platform_leg_direction(scene.sampled.rows)[:, leg]
    some = scene.history.platform_leg_direction(scene.rows)[:, leg]
    return np.stack([unit_range(some[:, axis], whole[:, axis]) for axis in range(3)], axis=1)


def _offset_moves(draw: Draw, exact: Exact) -> Values:
    """The joint's centre moves as the joint turns."""
    (leg,), matrix = exact.elements, draw.normal(size=(3, 3))
    return lambda scene, size: 1e-3 * size * _turned(scene, leg) @ matrix


def _offset_seat(draw: Draw, exact: Exact) -> Values:
    """The ball climbs in its seat along the leg's leaning."""
    (leg,), way, axis = exact.elements, unit_vector(draw), int(draw.integers(0, 3))
    return lambda scene, size: 1e-3 * size * _turned(scene, leg)[:, [axis]] ** 2 * way


def _offset_oval(draw: Draw, exact: Exact) -> Values:
    """The ball is oval: the leg is longer where it stands on the long axis."""
    (leg,), order, phase = exact.elements, float(draw.uniform(1.5, 3.0)), draw.uniform(0.0, 2.0 * math.pi)

    def values(scene: Scene, size: float) -> Array:
        along = scene.history.platform_leg_direction(scene.rows)[:, leg]
        return 1e-3 * size * np.sin(order * _turned(scene, leg)[:, [2]] + phase) * along

    return values


def _offset_hangs(draw: Draw, exact: Exact) -> Values:
    """The ball hangs a little behind as the joint turns, this way and that."""
    (leg,), way, stretch = exact.elements, unit_vector(draw), float(draw.uniform(0.05, 0.2))

    def values(scene: Scene, size: float) -> Array:
        history = scene.history
        hung = presliding(history.slider_joint_angle_rad[:, leg], history.joint_pieces(leg), stretch)
        return np.asarray(1e-3 * size * column(hung[scene.rows]) * way)

    return values


# --- joint_friction ---------------------------------------------------------------------------------------------------


def _friction(draw: Draw) -> Exact:
    leg, small = slider(draw), float(draw.uniform(0.003, 0.01))

    def formula(scene: Scene, size: float) -> Array:
        return column(1e-3 * size * np.tanh(_rate(scene, leg) / small))

    return Exact("leg", (leg,), formula, (), {"small": small})


def _rate(scene: Scene, leg: int) -> Array:
    return np.asarray(scene.history.slider_joint_rate_rad_s[scene.rows, leg])


def _friction_stribeck(draw: Draw, exact: Exact) -> Values:
    """Most at rest, less in motion."""
    (leg,), slow = exact.elements, float(draw.uniform(0.02, 0.08))

    def values(scene: Scene, size: float) -> Array:
        rate = _rate(scene, leg)
        return column(1e-3 * size * np.tanh(rate / 0.001) * (1.0 + 1.5 * np.exp(-((rate / slow) ** 2))))

    return values


def _friction_viscous(draw: Draw, exact: Exact) -> Values:
    """More at speed."""
    (leg,), power = exact.elements, float(draw.uniform(0.5, 1.2))
    return lambda scene, size: column(
        1e-3 * size * np.sign(_rate(scene, leg)) * np.abs(_rate(scene, leg) / 0.1) ** power
    )


def _friction_presliding(draw: Draw, exact: Exact) -> Values:
    """Turns over slowly after a reversal (Dahl)."""
    (leg,), stretch = exact.elements, float(draw.uniform(0.02, 0.12))

    def values(scene: Scene, size: float) -> Array:
        history = scene.history
        force = presliding(history.slider_joint_angle_rad[:, leg], history.joint_pieces(leg), stretch)
        return column(1e-3 * size * force[scene.rows])

    return values


def _friction_by_angle(draw: Draw, exact: Exact) -> Values:
    """Tighter at one angle than at another."""
    (leg,), shape = exact.elements, bumpless(draw, (1, 2))

    def values(scene: Scene, size: float) -> Array:
        sampled, angle = scene.sampled, scene.history.slider_joint_angle_rad[scene.rows, leg]
        place = unit_range(angle, sampled.history.slider_joint_angle_rad[sampled.rows, leg])
        return exact.formula(scene, size) * column(shape(place))

    return values


_BOWS: tuple[Strange, ...] = (_bow_cubic, _bow_cubic_twisted)

FAMILIES: dict[str, Family] = {
    "straightness": Family("um", 300.0, 4000.0, _bow, _BOWS, (_bow_waves, _bow_joined)),
    "leg_thermal": Family(
        "um", 60.0, 500.0, _legs_warm, (_legs_unequal, _legs_later), (_legs_gradient, _legs_draught), "tilted"
    ),
    "gravity_sag": Family("um/N", 0.4, 5.0, _sag, (_sag_unequal, _sag_of_pairs), (_sag_hertz, _sag_by_place)),
    "joint_offset": Family("um", 50.0, 2000.0, _offset, (_offset_moves, _offset_seat), (_offset_oval, _offset_hangs)),
    "joint_friction": Family(
        "um", 4.0, 500.0, _friction, (_friction_stribeck, _friction_viscous), (_friction_presliding, _friction_by_angle)
    ),
}
