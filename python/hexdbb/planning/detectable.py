"""The smallest detectable size of every effect under a plan.

Definition: an effect is detectable where the part of its signature that no other free value of the model and no
set-up unknown can explain has an RMS of `DETECTION_RATIO` times the gauge noise over all readings of the plan. First
order, at the nominal machine: signature = column of the Jacobian times the size. The other values of the same effect
are held at zero: one fault alone.
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

DETECTION_RATIO = 3.0
"""RMS of the unexplained signature over the noise from which an effect counts as detectable: three standard deviations,
so that it is visible in single readings and not only in their average."""
ROUNDING_SHARE = 1e-6
"""Unexplained share of an effect's largest signature, or of the noise where that is larger, below which it counts as
zero: what projection by QR leaves of an exactly redundant column in double precision, with a margin. A leg that does
not warm has a signature of rounding errors alone, all of it its own."""


@dataclass(frozen=True)
class Detectable:
    """Detectable sizes of one effect."""

    size: float | None
    """Smallest detectable size of the element and parameter detected most easily, in `unit`; None where none is
    detectable at a size that a machine can have (the limit of its value)."""
    hardest: float | None
    """The same of the one detected least easily, in `unit`; None where one is not detectable."""
    unit: str
    """Unit of files and JSON."""
    kept: float
    """Largest unexplained share of a signature, 0 to 1; 0 where no reading shows the effect."""

    def to_json(self) -> dict[str, Any]:
        """Return the entry of `hexdbb plan check --json`."""
        return {"size": self.size, "unit": self.unit, "hardest": self.hardest, "kept": self.kept}


def detectable_sizes(sensitivity: Sensitivity, noise_mm: float) -> Mapping[str, Detectable]:
    """Compute the smallest detectable size of every effect in a sensitivity.

    Parameters
    ----------
    sensitivity : Sensitivity
        Of a model with all effects of interest (`hexdbb.identifiability.with_every_effect`).
    noise_mm : float
        Standard deviation of one reading, mm.

    Returns
    -------
    mapping of str to Detectable
        By effect, in the order of the sensitivity.
    """
    effects = dict.fromkeys(each.effect for each in sensitivity.parameters)
    return {effect: _detectable(effect, sensitivity, noise_mm) for effect in effects}


def _detectable(effect: str, sensitivity: Sensitivity, noise_mm: float) -> Detectable:
    own = sensitivity.whose(lambda each: each.effect == effect)
    signature = sensitivity.scaled(own)
    rest = _core.project_out(signature, sensitivity.scaled(sensitivity.free & ~own))
    whole, left = np.linalg.norm(signature, axis=0), np.linalg.norm(rest, axis=0)
    parameters, prior = sensitivity.where(own), sensitivity.prior_sigma[own]
    with np.errstate(divide="ignore"):
        needed = DETECTION_RATIO * noise_mm / (left / np.sqrt(sensitivity.readings) / prior)
    noise = noise_mm * np.sqrt(sensitivity.readings)
    seen = left > ROUNDING_SHARE * max(float(whole.max()), float(noise))
    # No machine has a value beyond its limit: an effect that would need it is not detectable with this plan.
    visible = seen & (needed <= [each.limit for each in parameters])
    kept = float((left[seen] / whole[seen]).max(initial=0.0))
    if not visible.any():
        return Detectable(None, None, shown_unit(parameters[0].unit), kept)
    # Values of several units compare by what is expected of each; the size is that of the easiest, and of its like.
    easiest = parameters[int(np.argmin(np.where(visible, needed / prior, np.inf)))]
    alike = np.array([each.unit == easiest.unit for each in parameters])
    sizes = needed * shown_factor(easiest.unit)
    return Detectable(
        size=float(sizes[alike & visible].min()),
        hardest=float(sizes[alike].max()) if visible[alike].all() else None,
        unit=shown_unit(easiest.unit),
        kept=kept,
    )
