"""Which circumstances and predictors of a residual go with its likely cause, and are none themselves.

On a circle all sliders move together, so that nearly every column of the state predicts what one slider does wrong.
What belongs to another element than the likely cause and predicts nothing of what the cause leaves is a bystander: it
is named after all others, and as such.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hexdbb.comparison.iso230 import FloatArray
from hexdbb.predictors import LEAST_SHARE, Predictor, Pushes, rank_predictors
from hexdbb.samples import Samples

if TYPE_CHECKING:
    from hexdbb.discovery import LikelyCause

EXPLAINED = 0.75
"""Part of the mean square beyond the noise that the cause must explain of some samples for their common circumstance to
go with it: what is left is then below half of what was there."""
ELEMENT = re.compile(r"(?:slider|leg|guideway) \d+|ball|cup")
"""What belongs to an element; angle, time, feed and the like belong to none and are never bystanders."""


def is_elsewhere(subject: str, cause: LikelyCause) -> bool:
    """Check whether something belongs to another element than a cause: ``slider 2``, where it is at slider 4."""
    return ELEMENT.fullmatch(subject) is not None and subject not in cause.subjects


def goes_along(has: NDArray[np.bool_], residual_mm: FloatArray, cause: LikelyCause, noise_mm: float) -> bool:
    """Check whether a cause explains most of the residual of some samples."""
    before = float(np.mean(residual_mm[has] ** 2)) - noise_mm**2
    after = float(np.mean(cause.residual_mm[has] ** 2)) - noise_mm**2
    return before - after >= EXPLAINED * before


def marked(
    predictors: Sequence[Predictor],
    samples: Samples,
    residual_mm: FloatArray,
    pushes: Pushes | None,
    noise_mm: float,
    cause: LikelyCause,
) -> list[Predictor]:
    """Return predictors of a residual, those that only go with its likely cause marked and last.

    Parameters
    ----------
    predictors : sequence of Predictor
        Of `residual_mm`.
    samples : Samples
    residual_mm : ndarray, shape (n,)
    pushes : Pushes, optional
    noise_mm : float
    cause : LikelyCause
    """
    left: dict[str, float] = {}
    if not cause.is_all:
        of_all = float(np.mean(cause.residual_mm**2) / np.mean(residual_mm**2))
        for each in rank_predictors(samples, cause.residual_mm, pushes, noise_mm):
            left[each.variable] = max(left.get(each.variable, 0.0), of_all * each.share)
    found = [
        replace(each, is_bystander=is_elsewhere(each.subject, cause) and left.get(each.variable, 0.0) < LEAST_SHARE)
        for each in predictors
    ]
    return sorted(found, key=lambda each: each.is_bystander)
