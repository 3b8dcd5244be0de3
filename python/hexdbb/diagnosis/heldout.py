"""Held-out circles: what was fitted on some circles must predict the others.

Circles (or sweeps) are dealt into groups; a model is fitted without each group in turn and predicts it. A fit that
improves where it was trained and not here explains noise, or the wrong thing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.model import Model
from hexdbb.record import Record
from hexdbb.samples import Measured, measured

MOST_FOLDS = 7

Refit = Callable[[Measured, Model], Model]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class HeldOut:
    """Residual on readings left out of the fit, before and after: root mean square, and peak to valley."""

    before_um: float
    after_um: float
    folds: int
    peak_to_valley_before_um: float
    peak_to_valley_after_um: float

    def share(self, noise_um: float) -> float:
        """Part of what was unexplained that the fit explains where it was not made."""
        excess = self.before_um**2 - noise_um**2
        return (self.before_um**2 - self.after_um**2) / excess if excess > 0.0 else 0.0


def held_out(
    records: Sequence[Record] | Measured,
    before: tuple[Model, Refit],
    after: tuple[Model, Refit],
    by: Literal["circle", "sweep"] = "circle",
    most_folds: int = MOST_FOLDS,
) -> HeldOut | None:
    """Compare two models on readings they have not seen.

    Parameters
    ----------
    records : sequence of Record, or Measured
    before, after : tuple of Model and callable
        A start and how it is fitted to the training records; `as_it_is` leaves its values alone.
    by : str
        Whole circles are left out, or single sweeps, for what belongs to a circle alone.
    most_folds : int
        At most so many groups.

    Returns
    -------
    HeldOut or None
        None where there are not two groups.
    """
    taken = measured(records, after[0])
    left_out = folds(taken.records, by, most_folds)
    if len(left_out) < 2:
        return None
    errors: tuple[list[NDArray[np.float64]], list[NDArray[np.float64]]] = ([], [])
    for fold in map(np.concatenate, left_out):
        for (model, refit), gathered in zip((before, after), errors, strict=True):
            own = measured(taken, model)
            gathered.append(_residual(own.part(fold), refit(own.part(~fold), model)))
    before_mm, after_mm = (np.concatenate(gathered) for gathered in errors)
    return HeldOut(
        before_um=_rms_um(before_mm),
        after_um=_rms_um(after_mm),
        folds=len(left_out),
        peak_to_valley_before_um=float(np.ptp(before_mm)) * 1e3,
        peak_to_valley_after_um=float(np.ptp(after_mm)) * 1e3,
    )


def as_it_is(_: Measured, model: Model) -> Model:
    """Fit nothing."""
    return model


def folds(records: Sequence[Record], by: str, most: int) -> list[list[Mask]]:
    """Deal circles or sweeps into groups: masks of the rows left out, one list a fold, one mask a record."""
    groups = [(index, int(each)) for index, record in enumerate(records) for each in np.unique(record.columns[by])]
    count = min(len(groups), most)
    return [
        [
            np.isin(record.columns[by], [each for at, each in groups[fold::count] if at == index])
            for index, record in enumerate(records)
        ]
        for fold in range(count)
    ]


def _residual(part: Measured, model: Model) -> NDArray[np.float64]:
    residual: NDArray[np.float64] = part.reading_mm - _core.predict(part.engine(model), part.samples).reading_mm
    return residual


def _rms_um(residual_mm: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(residual_mm**2))) * 1e3
