"""Faults that nobody chose: any place pushed by any state, the function's shape drawn too.

Lists of kinds hold what their authors thought of. These hold all that a place and a state can make, so that what an
estimator's own lists leave out shows. A kind is called `any_PLACE_STATE`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, signed, slider, unit_vector
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.history import monotone
from hexdbb_truth.forms.labels import Equivalent, leg_too, slider_too
from hexdbb_truth.forms.operators import lost_motion, travel_since_reversal
from hexdbb_truth.forms.ports import Action, Scene
from hexdbb_truth.forms.shapes import Shape, shape_of, shape_of_turn

State = Callable[[Scene, int], Array]
"""A scene and an element (from 0) -> the state there, shape (n,)."""


def _of_sliders(name: str) -> State:
    return lambda scene, k: np.asarray(getattr(scene.history, name)[scene.rows, k])


def _travel_mm(scene: Scene, k: int) -> Array:
    history = scene.history
    return np.asarray(travel_since_reversal(history.drive_mm[:, k], history.pieces(k))[scene.rows])


def _force_n(scene: Scene, k: int) -> Array:
    return np.asarray(scene.history.thrust_n[scene.rows, k])


def _velocity_x_mm_s(scene: Scene, _: int) -> Array:
    """Return the velocity of the platform along the base's x; between runs it counts as at rest."""
    history = scene.history
    at_mm, run = history.position_mm[:, 0], history.run
    inside = (np.diff(run, prepend=run[0]) == 0) & (np.diff(run, append=run[-1]) == 0) & (run >= 0)
    return np.asarray(np.where(inside, np.gradient(at_mm, history.dt_s), 0.0)[scene.rows])


def _tilt_rad(scene: Scene, axis: int) -> Array:
    """Return the lean of the platform's z towards the base's x or y."""
    return np.asarray(np.arcsin(np.clip(scene.history.rotation[scene.rows, axis % 2, 2], -1.0, 1.0)))


OF_ELEMENT: dict[str, tuple[tuple[str, ...], State]] = {
    "position": (("position",), _of_sliders("drive_mm")),
    "velocity": (("velocity",), _of_sliders("velocity_mm_s")),
    "acceleration": (("acceleration",), _of_sliders("acceleration_mm_s2")),
    "travel": (("since_reversal", "direction"), _travel_mm),
    # The two legs of a guideway meet at the platform: the sliders' distance sets both angles.
    "joint_angle": (("joint_angle", "position"), _of_sliders("slider_joint_angle_rad")),
    "joint_rate": (("joint_turning",), _of_sliders("slider_joint_rate_rad_s")),
    "leg_force": (("leg_force",), _force_n),
    "force_behind": (("leg_force", "direction"), _of_sliders("thrust_n")),
    "neighbour_position": (("position",), lambda scene, k: scene.drive_mm(k ^ 1)),
    "neighbour_velocity": (("velocity",), lambda scene, k: OF_ELEMENT["velocity"][1](scene, k ^ 1)),
}
"""States that each slider and leg has: the truth's words, and the state. A neighbour shares the guideway."""
OF_MACHINE: dict[str, tuple[tuple[str, ...], State]] = {
    "time": (("time",), lambda scene, _: scene.time_s),
    "feed": (("feed", "velocity"), lambda scene, _: scene.history.feed_mm_s(scene.rows)),
    "tilt": (("tilt",), _tilt_rad),
    "platform_x": (("position",), lambda scene, _: np.asarray(scene.history.position_mm[scene.rows, 0])),
    "platform_radius": (("position",), lambda scene, _: np.hypot(*scene.history.position_mm[scene.rows, :2].T)),
    "deflection": (("deflection",), lambda scene, _: scene.deflection_mm),
}
"""States that the machine has once."""
OF_MOUNTED: dict[str, tuple[tuple[str, ...], State]] = {"velocity_x": (("velocity", "direction"), _velocity_x_mm_s)}
"""States of the platform that push what the bar is held by, or the reading."""
STATES = {**OF_ELEMENT, **OF_MACHINE, **OF_MOUNTED}
"""All of them by name."""
TURNED: dict[str, State] = {
    "angle": lambda scene, _: np.asarray(scene.history.angle_rad[scene.rows]),
}
"""The same that repeat with a turn."""


def _even(state: State, scene: Scene, k: int) -> Array:
    """Return a state over its range in the samples, -1 to 1."""
    over = state(scene.sampled, k)
    return np.asarray((2.0 * state(scene, k) - over.min() - over.max()) / max(float(np.ptp(over)), 1e-9))


def _of_travel(shape: Shape, over_mm: float, scene: Scene, k: int) -> Array:
    """Return a function of the travel since a reversal, which goes towards an end, times the direction of travel."""
    direction = np.sign(scene.history.velocity_mm_s[scene.rows, k])
    return np.asarray(direction * shape(2.0 * np.exp(-_travel_mm(scene, k) / over_mm) - 1.0))


def _of_force_behind(play_part: float, scene: Scene, k: int) -> Array:
    """Return how far what a leg's force moves hangs back behind it, in a play of a part of what the force varies by.

    A joint whose bolts slip follows in most of a circle, and hangs back after each turn of the force.
    """
    force_n = scene.history.thrust_n[:, k]
    half_n = play_part * float(np.ptp(force_n[scene.sampled.rows]))
    return np.asarray(lost_motion(force_n, half_n, monotone(force_n))[scene.rows]) / half_n


