"""The smallest size of every effect that a plan can show.

Definition: an effect shows where the part of its signature that no other free value of the model and no set-up
unknown can explain has an RMS of `DETECTION` times the gauge's noise over all readings of the plan. First order, at
the nominal machine: signature = column of the Jacobian times the size. An effect of the model itself is judged with
its own other values held, as one fault alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.identifiability import Sensitivity
from hexdbb.units import shown_factor, shown_unit

Floats = NDArray[np.float64]

DETECTION = 3.0
NOTHING = 1e-6
"""No more than this part of an effect's largest signature is rounding."""


@dataclass(frozen=True)
class Detectable:
    """How large an effect must be to show.

    `size` of the value that shows most easily, `hardest` of the one that shows least, in the unit shown; None where a
    value never shows. `kept` is the largest part of a signature that nothing else explains.
    """

    size: float | None
    hardest: float | None
    unit: str
    kept: float

    def to_json(self) -> dict[str, Any]:
        """Give the entry of `hexdbb plan check --json`."""
        return {"size": self.size, "unit": self.unit, "hardest": self.hardest, "kept": self.kept}


def detectable_sizes(sensitivity: Sensitivity, noise_mm: float) -> Mapping[str, Detectable]:
    """Find the smallest size of every effect among a sensitivity's values.

    Parameters
    ----------
    sensitivity : Sensitivity
        Of a model with all effects that are asked for (`hexdbb.identifiability.sensitivity.with_every_effect`).
    noise_mm : float
        Standard deviation of one reading.
    """
    effects = dict.fromkeys(each.effect for each in sensitivity.parameters)
    return {effect: _detectable(effect, sensitivity, noise_mm) for effect in effects}


def _detectable(effect: str, sensitivity: Sensitivity, noise_mm: float) -> Detectable:
    own = sensitivity.whose(lambda each: each.effect == effect)
    signature = sensitivity.scaled(own)
    rest = _core.project_out(signature, sensitivity.scaled(sensitivity.free & ~own))
    whole, left = np.linalg.norm(signature, axis=0), np.linalg.norm(rest, axis=0)
    shows = left > NOTHING * whole.max()
    parameter = sensitivity.where(own)[0]
    rms_mm = left[shows] / np.sqrt(sensitivity.readings) / sensitivity.prior_sigma[own][shows]
    sizes = DETECTION * noise_mm / rms_mm * shown_factor(parameter.unit)
    return Detectable(
        size=float(sizes.min()) if len(sizes) else None,
        hardest=float(sizes.max()) if shows.all() else None,
        unit=shown_unit(parameter.unit),
        kept=float((left[shows] / whole[shows]).max(initial=0.0)),
    )
