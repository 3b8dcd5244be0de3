"""Places: whether a variable's means stand out in one range only, as those of a dent or a burst do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.predictors.bins import Binned
from hexdbb.predictors.variable import FloatArray

FLANK = 0.25
"""Part of the largest mean down to which the place extends: a Gaussian dent is there 1.7 sigma from its middle."""
WIDEST = 0.35
"""Part of the whole range above which it is no single place."""
WELL_SEEN = 0.1
"""Part of the usual number of samples below which a bin cannot be the peak: its mean is mostly noise."""


@dataclass(frozen=True)
class Place:
    """A range of a variable, in its unit; times count from the record's first sample.

    `words` name the circle of what happens once.
    """

    begin: float
    end: float
    words: str = ""


def one_place(cut: Binned, mean_um: FloatArray) -> tuple[Place, NDArray[np.bool_]] | None:
    """Return the place where the means stand out; None where that is nearly everywhere.

    Returns
    -------
    Place, ndarray of bool, shape (columns,)
        The place and the bins in it.
    """
    out = np.abs(mean_um - np.median(np.repeat(mean_um, np.minimum(cut.samples, 1000.0).astype(np.intp))))
    seen = cut.samples >= WELL_SEEN * np.median(cut.samples)
    peak = int(np.argmax(np.where(seen, out, 0.0)))
    stands = out >= FLANK * out[peak]
    first = last = peak
    while first > 0 and (stands[first - 1] or not seen[first - 1]):
        first -= 1
    while last < len(out) - 1 and (stands[last + 1] or not seen[last + 1]):
        last += 1
    low, high = float(cut.low[first]), float(cut.high[last])
    if high - low > WIDEST * float(cut.high.max() - cut.low.min()):
        return None
    inside = np.zeros(len(out), bool)
    inside[first : last + 1] = True
    return Place(low, high), inside
