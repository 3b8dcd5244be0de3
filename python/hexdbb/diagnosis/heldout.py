"""Held-out circles: what was fitted to some circles must predict the others.

Circles (or sweeps) are dealt into groups; a model is fitted without each group in turn and predicts it. A fit that
improves where it was trained and not here explains noise, or the wrong thing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from hexdbb.model import Model
from hexdbb.samples import Prediction, Samples, predict
from hexdbb.samples.distinct import distinct_rows
from hexdbb.threads import fits_at_once

MAX_FOLDS = 7
"""Groups of circles at most: the thesis' plan has seven circles, and more would each cost a fit and add little."""
AT_ONCE_ROWS = 200_000
"""Readings up to which groups are fitted beside each other, on all cores: the engine fits without Python's lock. Of
millions, every fit's copy of its readings would count."""

Refit = Callable[[Samples, Model], Model]
"""Fits a model to some samples."""
Grouping = Literal["circle", "sweep"]


@dataclass(frozen=True)
class HeldOut:
    """Residual of readings held out of the fit, before and after: root mean square, and peak to valley."""

    before_um: float
    after_um: float
    folds: int
    peak_to_valley_before_um: float
    peak_to_valley_after_um: float

    def share(self, noise_um: float) -> float:
        """Return the explained share: the part of what was unexplained that the fit explains on held-out readings."""
        excess = self.before_um**2 - noise_um**2
        return (self.before_um**2 - self.after_um**2) / excess if excess > 0.0 else 0.0


def held_out(
    samples: Samples,
    before: tuple[Model, Refit],
    after: tuple[Model, Refit],
    by: Grouping = "circle",
    max_folds: int = MAX_FOLDS,
) -> HeldOut | None:
    """Compare two models on readings they were not fitted to.

    Parameters
    ----------
    samples : Samples
    before, after : tuple of Model and callable
        A start and how it is fitted to the training samples; `as_it_is` leaves its values alone.
    by : str
        Whole circles are held out, or single sweeps, for what belongs to a circle alone.
    max_folds : int
        Number of groups at most.

    Returns
    -------
    HeldOut or None
        None where there are not two groups.
    """
    groups = folds(samples, by, max_folds)
    if len(groups) < 2:
        return None

    def predicted(group: NDArray[np.bool_]) -> list[Prediction]:
        test, training = samples.part(group), samples.part(~group)
        return [predict(test, refit(training, model)) for model, refit in (before, after)]

    with ThreadPoolExecutor(fits_at_once() if len(samples) <= AT_ONCE_ROWS else 1) as pool:
        left = list(pool.map(predicted, groups))
    before_all, after_all = (_joined(each) for each in zip(*left, strict=True))
    return HeldOut(
        before_um=before_all.rms_um,
        after_um=after_all.rms_um,
        folds=len(groups),
        peak_to_valley_before_um=before_all.peak_to_valley_um,
        peak_to_valley_after_um=after_all.peak_to_valley_um,
    )


def as_it_is(_: Samples, model: Model) -> Model:
    """Return the model: nothing is fitted."""
    return model


def folds(samples: Samples, by: Grouping, most: int) -> list[NDArray[np.bool_]]:
    """Deal circles or sweeps into groups: a mask of the rows held out for each, shape (n,)."""
    each_own = distinct_rows(samples["record"], samples[by])[1]
    count = min(int(each_own.max(initial=-1)) + 1, most)
    return [each_own % count == fold for fold in range(count)]


def _joined(parts: Iterable[Prediction]) -> Prediction:
    every = tuple(parts)
    return Prediction(
        np.concatenate([each.reading_mm for each in every]), np.concatenate([each.residual_mm for each in every])
    )
