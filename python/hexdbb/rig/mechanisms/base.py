"""What a mechanism of the true machine sees and what it does: motion in, displacements at the ports out, in time.

Model: the machine goes through instants of equal distance in time. A mechanism takes them a stretch at a time, in
order, keeps its inner state (play taken up, a spring wound up) from one stretch to the next, and adds its displacements
at the ports. A stretch of one instant is what the rig's cycle makes, a stretch of a whole circle what the offline
simulator of the tests makes: the results are the same.
Mechanisms act in the order of the truth file. Those between drive and slider (play, stiction, lag) take as input where
the ones before them have brought the slider, as parts in a chain do.
Units: mm, rad, s, N, degC. Frames: base frame for slider joints and cup, platform frame for platform joints and ball.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Protocol, Self

import numpy as np
from pydantic import Field

from hexdbb.files.validation import StrictModel
from hexdbb.machine import MachineFile
from hexdbb.rig.geometry import Array

Axis = Annotated[int, Field(ge=1, le=6)]
"""A slider or a leg, as users count."""
Guideway = Annotated[int, Field(ge=1, le=3)]
Window = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
"""A time, s."""


@dataclass(frozen=True)
class Motion:
    """A stretch of n instants.

    Attributes
    ----------
    time_s : (n,) array
        Since power-on.
    dt_s : float
        From each instant to the next, and from the last one of the stretch before to the first of this.
    drive_mm : (n, 6) array
        Where the drives are; their encoders sit there.
    mount : int or None
        The fixing of the cup that the bar is mounted in.
    circle : int or None
        The circle of the plan; None where nobody tells, as on the bus.
    """

    time_s: Array
    dt_s: float
    drive_mm: Array
    mount: int | None = None
    circle: int | None = None


class Push:
    """Displacements that mechanisms have added in a stretch of n instants; all zero at first.

    Attributes
    ----------
    slider_mm : (n, 6) array
        Slider k stands further along its guideway than its drive.
    leg_mm : (n, 6) array
        Leg k is longer.
    slider_joint_mm, platform_joint_mm : (n, 6, 3) arrays
        Joint centre k is displaced; base frame and platform frame.
    ball_mm, cup_mm : (n, 3) arrays
        Platform frame and base frame.
    reading_mm : (n,) array
        Added to the reading.
    gain : (n,) array
        The gauge shows (1 + gain) times the change of length.
    temperature_c : (n,) array
        Of the machine's parts, above the room's.
    compliance_mm_n : (6,) array
        Leg k is shorter by this for each newton that presses on it; the plant finds the balance.
    delay_s : float
        The gauge shows what is true so much later.
    """

    def __init__(self, n: int) -> None:
        self.slider_mm, self.leg_mm = np.zeros((n, 6)), np.zeros((n, 6))
        self.slider_joint_mm, self.platform_joint_mm = np.zeros((n, 6, 3)), np.zeros((n, 6, 3))
        self.ball_mm, self.cup_mm = np.zeros((n, 3)), np.zeros((n, 3))
        self.reading_mm, self.gain, self.temperature_c = np.zeros(n), np.zeros(n), np.zeros(n)
        self.compliance_mm_n = np.zeros(6)
        self.delay_s = 0.0

    def at(self, rows: Any) -> Push:
        """Give the displacements of some of the instants; `rows` is a slice or an array of indices."""
        some = Push(0)
        for name, value in vars(self).items():
            shared = name in ("compliance_mm_n", "delay_s")
            setattr(some, name, value if shared else value[rows])
        return some


class Mechanism(Protocol):
    """A mechanism at work, with its inner state."""

    def act(self, motion: Motion, push: Push) -> None:
        """Go through the instants of `motion` and add displacements to `push`."""


Action = Callable[[Motion, Push], None]


@dataclass(frozen=True)
class Momentary:
    """A mechanism without memory: what it does follows from the instant alone."""

    action: Action

    def act(self, motion: Motion, push: Push) -> None:
        """See `Mechanism.act`."""
        self.action(motion, push)


class MechanismTable(StrictModel, ABC):
    """What every ``[[mechanism]]`` of a truth file has."""

    sizes: ClassVar[tuple[str, ...]] = ()
    """Keys that a mechanism's displacements are proportional to, together."""
    has_memory: ClassVar[bool] = False
    """Whether the instants between samples matter."""

    kind: str

    @abstractmethod
    def start(self, machine: MachineFile) -> Mechanism:
        """Put the mechanism into a machine at rest."""

    def scaled(self, factor: float) -> Self:
        """Give the same mechanism, larger by `factor` (at least 0)."""
        values = {name: _times(getattr(self, name), factor) for name in self.sizes}
        return type(self).model_validate({**self.model_dump(), **values})


def _times(value: float | tuple[float, ...], factor: float) -> Any:
    return [each * factor for each in value] if isinstance(value, tuple) else value * factor
