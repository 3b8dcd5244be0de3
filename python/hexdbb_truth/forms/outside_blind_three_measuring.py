"""Faults outside the catalogue of set-up and gauge; see `outside_blind_three`."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, unit_vector
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.labels import Equivalent
from hexdbb_truth.forms.ports import Action, Scene


def _cup_on_three_points(draw: Draw) -> Fault:
    """The cup's ball sits on three worn points, and rolls over onto two of them as the bar points between these.

    Friction carries it past: the bar must turn further one way than the other before it rolls.
    """
    first, late = float(draw.uniform(0.0, 2.0 * math.pi)), float(draw.uniform(0.1, 0.4))
    soft, rests = float(draw.uniform(0.03, 0.1)), np.stack([unit_vector(draw) for _ in range(3)])
    rests[:, 2] *= 0.3

    def values(scene: Scene, size: float) -> Array:
        bar = scene.history.bar_direction(scene.rows)
        at = np.arctan2(bar[:, 1], bar[:, 0]) - late * scene.history.direction(scene.rows)
        # Within 60 degrees of a rest's middle the cosine is above one half.
        near = np.cos(column(at) - first - 2.0 * math.pi / 3.0 * np.arange(3)) - 0.5
        return np.asarray(0.5e-3 * size * (1.0 + np.tanh(near / soft)) @ rests)

    along, alike = "along the bar, cup and reading are one", "cup and ball move alike while the platform is not turned"
    same = (Equivalent("reading", "angle", None, along), Equivalent("ball", "angle", None, alike))
    return Fault(Action("cup", (), values), same)


def _cable_winds_up(draw: Draw) -> Fault:
    """The gauge's cable winds round the stand lap by lap, either way; once taut it presses the plunger.

    It is laid out anew before each run. Size: at the end of the last lap.
    """
    slack, power = float(draw.uniform(0.2, 0.5)), float(draw.uniform(1.0, 2.0))

    def wound_rad(scene: Scene) -> Array:
        return np.asarray(scene.history.angle_rad[scene.rows] * scene.history.direction(scene.rows))

    def values(scene: Scene, size: float) -> Array:
        taut = wound_rad(scene) / wound_rad(scene.sampled).max() - slack
        return column(-1e-3 * size * (np.maximum(taut, 0.0) / (1.0 - slack)) ** power)

    return Fault(Action("reading", (), values))


TABLE: dict[str, Outside] = {
    "cup_on_three_points": Outside("um", 5.0, 100.0, ("angle", "direction"), _cup_on_three_points),
    "cable_winds_up": Outside("um", 5.0, 100.0, ("time_in_run", "angle"), _cable_winds_up),
}
"""Kinds by name."""
