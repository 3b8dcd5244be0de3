"""Standstill of the axes: for how many cycles each of them has answered and not moved."""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.capture.exchange import Feedback

STANDSTILL_CYCLES = 10
"""Consecutive cycles without motion after which an axis counts as stopped: 40 ms at 250 Hz, long compared with the
instant in which an overshooting position loop reverses."""
STANDSTILL_COUNTS = 2
"""Largest change of position between two cycles of an axis at standstill, counts: the encoder's rounding by one count
to either side."""


class Standstill:
    """Counts for how many consecutive cycles each axis has answered and not moved.

    Parameters
    ----------
    position : sequence of int
        Positions last known, counts, shape (6,).
    """

    def __init__(self, position: Sequence[int]) -> None:
        self._before = list(position)
        self._still = [0] * 6

    def update(self, feedback: Feedback) -> None:
        """Compare the positions of a cycle with those of the cycle before."""
        for slot, position in enumerate(feedback.position):
            rests = slot not in feedback.missing and abs(position - self._before[slot]) <= STANDSTILL_COUNTS
            self._still[slot] = self._still[slot] + 1 if rests else 0
        self._before = list(feedback.position)

    def restart(self) -> None:
        """Count anew: the answers to a SYNC are not known."""
        self._still = [0] * 6

    def confirmed(self, slot: int) -> bool:
        """Return whether an axis has been at standstill for `STANDSTILL_CYCLES`."""
        return self._still[slot] >= STANDSTILL_CYCLES
