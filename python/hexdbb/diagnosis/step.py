"""The step a fit adds to a model's ledger: what fell, on which readings, and the model it began with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis.heldout import HeldOut
from hexdbb.model import LedgerStep, Model, Size
from hexdbb.record import Record

Floats = NDArray[np.float64]
UM_PER_MM = 1e3


def ledger_step(
    what: str,
    model: Model,
    records: Sequence[Record],
    residuals_mm: tuple[Floats, Floats],
    checked: HeldOut | None,
    effect: str = "",
    elements: tuple[str, ...] = (),
    sizes: tuple[Size, ...] = (),
) -> LedgerStep:
    """Describe a step.

    Parameters
    ----------
    what : str
        ``diagnose``, ``add`` or ``remove``.
    model : Model
        Before the step.
    records : sequence of Record
        Whose readings were fitted.
    residuals_mm : tuple of two ndarrays, shape (n,)
        Of these readings, before and after.
    checked : HeldOut or None
        The same on circles left out of the fit.
    effect : str
        The effect added or removed.
    elements : tuple of str
        Its elements.
    sizes : tuple of Size
        Its values.
    """
    before_mm, after_mm = residuals_mm
    return LedgerStep(
        step=len(model.ledger) + 1,
        what=what,
        effect=effect,
        elements=elements,
        element_kind=model.info(effect).element_kind if effect else "",
        sizes=sizes,
        rms_before_um=_rms_um(before_mm),
        rms_after_um=_rms_um(after_mm),
        peak_to_valley_before_um=float(np.ptp(before_mm)) * UM_PER_MM,
        peak_to_valley_after_um=float(np.ptp(after_mm)) * UM_PER_MM,
        heldout_before_um=None if checked is None else checked.before_um,
        heldout_after_um=None if checked is None else checked.after_um,
        heldout_peak_to_valley_before_um=None if checked is None else checked.peak_to_valley_before_um,
        heldout_peak_to_valley_after_um=None if checked is None else checked.peak_to_valley_after_um,
        records=tuple(record.name for record in records),
        record_hashes=tuple(record.content_hash() for record in records),
        before=model.state,
    )


def _rms_um(residual_mm: Floats) -> float:
    return float(np.sqrt(np.mean(residual_mm**2))) * UM_PER_MM
