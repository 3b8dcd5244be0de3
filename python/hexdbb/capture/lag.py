"""Lag of each axis behind its targets, as encoders and targets tell it: whether answers belong to their SYNC.

A position loop follows a smooth path with a following error e = tau v. Answers that come one SYNC late shift the error
by v times the cycle, which shows as a lag longer by one cycle, whatever the counts of answers say.
Six numbers a cycle are plain numbers: an array of six costs more than what is computed with it.
Source: least squares of e on v with exponential forgetting (Ljung, System Identification, section 11.2).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

MEMORY = 25
"""SYNCs over which an estimate forgets: reversals with stiction (some SYNCs) do not move it by half a cycle."""
LEAST_STEP_MM = 0.02
"""Root mean square of the commanded step from which a lag can be told, mm per SYNC: four times what friction adds to
the following error."""
SETTLING = 100
"""SYNCs of a circle with such steps from which an estimate is certain: the speed has been reached, and four memories
have passed."""
CYCLES = 0.6
"""Change of a lag that is no axis' own, in cycles: answers are shifted by whole ones."""
EVERY = 5
"""SYNCs between two looks at the estimates: a fifth of their memory."""


class LagWatch:
    """Estimates the lag of six axes on circles, and compares each with its own at the start.

    Parameters
    ----------
    counts_per_mm : float
        Encoder scale.
    """

    def __init__(self, counts_per_mm: float) -> None:
        self._least = (LEAST_STEP_MM * counts_per_mm) ** 2
        self._squares = [0.0] * 6
        self._products = [0.0] * 6
        self._weight = 0.0
        self._told = [0] * 6
        self._first = [math.nan] * 6

    def update(self, steps: Sequence[int], errors: Sequence[int]) -> None:
        """Take in the targets' steps and the following errors of a SYNC, counts, shape (6,)."""
        keep = 1.0 - 1.0 / MEMORY
        self._squares = [keep * square + step * step for square, step in zip(self._squares, steps, strict=True)]
        each = zip(self._products, steps, errors, strict=True)
        self._products = [keep * product + step * error for product, step, error in each]
        self._weight = keep * self._weight + 1.0
        least = self._least * self._weight
        self._told = [told + 1 if square > least else 0 for told, square in zip(self._told, self._squares, strict=True)]

    def pause(self) -> None:
        """Leave a circle: what was estimated at first is kept."""
        self._told = [0] * 6

    def shifted(self) -> tuple[int, float, float] | None:
        """Return an axis whose answers are another SYNC's: its slot, its lag and the one at first (cycles); or None."""
        longest = max(self._told)
        if longest < SETTLING or longest % EVERY:
            return None
        certain = [slot for slot, told in enumerate(self._told) if told >= SETTLING]
        lags = {slot: self._products[slot] / max(self._squares[slot], 1.0) for slot in certain}
        for slot, lag in lags.items():
            if math.isnan(self._first[slot]):
                self._first[slot] = lag
        off = [slot for slot, lag in lags.items() if abs(lag - self._first[slot]) > CYCLES]
        return (off[0], lags[off[0]], self._first[off[0]]) if off else None
