"""What the gauge shows: mechanisms at work on a true machine, at some or all samples of a history.

Model: as `hexdbb.rig.plant`, of which pose solver and balance under weight are used; cup and ball change from circle to
circle, and the gauge may be read later, by a time that differs from sample to sample: linear between the instants
before and after.
Assumption: memories (play, friction) follow the drives; what other mechanisms add to the path, micrometres, does not
turn them over. A wrong scale acts on the deflection of the machine without its other faults.
Units: mm, s.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hexdbb.errors import InputError
from hexdbb.rig.geometry import Array
from hexdbb.rig.mechanisms import Push
from hexdbb.rig.plant import Machine
from hexdbb.rig.truth import TruthFile
from hexdbb_truth.forms.history import History, Rows
from hexdbb_truth.forms.ports import Action, Scene, add

Sized = tuple[Action, float]
"""An action and its size."""


@dataclass(frozen=True, eq=False)
class Measured:
    """A true machine on the way of a history.

    Attributes
    ----------
    truth : TruthFile
        Geometry, set-up and gauge; its own mechanisms are not used.
    history : History
    drawn_on : History, optional
        For which the faults were drawn, where this is another one (`Scene.drawn_on`).
    """

    truth: TruthFile
    history: History
    drawn_on: History | None = None

    def scene(self, rows: Rows) -> Scene:
        """Return what mechanisms see at some instants."""
        drawn_on = None
        if self.drawn_on is not None:
            drawn_on = Measured(self.truth, self.drawn_on).scene(self.drawn_on.samples)
        return Scene(self.history, rows, lambda some: self._at(some, ()), drawn_on)

    def readings_mm(self, actions: Sequence[Sized], rows: Rows | None = None) -> Array:
        """Return the readings at samples (all where none are named) before noise and rounding.

        Raises
        ------
        InputError
            The gauge is read outside a run.
        RunError
            The machine has no pose there.
        """
        history = self.history
        rows = history.samples if rows is None else rows
        scene, delay = self.scene(rows), np.zeros(len(rows))
        for action, size in actions:
            if action.port == "delay":
                delay += action.values(scene, size)[:, 0]
        if not np.any(delay):
            return self._at(rows, actions)
        later = delay / history.dt_s
        whole = np.floor(later).astype(np.intp)
        first = rows + whole
        last = np.clip(first + 1, 0, len(history) - 1)
        if first.min() < 0 or np.any(last != first + 1) or np.any(history.run[[first, last]] != history.run[rows]):
            raise InputError("the gauge is read outside the run (expected a longer overshoot)")
        now = self._at(first, actions)
        return np.asarray(now + (later - whole) * (self._at(first + 1, actions) - now))

    def _at(self, rows: Rows, actions: Sequence[Sized]) -> Array:
        history, push, scene = self.history, Push(len(rows)), self.scene(rows)
        for action, size in actions:
            if action.port != "delay":
                add(action, action.values(scene, size), scene, push)
        machine: Machine = self.truth.true_machine(history.machine)
        poses = machine.poses(history.drive_mm[rows], push, history.poses(rows))
        errors, run = machine.setup_errors, history.run[rows]
        balls = np.array([each.circle.ball_offset_mm for each in history.runs])
        cups = np.array(
            [np.add(each.mount.cup_mm, errors.cup_mm.get(each.mount.id, (0.0, 0.0, 0.0))) for each in history.runs]
        )
        ball = balls[run] + errors.ball_offset_mm + push.ball_mm
        bar = poses.position_mm + np.einsum("nij,nj->ni", poses.rotation, ball) - cups[run] - push.cup_mm
        length = np.sqrt(np.einsum("ni,ni->n", bar, bar))
        nominal = history.plan.gauge.bar_length_mm + errors.bar_length_mm
        return np.asarray(length - nominal + push.reading_mm)
