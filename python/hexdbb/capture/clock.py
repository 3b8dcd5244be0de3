"""Pace of the loop: the next SYNC when all answers have arrived (lockstep), or at a deadline (real time).

Real time: deadlines are one cycle apart on the monotonic clock. `time.sleep` waits on CLOCK_MONOTONIC with nanosecond
resolution (clock_nanosleep, Python 3.11). Cycles that pass while the loop is stalled are skipped and counted; SYNCs are
never sent in a burst to catch up, because the drives would jump.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Protocol


class Clock(Protocol):
    """Pace of the loop.

    Attributes
    ----------
    real_time : bool
        Whether SYNCs are sent at fixed times.
    late_s : float
        Time from the moment at which the last SYNC was due to the one at which it could be sent, s.
    """

    real_time: bool
    late_s: float

    def start(self) -> None:
        """Start counting; the first SYNC is due immediately."""

    def wait(self) -> int:
        """Wait until the next SYNC is due; return the number of cycles missed before it."""

    def answer_timeout_s(self) -> float:
        """Return the time (s) allowed for the answers to the SYNC just sent."""

    def let_pass(self, receive: Callable[[float], None]) -> int:
        """Send no SYNC for a while, in which late answers are received.

        Parameters
        ----------
        receive : callable
            Receives for a number of seconds; returns earlier when nothing is missing any more.

        Returns
        -------
        int
            Number of cycles that passed.
        """


class Lockstep:
    """Pace set by the nodes: the next SYNC follows the last answer, and results do not depend on timing.

    Parameters
    ----------
    patience_s : float
        Time to wait for a missing answer, s. 0.25 s outlasts the stalls of a desktop kernel (some 20 ms) and ends
        before the simulated drives stop for lack of targets (1400h:05, 100 ms, plus 1 s of tolerance).
    """

    real_time = False
    late_s = 0.0

    def __init__(self, patience_s: float = 0.25) -> None:
        self._patience_s = patience_s

    def start(self) -> None:
        """Do nothing: there is no time to count."""

    def wait(self) -> int:
        """Return 0 immediately: no cycle can be missed."""
        return 0

    def answer_timeout_s(self) -> float:
        """Return the patience (s), the same in every cycle."""
        return self._patience_s

    def let_pass(self, receive: Callable[[float], None]) -> int:
        """Wait for late answers as long as for timely ones; return 0: no cycle passes."""
        receive(self._patience_s)
        return 0


class Deadlines:
    """Pace set by the system clock: SYNCs at fixed times.

    Parameters
    ----------
    cycle_s : float
        Time between two deadlines, s.
    """

    real_time = True
    LATEST = 0.5
    """Largest delay of a SYNC, in cycles. A later SYNC is skipped: it would be nearer to the next deadline than to its
    own, and the drives' interpolation would see two targets within half a cycle."""
    ANSWER_SHARE = 0.75
    """Share of the cycle allowed for the answers. SYNC and TPDOs take at most 0.46 of a cycle at the largest bus load
    allowed (0.8); the last quarter is for checks and the next targets."""

    def __init__(self, cycle_s: float) -> None:
        self._cycle_s = cycle_s
        self._due_s = self.late_s = 0.0

    def start(self) -> None:
        """Set the first deadline to now."""
        self._due_s = time.monotonic()

    def wait(self) -> int:
        """Sleep until the next deadline that is not too late; return the number of cycles skipped."""
        now_s = time.monotonic()
        late_cycles = (now_s - self._due_s) / self._cycle_s
        missed = math.ceil(late_cycles) if late_cycles > self.LATEST else 0
        self._due_s += missed * self._cycle_s
        late_s = late_cycles * self._cycle_s
        if now_s < self._due_s:
            time.sleep(self._due_s - now_s)
            late_s = max(late_s, time.monotonic() - self._due_s)
        self.late_s = late_s
        self._due_s += self._cycle_s
        return missed

    def answer_timeout_s(self) -> float:
        """Return the time (s) left until the answers are due, at least 0."""
        return max(0.0, self._due_s - (1.0 - self.ANSWER_SHARE) * self._cycle_s - time.monotonic())

    def let_pass(self, receive: Callable[[float], None]) -> int:
        """Leave one SYNC out; return 1."""
        receive(max(0.0, self._due_s - time.monotonic()))
        if (left_s := self._due_s - time.monotonic()) > 0.0:
            time.sleep(left_s)
        self._due_s += self._cycle_s
        return 1
