"""Latencies of a run, counted without growth of memory: how late SYNCs were, how soon answers came.

Counting takes a microsecond; the resolution is 4 % from a microsecond to minutes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

PER_OCTAVE = 16
"""Bins of a factor of two: 4 % each, finer than two measurements of one computer agree."""
LEAST_S = 1e-6
"""Upper end of the first bin, s: below the resolution of a sleep."""
BINS = 28 * PER_OCTAVE
"""Bins up to 2^28 µs, four minutes: longer than any run survives."""
SHARES = {"median": 0.5, "99 %": 0.99, "99.9 %": 0.999, "worst": 1.0}
"""Percentiles that are reported."""


class Histogram:
    """Counts times in bins of equal ratio, and keeps the longest one."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Begin anew."""
        self._counts = [0] * BINS
        self.count, self.longest_s = 0, 0.0

    def take(self, time_s: float) -> None:
        """Count one time, s; what is negative counts as 0."""
        octaves = math.log2(time_s / LEAST_S) if time_s > LEAST_S else 0.0
        self._counts[min(math.ceil(octaves * PER_OCTAVE), BINS - 1)] += 1
        self.count += 1
        if time_s > self.longest_s:
            self.longest_s = time_s

    def percentile_s(self, share: float) -> float:
        """Return the time (s) that a share of all times does not exceed: the upper end of its bin; 0 of none."""
        rest = share * self.count
        for index, count in enumerate(self._counts):
            rest -= count
            if count and rest <= 0.0:
                return min(LEAST_S * math.exp2(index / PER_OCTAVE), self.longest_s)
        return self.longest_s

    def share_above(self, time_s: float) -> float:
        """Return the share of times above a limit (s), by whole bins."""
        first = math.floor(math.log2(max(time_s, LEAST_S) / LEAST_S) * PER_OCTAVE) + 1
        return sum(self._counts[first:]) / self.count if self.count else 0.0

    def milliseconds(self) -> dict[str, float]:
        """Return the percentiles, ms."""
        return {name: round(1e3 * self.percentile_s(share), 3) for name, share in SHARES.items()}

    def words(self) -> str:
        """Return the percentiles for people."""
        return ", ".join(f"{shown_ms(value / 1e3)} ({name})" for name, value in self.milliseconds().items())


@dataclass
class Latency:
    """Latencies of a run in real time.

    Attributes
    ----------
    late : Histogram
        Time from the moment at which a SYNC was due to the one at which it could be sent.
    answered : Histogram
        Time from a SYNC to the last answer to it, where none was missing.
    """

    late: Histogram = field(default_factory=Histogram)
    answered: Histogram = field(default_factory=Histogram)

    def clear(self) -> None:
        """Begin anew."""
        self.late.clear()
        self.answered.clear()

    def metadata(self) -> dict[str, dict[str, float]]:
        """Return what a record keeps."""
        return {"sync_late_ms": self.late.milliseconds(), "answers_after_ms": self.answered.milliseconds()}

    def words(self) -> str:
        """Return all percentiles for people."""
        return f"SYNC late by {self.late.words()}; answers after {self.answered.words()}"


def shown_ms(time_s: float) -> str:
    """Return a time in milliseconds with two digits that count."""
    milliseconds = 1e3 * time_s
    return f"{milliseconds:.2f} ms" if milliseconds < 1.0 else f"{milliseconds:.1f} ms"
