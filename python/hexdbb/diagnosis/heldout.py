"""Held-out circles: what was fitted on some circles must predict the others.

Circles are dealt into at most `MOST_FOLDS` groups; the model is fitted without each group in turn and predicts it. A
fit that improves where it was trained and not here explains noise, or the wrong thing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.model import Model
from hexdbb.prediction import samples_of
from hexdbb.record import Record

MOST_FOLDS = 7

Refit = Callable[[Sequence[Record], Model], Model]


@dataclass(frozen=True)
class HeldOut:
    """RMS residual of circles left out of the fit, with the start's values and with those fitted on the others."""

    before_um: float
    after_um: float
    folds: int


def held_out(records: Sequence[Record], start: Model, fitted: Model, refit: Refit) -> HeldOut | None:
    """Judge a fit on circles it has not seen.

    Parameters
    ----------
    records : sequence of Record
    start : Model
        Where each fit starts.
    fitted : Model
        The fit to all circles: a nearer start, which changes no result.
    refit : callable
        Fits a model to records.

    Returns
    -------
    HeldOut or None
        None where there are not two circles.
    """
    folds = _folds(records)
    if len(folds) < 2:
        return None
    before, after = [], []
    for fold in folds:
        training = [record.part(~rows) for record, rows in zip(records, fold, strict=True) if not rows.all()]
        trained = refit(training, fitted)
        for record, rows in zip(records, fold, strict=True):
            if not rows.any():
                continue
            before.append(_residual(record, start, rows))
            after.append(_residual(record, trained, rows))
    return HeldOut(_rms_um(before), _rms_um(after), len(folds))


def _folds(records: Sequence[Record]) -> list[list[NDArray[np.bool_]]]:
    """Masks of the rows left out, one list a fold, one mask a record."""
    circles = [
        (index, int(each)) for index, record in enumerate(records) for each in np.unique(record.columns["circle"])
    ]
    count = min(len(circles), MOST_FOLDS)
    return [
        [
            np.isin(record.columns["circle"], [each for at, each in circles[fold::count] if at == index])
            for index, record in enumerate(records)
        ]
        for fold in range(count)
    ]


def _residual(record: Record, model: Model, rows: NDArray[np.bool_]) -> NDArray[np.float64]:
    part = record.part(rows)
    predicted = _core.predict(model.engine(), samples_of([part], model)).reading_mm
    residual: NDArray[np.float64] = part.reading_mm - predicted
    return residual


def _rms_um(residuals: Sequence[NDArray[np.float64]]) -> float:
    return float(np.sqrt(np.mean(np.concatenate(residuals) ** 2))) * 1e3
