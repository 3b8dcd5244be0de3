"""Where mechanisms act: values at a port at some instants, what geometry already does there, and how they are added.

Port, columns of one element, unit of `values`:

    slider          1   mm along the guideway
    leg             1   mm
    guideway        4   mm: lateral (outward) and vertical at the first slider's joint, the same at the second's
    platform_joint  3   mm, platform frame
    ball            3   mm, platform frame
    cup             3   mm, base frame
    reading         1   mm
    compliance      1   mm shorter under the nominal static leg force; the plant balances it on the true machine
    delay           1   s by which the gauge is read later than the encoders
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hexdbb.rig.geometry import Array, rotation_z
from hexdbb.rig.mechanisms import Push
from hexdbb_truth.forms.history import History, Rows


@dataclass(frozen=True, eq=False)
class Scene:
    """What a mechanism sees when its values are asked for.

    Attributes
    ----------
    history : History
    rows : (n,) array of int
        The instants asked for.
    deflect : callable
        Instants -> deflection (mm) that an ideal gauge would show on this machine without its faults.
    drawn_on : Scene, optional
        All samples of the history for which the faults were drawn, where another one is driven now: ranges and shares
        of a form are those there. A machine that is driven otherwise keeps its faults.
    """

    history: History
    rows: Rows
    deflect: Callable[[Rows], Array]
    drawn_on: Scene | None = None

    @cached_property
    def deflection_mm(self) -> Array:
        """Deflection at the instants, shape (n,)."""
        return self.deflect(self.rows)

    @cached_property
    def sampled(self) -> Scene:
        """All samples of the record for which the faults were drawn, over which forms are measured."""
        if self.drawn_on is not None:
            return self.drawn_on
        whole = self.history.samples
        return self if self.rows is whole else Scene(self.history, whole, self.deflect)

    @property
    def time_s(self) -> Array:
        """Time since power-on."""
        return np.asarray(self.history.time_s[self.rows])

    def drive_mm(self, slider: int) -> Array:
        """Position of a drive (from 0)."""
        return np.asarray(self.history.drive_mm[self.rows, slider])

    def place(self, slider: int) -> Array:
        """Position of a slider over the range driven in the samples, -1 to 1."""
        return unit_range(self.drive_mm(slider), self.sampled.drive_mm(slider))

    def duration_s(self) -> float:
        """Time of the last sample."""
        return float(self.sampled.time_s[-1])


Values = Callable[[Scene, float], Array]
"""Scene and size -> values at the port, shape (n, columns)."""


@dataclass(frozen=True, eq=False)
class Action:
    """A mechanism at one port.

    Attributes
    ----------
    port : str
    elements : tuple of int
        From 0; () where the port has one element.
    values : Values
        Columns of the elements side by side.
    """

    port: str
    elements: tuple[int, ...]
    values: Values


def unit_range(values: Array, over: Array) -> Array:
    """Return values mapped so that the range of `over` becomes -1 to 1."""
    low, high = float(over.min()), float(over.max())
    return np.asarray((2.0 * values - low - high) / max(high - low, 1e-9))


def geometry_columns(action: Action, scene: Scene, columns: int) -> Array:
    """Return what geometry and set-up can do at an action's port, shape (n * columns, free values).

    A constant of each element (slider offset, leg length, ball offset, cup, bar length); of a guideway a constant and
    a slope along it (translation and rotation). At `platform_joint` and `delay` nothing: there a constant is the fault.
    """
    n = len(scene.rows)
    if action.port in ("platform_joint", "delay"):
        return np.zeros((n * columns, 0))
    if action.port != "guideway":
        return np.tile(np.eye(columns), (n, 1))
    (guideway,) = action.elements
    at = np.stack([scene.drive_mm(2 * guideway), scene.drive_mm(2 * guideway + 1)], axis=1) / 1000.0
    free = np.zeros((n, 4, 4))
    for j in range(2):
        for axis in range(2):
            free[:, 2 * j + axis, axis] = 1.0
            free[:, 2 * j + axis, 2 + axis] = at[:, j]
    return free.reshape(4 * n, 4)


def add(action: Action, values: Array, scene: Scene, push: Push) -> None:
    """Add values at a port, other than `delay`, to the displacements of the same instants."""
    elements = list(action.elements)
    if action.port == "slider":
        push.slider_mm[:, elements] += values
    elif action.port == "leg":
        push.leg_mm[:, elements] += values
    elif action.port == "guideway":
        for i, guideway in enumerate(elements):
            frame = rotation_z(2.0 * math.pi / 3.0 * guideway)
            for j in range(2):
                first = 4 * i + 2 * j
                push.slider_joint_mm[:, 2 * guideway + j] += values[:, first : first + 2] @ frame[:, [0, 2]].T
    elif action.port == "platform_joint":
        push.platform_joint_mm[:, elements] += values.reshape(len(values), -1, 3)
    elif action.port == "ball":
        push.ball_mm += values
    elif action.port == "cup":
        push.cup_mm += values
    elif action.port == "reading":
        push.reading_mm += values[:, 0]
    elif action.port == "compliance":
        force = scene.history.leg_force_n(scene.rows)[:, elements]
        push.compliance_mm_n = push.compliance_mm_n + np.zeros((len(values), 6))
        push.compliance_mm_n[:, elements] -= values / force
    else:
        raise ValueError(f"port {action.port}")
