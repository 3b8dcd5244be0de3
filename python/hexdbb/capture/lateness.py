"""How late this computer is: a thread that sleeps and measures when it wakes.

A node that does not answer and a computer that does not listen look the same from inside the loop. A thread that does
nothing but sleep is late for one reason only: this computer let it wait. Where this program itself used the processor
meanwhile, it is to blame; in a virtual machine that cannot be told, since a stop by the host counts as processor time
of whatever was running.
Assumption users get wrong: a simulated rig is a process of the same computer, and is late with it; real nodes are not.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

PERIOD_S = 0.004
"""Time the thread sleeps, s: a cycle at 250 Hz. A stall that costs a SYNC at a higher rate is longer than half of its
cycle and is seen all the same, since every sleep ends within it."""
LOCKSTEP_PERIOD_S = 0.01
"""The same in lockstep, s: a tenth of the shortest delay that is named there (`hexdbb.capture.blame`)."""
NOTED_S = 0.0005
"""Lateness from which a wake-up is kept, s: above that of an idle computer, below half a cycle at 1 kHz."""
KEPT = 512
"""Late wake-ups kept: 2 s of nothing else."""


class WakeUp(NamedTuple):
    """A late wake-up: when (monotonic, s), how late (s), and the processor time this program used meanwhile (s)."""

    at_s: float
    late_s: float
    own_s: float


class Lateness:
    """Measures in a thread how late this computer wakes it.

    Parameters
    ----------
    sleep : callable
        Sleeps for a number of seconds.
    now_s : callable
        Returns the monotonic time, s.
    used_s : callable, optional
        Returns the processor time that this program has used, s; default: the system's, 0 in a virtual machine.
    period_s : float
        Time it sleeps, s.

    Attributes
    ----------
    worst_s : float
        Largest lateness so far, s.
    """

    def __init__(
        self,
        sleep: Callable[[float], None] = time.sleep,
        now_s: Callable[[], float] = time.monotonic,
        used_s: Callable[[], float] | None = None,
        period_s: float = PERIOD_S,
    ) -> None:
        self._sleep, self._now_s, self._period_s = sleep, now_s, period_s
        self._used_s = used_s or ((lambda: 0.0) if is_virtual() else time.process_time)
        self._late: deque[WakeUp] = deque(maxlen=KEPT)
        self._due_s, self._used_at_s = float("inf"), 0.0
        self.worst_s = 0.0

    @contextmanager
    def measured(self) -> Iterator[None]:
        """Measure for the length of the context."""
        end = threading.Event()

        def measure() -> None:
            while not end.is_set():
                self.wake_once()

        thread = threading.Thread(target=measure, name="hexdbb-lateness", daemon=True)
        thread.start()
        try:
            yield
        finally:
            end.set()
            thread.join()
            self._due_s = float("inf")

    def wake_once(self) -> None:
        """Sleep once and keep the wake-up if it is late."""
        self._used_at_s = self._used_s()
        self._due_s = self._now_s() + self._period_s
        self._sleep(self._period_s)
        found = self._present()
        if found.late_s > NOTED_S:
            self._late.append(found)
            self.worst_s = max(self.worst_s, found.late_s)

    def worst_within(self, seconds: float) -> WakeUp:
        """Return the latest wake-up of the last seconds, one still to come included; one of 0 s where none was late."""
        found, since_s = self._present(), self._now_s() - seconds
        return max([found, *(each for each in tuple(self._late) if each.at_s >= since_s)], key=lambda each: each.late_s)

    def _present(self) -> WakeUp:
        """Return how late the thread is at the moment."""
        now_s = self._now_s()
        return WakeUp(now_s, max(now_s - self._due_s, 0.0), self._used_s() - self._used_at_s)


def is_virtual() -> bool:
    """Return whether the processor states a hypervisor."""
    try:
        return " hypervisor" in Path("/proc/cpuinfo").read_text(encoding="ascii", errors="replace")
    except OSError:
        return False