def _pushed(draw: Draw, state_name: str) -> tuple[int, Callable[[Scene], Array]]:
    """Draw an element, and the function of its state."""
    k = slider(draw)
    if state_name in TURNED:
        turn, state = shape_of_turn(draw), TURNED[state_name]
        return k, lambda scene: turn(state(scene, k))
    if state_name == "force_behind":
        # From bolts that slip as soon as the force turns to bolts that hold for most of a circle.
        play_part = float(np.exp(draw.uniform(np.log(0.02), np.log(0.2))))
        return k, lambda scene: _of_force_behind(play_part, scene, k)
    _, state = STATES[state_name]
    shape = shape_of(draw)
    if state_name == "travel":
        # From an elastic nut to a cable that is taken along.
        over_mm = float(np.exp(draw.uniform(np.log(0.05), np.log(5.0))))
        return k, lambda scene: _of_travel(shape, over_mm, scene, k)
    return k, lambda scene: shape(_even(state, scene, k))


def _along_one(port: str, state_name: str, draw: Draw) -> Fault:
    """Push a slider or a leg."""
    k, function = _pushed(draw, state_name)
    words = _words(state_name)
    other = leg_too if port == "slider" else slider_too
    same = (*(other(k, each) for each in words), *_same_effect(port, state_name, (k + 1,)))
    return Fault(Action(port, (k,), lambda scene, size: 1e-3 * size * column(function(scene))), same)


def _across(axis: int, state_name: str, draw: Draw) -> Fault:
    """Push the joint of one slider across its guideway: sideways (0) or up (1)."""
    k, function = _pushed(draw, state_name)

    def values(scene: Scene, size: float) -> Array:
        found = np.zeros((len(scene.rows), 4))
        found[:, 2 * (k % 2) + axis] = 1e-3 * size * function(scene)
        return found

    joint = (Equivalent("slider_joint", each, (k + 1,), "the joint itself") for each in _words(state_name))
    return Fault(Action("guideway", (k // 2,), values), (*joint, *_same_effect("guideway", state_name, (k // 2 + 1,))))


def _in_space(port: str, state_name: str, draw: Draw) -> Fault:
    """Push a platform's joint, the ball or the cup along a direction."""
    k, function = _pushed(draw, state_name)
    along = unit_vector(draw)
    elements = (k,) if port == "platform_joint" else ()
    alike = {"ball": "cup", "cup": "ball"}.get(port)
    why = "cup and ball move alike while the platform is not turned"
    same = () if alike is None else tuple(Equivalent(alike, each, None, why) for each in _words(state_name))
    return Fault(Action(port, elements, lambda scene, size: 1e-3 * size * column(function(scene)) * along), same)


def _read(state_name: str, draw: Draw) -> Fault:
    """Change the reading."""
    _, function = _pushed(draw, state_name)
    sign = signed(draw)
    same = _same_effect("reading", state_name, None)
    return Fault(Action("reading", (), lambda scene, size: 1e-3 * size * sign * column(function(scene))), same)


SAME_EFFECT = {
    ("slider", "position"): "lead_error",
    ("slider", "velocity"): "servo_lag",
    ("slider", "travel"): "backlash",
    ("leg", "joint_rate"): "joint_friction",
    ("leg", "time"): "leg_thermal",
    # The sliders of a guideway run on different parts of it: it is bent where one of them runs.
    ("guideway", "position"): "straightness",
    ("reading", "time"): "bar_drift",
    ("reading", "deflection"): "bar_gain",
}
"""Effects that describe the straight part of what a state does at a place."""


def _same_effect(port: str, state_name: str, elements: tuple[int, ...] | None) -> tuple[Equivalent, ...]:
    effect = SAME_EFFECT.get((port, state_name))
    why = "the straight part of the function"
    return () if effect is None else (Equivalent(port, _words(state_name)[0], elements, why, effect),)


def _words(state_name: str) -> tuple[str, ...]:
    return (state_name,) if state_name in TURNED else STATES[state_name][0]


LARGEST_UM = 3000.0
"""Geometry takes nearly all of what some states do (a feed at the cup): these may be as large as the bow of a rail."""


def _kind(state_name: str, drawn: Callable[[Draw], Fault]) -> Outside:
    return Outside("um", 5.0, LARGEST_UM, _words(state_name), drawn, "varied")


_EVERY = (*OF_ELEMENT, *OF_MACHINE, *TURNED)
_COMMON = (*OF_MACHINE, *TURNED, *OF_MOUNTED)
TABLE: dict[str, Outside] = {
    **{f"any_{p}_{s}": _kind(s, partial(_along_one, p, s)) for p in ("slider", "leg") for s in _EVERY},
    **{f"any_sideways_{s}": _kind(s, partial(_across, 0, s)) for s in _EVERY},
    **{f"any_upward_{s}": _kind(s, partial(_across, 1, s)) for s in _EVERY},
    **{f"any_platform_joint_{s}": _kind(s, partial(_in_space, "platform_joint", s)) for s in _EVERY},
    **{f"any_{p}_{s}": _kind(s, partial(_in_space, p, s)) for p in ("ball", "cup") for s in _COMMON},
    **{f"any_reading_{s}": _kind(s, partial(_read, s)) for s in _COMMON},
}
"""Kinds by name."""
