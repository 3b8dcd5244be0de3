"""Interface of a mechanism of the true machine: motion in, displacements at the ports out, in time.

Model: the machine passes through equidistant instants. A mechanism processes them in order, one stretch at a time,
keeps its inner state (play taken up, spring wound up) from one stretch to the next, and adds its displacements at the
ports. The rig uses stretches of one instant, the offline simulator of the tests stretches of whole circles: the results
are equal.
Mechanisms act in the order of the truth file. The input of those between drive and slider (play, stiction, lag) is the
slider position that the preceding ones produce, as for parts in a chain.
Units: mm, rad, s, N, °C. Frames: base frame for slider joints and cup, platform frame for platform joints and ball.
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
"""Number of a slider or leg, 1 to 6."""
Guideway = Annotated[int, Field(ge=1, le=3)]
"""Number of a guideway, 1 to 3."""
Window = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
"""A time, s, at least 0."""


@dataclass(frozen=True)
class Motion:
    """A stretch of n instants.

    Attributes
    ----------
    time_s : (n,) array
        Time since power-on, s.
    dt_s : float
        Time between instants, s, also between the last instant of the preceding stretch and the first of this one.
    drive_mm : (n, 6) array
        Drive positions, mm, as their encoders report them.
    mount : int or None
        Mount in which the bar is; None without a bar.
    circle : int or None
        Circle of the plan; None on the bus, which does not carry it.
    """

    time_s: Array
    dt_s: float
    drive_mm: Array
    mount: int | None = None
    circle: int | None = None


class Push:
    """Displacements added by mechanisms in a stretch of n instants; initially zero.

    Attributes
    ----------
    slider_mm : (n, 6) array
        Displacement of slider k along its guideway, relative to its drive.
    leg_mm : (n, 6) array
        Added length of leg k.
    slider_joint_mm, platform_joint_mm : (n, 6, 3) arrays
        Displacement of joint centre k; base frame and platform frame.
    ball_mm, cup_mm : (n, 3) arrays
        Displacement of ball (platform frame) and cup (base frame).
    reading_mm : (n,) array
        Added to the reading.
    gain : (n,) array
        Scale error of the gauge: it shows (1 + gain) times the change of length.
    temperature_c : (n,) array
        Temperature of the machine's parts above the room's, °C.
    compliance_mm_n : (6,) array
        Shortening of leg k per newton of compression; `plant` computes the equilibrium.
    delay_s : float
        Time by which the gauge is read later than the encoders, s.
    """

    def __init__(self, n: int) -> None:
        self.slider_mm, self.leg_mm = np.zeros((n, 6)), np.zeros((n, 6))
        self.slider_joint_mm, self.platform_joint_mm = np.zeros((n, 6, 3)), np.zeros((n, 6, 3))
        self.ball_mm, self.cup_mm = np.zeros((n, 3)), np.zeros((n, 3))
        self.reading_mm, self.gain, self.temperature_c = np.zeros(n), np.zeros(n), np.zeros(n)
        self.compliance_mm_n = np.zeros(6)
        self.delay_s = 0.0

    def at(self, rows: Any) -> Push:
        """Return the displacements of some of the instants; `rows` is a slice or an array of indices."""
        some = Push(0)
        for name, value in vars(self).items():
            shared = name in ("compliance_mm_n", "delay_s")
            setattr(some, name, value if shared else value[rows])
        return some


class Mechanism(Protocol):
    """A mechanism with its inner state."""

    def act(self, motion: Motion, push: Push) -> None:
        """Process the instants of `motion` and add displacements to `push`."""


Action = Callable[[Motion, Push], None]


@dataclass(frozen=True)
class Momentary:
    """A mechanism without memory: its displacements depend on the instant alone."""

    action: Action

    def act(self, motion: Motion, push: Push) -> None:
        """See `Mechanism.act`."""
        self.action(motion, push)


class MechanismTable(StrictModel, ABC):
    """A ``[[mechanism]]`` of a truth file."""

    sizes: ClassVar[tuple[str, ...]] = ()
    """Keys to which the displacements are jointly proportional."""
    has_memory: ClassVar[bool] = False
    """Whether the instants between samples affect the result."""

    kind: str

    @abstractmethod
    def start(self, machine: MachineFile) -> Mechanism:
        """Return the mechanism in its initial state, in a machine at rest."""

    def scaled(self, factor: float) -> Self:
        """Return the mechanism with its `sizes` multiplied by `factor` (at least 0)."""
        values = {name: _times(getattr(self, name), factor) for name in self.sizes}
        return type(self).model_validate({**self.model_dump(), **values})


def _times(value: float | tuple[float, ...], factor: float) -> Any:
    return [each * factor for each in value] if isinstance(value, tuple) else value * factor
