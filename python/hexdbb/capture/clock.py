"""When the next SYNC is due: as soon as the answers are in (lockstep), or at its deadline (real time).

Real time: deadlines lie one cycle apart on the monotonic clock. `time.sleep` waits on CLOCK_MONOTONIC with nanosecond
resolution (clock_nanosleep, Python 3.11). Slots that pass while the loop is held up are skipped and counted, never
made up for by a burst.
"""

from __future__ import annotations

import math
import time
from typing import Protocol


class Clock(Protocol):
    """Paces the loop."""

    real_time: bool

    def start(self) -> None:
        """Begin to count; the first SYNC is due at once."""

    def wait(self) -> int:
        """Wait until the next SYNC is due; returns the number of slots missed before it."""

    def answer_timeout_s(self) -> float:
        """Time the answers to the SYNC just sent may take."""


class Lockstep:
    """The next SYNC follows the last answer; results do not depend on timing.

    Parameters
    ----------
    patience_s : time one missing answer is waited for; well below the time after which drives miss their targets
    """

    real_time = False

    def __init__(self, patience_s: float = 0.25) -> None:
        self._patience_s = patience_s

    def start(self) -> None:
        """Nothing to do."""

    def wait(self) -> int:
        """Return at once."""
        return 0

    def answer_timeout_s(self) -> float:
        """Patience, the same for every cycle."""
        return self._patience_s


class Deadlines:
    """SYNCs at fixed times.

    Parameters
    ----------
    cycle_s : time between two deadlines
    """

    real_time = True
    LATEST = 0.5
    """Share of the cycle by which a SYNC may be late; later, its slot is left out: the next would follow too close."""
    ANSWER_SHARE = 0.75
    """Share of the cycle the answers may take; the rest is for checks and the next targets."""

    def __init__(self, cycle_s: float) -> None:
        self._cycle_s = cycle_s
        self._due_s = 0.0

    def start(self) -> None:
        """Put the first deadline at now."""
        self._due_s = time.monotonic()

    def wait(self) -> int:
        """Sleep until the next deadline, or skip to the slot that is due."""
        now_s = time.monotonic()
        late_cycles = (now_s - self._due_s) / self._cycle_s
        missed = math.ceil(late_cycles) if late_cycles > self.LATEST else 0
        self._due_s += missed * self._cycle_s
        if now_s < self._due_s:
            time.sleep(self._due_s - now_s)
        self._due_s += self._cycle_s
        return missed

    def answer_timeout_s(self) -> float:
        """Time left until the answers are due."""
        return max(0.0, self._due_s - (1.0 - self.ANSWER_SHARE) * self._cycle_s - time.monotonic())
