"""A machine that does not repeat: each run finds every slider displaced anew, as far as it stays for the run.

Model: at the approach to a run the six sliders stand beside their drives by amounts drawn independently (normal, zero
mean), as settled guideways, thermal drift between runs and a homing that repeats so far leave them. Within a run
nothing changes, so that laps agree and runs do not.
Not among the kinds of a truth file: on the bus nobody says where a run begins.
Units: µm in the table, mm inside.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from hexdbb.files.validation import NotNegative
from hexdbb.machine import MachineFile
from hexdbb.rig.mechanisms import Mechanism, MechanismTable, Motion, Push


class Approach(MechanismTable):
    """Sliders displaced anew in every run."""

    sizes: ClassVar = ("sigma_um",)
    kind: Literal["approach"] = "approach"
    sigma_um: NotNegative
    """Standard deviation of one slider's displacement."""
    seed: Annotated[int, Field(ge=0)] = 0

    def start(self, machine: MachineFile) -> Mechanism:
        """See `MechanismTable.start`."""
        return _Displaced(self.sigma_um * 1e-3, np.random.default_rng([self.seed]))


class _Displaced:
    """Draws the sliders' displacements of each stretch on a circle."""

    def __init__(self, sigma_mm: float, draw: np.random.Generator) -> None:
        self._sigma_mm, self._draw = sigma_mm, draw

    def act(self, motion: Motion, push: Push) -> None:
        """See `Mechanism.act`."""
        if motion.circle is not None:
            push.slider_mm += self._draw.normal(0.0, self._sigma_mm, 6)
