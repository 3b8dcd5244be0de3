"""Lag of each axis behind its targets, as encoders and targets tell it: whether answers belong to their SYNC.

A position loop follows a smooth path with a following error e = tau v. Answers that come one SYNC late shift the error
by v times the cycle, which shows as a lag longer by one cycle, whatever the counts of answers say.
Source: least squares of e on v with exponential forgetting (Ljung, System Identification, section 11.2).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

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
        self._squares = np.zeros(6)
        self._products = np.zeros(6)
        self._weight = 0.0
        self._told = np.zeros(6, np.intp)
        self._first = np.full(6, np.nan)

    def update(self, steps: Sequence[int], errors: Sequence[int]) -> None:
        """Take in the targets' steps and the following errors of a SYNC, counts, shape (6,)."""
        keep = 1.0 - 1.0 / MEMORY
        step = np.asarray(steps, dtype=np.float64)
        self._squares = keep * self._squares + step * step
        self._products = keep * self._products + step * np.asarray(errors, dtype=np.float64)
        self._weight = keep * self._weight + 1.0
        seen = self._squares > self._least * self._weight
        self._told = np.where(seen, self._told + 1, 0)

    def pause(self) -> None:
        """Leave a circle: what was estimated at first is kept."""
        self._told[:] = 0

    def shifted(self) -> tuple[int, float, float] | None:
        """Return an axis whose answers are another SYNC's: its slot, its lag and the one at first (cycles); or None."""
        if self._told.max() < SETTLING or self._told.max() % EVERY:
            return None
        lag = np.where(self._told >= SETTLING, self._products / np.maximum(self._squares, 1.0), np.nan)
        self._first = np.where(np.isnan(self._first), lag, self._first)
        off = np.flatnonzero(np.abs(lag - self._first) > CYCLES)
        if not len(off):
            return None
        slot = int(off[0])
        return slot, float(lag[slot]), float(self._first[slot])
