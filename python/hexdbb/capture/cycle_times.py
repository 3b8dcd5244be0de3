"""Times between SYNCs and gaps of missed ones, counted by the loop whether anybody looks or not.

Counting takes a fraction of a microsecond and the same memory from the first cycle to the last; a display reads the
counts from another thread.
"""

from __future__ import annotations

from hexdbb.capture.latency import Latency

BIN_S = 0.0001
"""Width of a bin, s: a fortieth of a cycle at 250 Hz, and what a desktop kernel's wake-ups scatter by."""
BINS = 1001
"""Bins up to 100 ms, after which drives stop for lack of targets (1400h:05); the last one holds what is longer."""
GAPS = 26
"""Gaps of 0 to 24 missed SYNCs, 100 ms at 250 Hz; the last one holds what is longer."""


class CycleTimes:
    """Histograms of a running loop.

    Attributes
    ----------
    times : list of int
        Cycles by the time since the SYNC before, in bins of `BIN_S`, shape (`BINS`,).
    gaps : list of int
        SYNCs by the number missed immediately before, shape (`GAPS`,); what missed none is not counted.
    longest_s : float
        Longest time between two SYNCs, s.
    latency : Latency
        How late SYNCs were, and how soon answers came; in real time only, as in lockstep no time is due.
    """

    def __init__(self) -> None:
        self.times = [0] * BINS
        self.gaps = [0] * GAPS
        self.longest_s = 0.0
        self.latency = Latency()
        self._last_s: float | None = None

    def take(self, sync_s: float, missed: int) -> None:
        """Count one SYNC, sent at a monotonic time (s), before which some were missed."""
        if self._last_s is not None:
            time_s = sync_s - self._last_s
            self.times[min(int(time_s / BIN_S), BINS - 1)] += 1
            if time_s > self.longest_s:
                self.longest_s = time_s
        self._last_s = sync_s
        if missed:
            self.gaps[min(missed, GAPS - 1)] += 1

    def pause(self) -> None:
        """Do not count the time from the last SYNC to the next: none was due."""
        self._last_s = None

    def clear(self) -> None:
        """Begin anew."""
        self.times[:] = [0] * BINS
        self.gaps[:] = [0] * GAPS
        self.longest_s, self._last_s = 0.0, None
        self.latency.clear()
