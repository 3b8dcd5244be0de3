"""Faults outside the catalogue that simulators written by others have brought up, each in a form of its own."""

from __future__ import annotations

import math

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, column, unit_vector
from hexdbb_truth.forms.fault import Fault, Outside
from hexdbb_truth.forms.labels import Equivalent
from hexdbb_truth.forms.ports import Action, Scene


def _table_leans(draw: Draw) -> Fault:
    """The table with the cup leans as the platform's weight moves across it, and more where a foot lifts off.

    Size: between the ends of the platform's travel.
    """
    towards, axis = float(draw.uniform(0.0, math.pi)), unit_vector(draw)
    share, lift = float(draw.uniform(0.4, 0.7)), float(draw.uniform(1.0, 3.0))

    def out_mm(scene: Scene) -> Array:
        position_mm = scene.history.position_mm[scene.rows]
        return np.asarray(position_mm[:, 0] * math.cos(towards) + position_mm[:, 1] * math.sin(towards))

    def values(scene: Scene, size: float) -> Array:
        whole = out_mm(scene.sampled)
        at = (out_mm(scene) - whole.min()) / np.ptp(whole)
        leaning = at + lift * np.maximum(at - share, 0.0)
        return np.asarray(1e-3 * size * column(leaning) / (1.0 + lift * (1.0 - share)) * axis)

    alike = "cup and ball move alike while the platform is not turned"
    return Fault(Action("cup", (), values), (Equivalent("ball", "position", None, alike),))


def _scale_is_interpolated(draw: Draw) -> Fault:
    """Sine and cosine of the gauge's scale have offsets and unequal gains: errors once and twice in each line.

    Size: in per cent of a line; beyond a tenth the gauge would count backwards.
    """
    line_mm, first = float(draw.uniform(0.04, 0.12)), float(draw.uniform(0.0, 2.0 * math.pi))
    twice, second = float(draw.uniform(0.2, 0.6)), float(draw.uniform(0.0, 2.0 * math.pi))

    def values(scene: Scene, size: float) -> Array:
        turns = 2.0 * math.pi * scene.deflection_mm / line_mm
        return column(1e-2 * size * line_mm * (np.sin(turns + first) + twice * np.sin(2.0 * turns + second)))

    return Fault(Action("reading", (), values))


TABLE: dict[str, Outside] = {
    "table_leans": Outside("um", 20.0, 1000.0, ("position",), _table_leans, "varied"),
    "scale_is_interpolated": Outside("%", 1.0, 6.0, ("deflection",), _scale_is_interpolated),
}
"""Kinds by name."""
