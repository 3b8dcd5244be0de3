"""The CiA 404 length gauge of the ball bar.

Model: reading = true length minus nominal length plus noise, rounded to the resolution, in µm. Outside the measuring
range the value is clamped and the status reports it. Object 2100h holds the set-up that the operator has mounted;
without a set-up the reading is not valid.
Source: CiA 404 (6130h, 6131h, 6132h, 6150h, 9130h); CiA 303-2 for the unit.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

from hexdbb.rig.dictionary import Key, Value
from hexdbb.rig.node import Node, Send
from hexdbb.rig.plant import Mounted

NOT_VALID, POSITIVE_OVERLOAD, NEGATIVE_OVERLOAD = 1, 2, 4
"""Bits of the AI status 6150h."""


@dataclass(frozen=True)
class GaugeSetup:
    """Properties of the gauge itself.

    Attributes
    ----------
    noise_um : float
        Standard deviation of one reading, µm.
    resolution_um : float
        Step of the reading, µm; 0 for none.
    range_um : float
        Measuring range to either side, µm.
    seed : int
        Seed of the noise.
    """

    noise_um: float
    resolution_um: float
    range_um: float
    seed: int


class GaugeNode(Node):
    """The gauge on the bus; the parameters not named here are those of `Node`.

    Parameters
    ----------
    setup : GaugeSetup
        Noise, resolution and range.

    Attributes
    ----------
    true_reading_um : float or None
        Length minus nominal length at this SYNC, µm; None without a bar. Set by the rig.
    mounted : Mounted or None
        The set-up written to 2100h.
    moving : bool
        Whether any drive moves; selects the noise sequence.
    frozen, broken : bool
        Injected faults.
    stuck_um : float or None
        Injected value that the reading keeps, µm.
    offset_um : float
        Injected offset of the reading, µm.
    """

    device_name = b"simulated CiA 404 ball bar gauge"
    required: ClassVar[dict[Key, str]] = {
        **Node.required,
        (0x2100, 1): "BHI",
        **{(0x2100, subindex): "f" for subindex in range(2, 9)},
        (0x6130, 1): "f",
        (0x6150, 1): "B",
    }
    assumed: ClassVar[dict[Key, int]] = {
        **Node.assumed,
        (0x2101, 1): 0,
        (0x2101, 2): 0,
        (0x6126, 1): 1,
        (0x6132, 1): 1,
        (0x9130, 1): 0,
    }

    def __init__(self, node_id: int, eds: Path, send: Send, setup: GaugeSetup, stall_tolerance_s: float = 0.0) -> None:
        self.setup = setup
        self.true_reading_um: float | None = None
        self.moving = False
        self.frozen = False
        self.broken = False
        self.stuck_um: float | None = None
        self.offset_um = 0.0
        super().__init__(node_id, eds, send, stall_tolerance_s)

    def on_power_up(self) -> None:
        """Start without a set-up and with the noise at its seed."""
        entry = self.dictionary.entry
        self.mounted: Mounted | None = None
        self._set_ups = 0
        self._restart_noise()
        self.dictionary.hooks[0x2100, 1] = self._mount
        entry(0x2101, 1).value, entry(0x2101, 2).value = -self.setup.range_um, self.setup.range_um
        entry(0x6126, 1).value = 1.0
        self._value, self._integer, self._status = entry(0x6130, 1), entry(0x9130, 1), entry(0x6150, 1)
        self._digits = entry(0x6132, 1)
        self._status.value = NOT_VALID

    def _mount(self, value: Value) -> None:
        number = int(value)
        x = [self.dictionary.real(0x2100, k) for k in range(2, 9)]
        self.mounted = Mounted(number - 1, (x[0], x[1], x[2]), (x[3], x[4], x[5]), x[6]) if number else None
        self._restart_noise()

    def _restart_noise(self) -> None:
        """Start new noise for a set-up: one sequence at rest and one in motion.

        The samples of a path then do not depend on the number of cycles spent waiting before it, and no two paths share
        their noise.
        """
        self._noise = [np.random.default_rng([self.setup.seed, self._set_ups, moving]) for moving in (0, 1)]
        self._set_ups += 1

    def on_sample(self) -> None:
        """Write reading (6130h) and status (6150h) of this SYNC."""
        if self.frozen:
            return
        if self.true_reading_um is None or self.broken:
            self._write(0.0, NOT_VALID)
            return
        if self.stuck_um is not None:
            self._write(self.stuck_um, 0)
            return
        noise_um = self.setup.noise_um * float(self._noise[self.moving].standard_normal())
        noisy_um = self.true_reading_um + self.offset_um + noise_um
        limit_um = self.setup.range_um
        if noisy_um > limit_um:
            self._write(limit_um, NOT_VALID | POSITIVE_OVERLOAD)
        elif noisy_um < -limit_um:
            self._write(-limit_um, NOT_VALID | NEGATIVE_OVERLOAD)
        else:
            step_um = self.setup.resolution_um
            self._write(round(noisy_um / step_um) * step_um if step_um > 0.0 else noisy_um, 0)

    def _write(self, value_um: float, status: int) -> None:
        self._value.value, self._status.value = value_um, status
        self._integer.value = round(value_um * 10 ** int(self._digits.value))
