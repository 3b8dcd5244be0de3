"""The true machine: from where the drives stand to what the ball bar reads, stepped in time.

Model: y = |p + R ball - cup| - (L0 + bar length error), with p, R from the pose solver under the true geometry,
displaced by mechanisms; ball and cup are the nominal set-up plus its errors.
Units: mm, s.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hexdbb.rig.geometry import Array, TrueGeometry
from hexdbb.rig.mechanisms import Displaced, Stepper
from hexdbb.rig.pose_solver import PoseSolver

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Mounted:
    """What the operator says is mounted, nominal: mount id, cup (base frame), ball (platform frame), bar length; mm."""

    mount: int
    cup_mm: Point
    ball_offset_mm: Point
    bar_length_mm: float


@dataclass(frozen=True)
class SetupErrors:
    """Errors of the set-up: cup by mount id (absent: none), ball, bar; mm."""

    cup_mm: Mapping[int, Point]
    ball_offset_mm: Point
    bar_length_mm: float


class Plant:
    """The machine at work.

    Parameters
    ----------
    geometry : TrueGeometry
        With its errors.
    setup_errors : SetupErrors
        Of cups, ball and bar.
    mechanisms : sequence of Stepper
        In the order in which they act.
    position_mm, rotation : (3,) and (3, 3) arrays
        Pose near which the machine stands at power-on.
    """

    def __init__(
        self,
        geometry: TrueGeometry,
        setup_errors: SetupErrors,
        mechanisms: Sequence[Stepper],
        position_mm: Array,
        rotation: Array,
    ) -> None:
        self.solver = PoseSolver(geometry, position_mm, rotation)
        self.time_s = 0.0
        self._errors, self._mechanisms = setup_errors, list(mechanisms)
        self._reading_drift_mm = 0.0

    def step(self, drive_mm: Array, dt_s: float) -> None:
        """Advance by one cycle to drive positions `drive_mm`, shape (6,).

        Raises
        ------
        RunError
            The machine has no pose there.
        """
        self.time_s += dt_s
        machine = Displaced(self.time_s, drive_mm)
        for mechanism in self._mechanisms:
            mechanism.step(machine, dt_s)
        self._reading_drift_mm = machine.reading_mm
        self.solver.solve(drive_mm + machine.slider_mm, machine.leg_mm)

    def reading_mm(self, mounted: Mounted) -> float:
        """Give the mounted bar's true length minus its nominal length, before noise."""
        ball = np.add(mounted.ball_offset_mm, self._errors.ball_offset_mm)
        cup = np.add(mounted.cup_mm, self._errors.cup_mm.get(mounted.mount, (0.0, 0.0, 0.0)))
        bar = self.solver.position_mm + self.solver.rotation @ ball - cup
        length = float(np.sqrt(bar @ bar))
        return length - (mounted.bar_length_mm + self._errors.bar_length_mm) + self._reading_drift_mm
