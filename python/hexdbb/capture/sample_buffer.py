"""From answers to samples: rows of the record, collected and appended to its journal in blocks.

A sample is held until it is confirmed: that every answer belonged to its SYNC shows only when none came too many.

Pairing: positions and reading of a row are the answers to one SYNC; commanded angle and targets of the row are those of
the SYNC before, which the drives have reached by then (`exchange`). The lag of the position loops is the difference
between target and position columns.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb.capture.exchange import Feedback
from hexdbb.record import SLIDER_COLUMNS, TARGET_COLUMNS, Journal
from hexdbb.trajectory import Programme

BLOCK_S = 0.25
"""Time by the clock that the oldest sample of a block waits, s: in lockstep machine time passes faster or slower. At
worst a block and the journal's writing period (0.2 s) are lost when the controller is killed: half of the second that
is allowed."""
MISSED_BEFORE = 1 << 8
"""Bit of the status column: cycles were missed just before this sample. Bits 0-7 are the gauge's status 6150h."""


class SampleBuffer:
    """Collects the captured rows of a programme and appends them to a journal.

    Parameters
    ----------
    programme : Programme
        The runs that the rows belong to.
    journal : Journal
        Receives the blocks.
    counts_per_mm : float
        Encoder scale.

    Attributes
    ----------
    count : int
        Samples confirmed so far.
    dropped : int
        Samples dropped so far.
    until_s : float
        Time from which samples on disk are doubtful, s; infinite where none is.
    """

    def __init__(self, programme: Programme, journal: Journal, counts_per_mm: float) -> None:
        self._programme, self._journal, self._counts_per_mm = programme, journal, counts_per_mm
        runs = programme.runs
        self._circle = np.array([run.circle.id for run in runs])
        self._sweep = np.array([run.sweep for run in runs])
        self._direction = np.array([run.direction for run in runs])
        self._feed_mm_min = np.array([run.feed_mm_min for run in runs])
        self._held: list[tuple[float, ...]] = []
        self._block: list[tuple[float, ...]] = []
        self._oldest_s = 0.0
        self.count = self.dropped = 0
        self.until_s = math.inf

    def keep(self, columns: Sequence[float], cycle_index: int, missed: int, feedback: Feedback) -> None:
        """Collect the answers of one captured row.

        Parameters
        ----------
        columns : sequence of float
            Run, lap, angle (deg) and the six targets (mm) of the row.
        cycle_index : int
            Time of motion of the sample, in cycles.
        missed : int
            Cycles missed immediately before the sample.
        feedback : Feedback
            The answers.
        """
        if not self._held and not self._block:
            self._oldest_s = time.monotonic()
        status = feedback.gauge_status | (MISSED_BEFORE if missed else 0)
        self._held.append((cycle_index, status, feedback.reading_um, *feedback.position, *columns))

    def confirm(self, held: int = 0) -> None:
        """Accept the samples collected, but for the last ones; append a block that has waited long enough.

        Parameters
        ----------
        held : int
            Number of samples still held.

        Raises
        ------
        RunError
            Earlier samples could not be written.
        """
        end = len(self._held) - held
        if end > 0:
            self._block += self._held[:end]
            del self._held[:end]
            self.count += end
        if self._block and time.monotonic() - self._oldest_s >= BLOCK_S:
            self.flush()

    def drop(self) -> None:
        """Drop the samples not confirmed: their answers may belong to other SYNCs."""
        self.dropped += len(self._held)
        self._held.clear()

    def cut(self, cycle_index: int) -> None:
        """Drop samples from a cycle on; `until_s` says from when those on disk are to be dropped as well."""
        self._held = [each for each in self._held if each[0] < cycle_index]
        self._block = [each for each in self._block if each[0] < cycle_index]
        self.until_s = cycle_index * self._programme.cycle_s

    def flush(self) -> None:
        """Append the confirmed samples to the journal; raises `RunError` if earlier samples could not be written."""
        if self._block:
            block = np.array(self._block)
            self._block.clear()
            self._oldest_s = time.monotonic()
            self._journal.append(self._columns(block))

    def _columns(self, block: NDArray[np.float64]) -> dict[str, NDArray[np.generic]]:
        run = block[:, 9].astype(np.intp)
        return {
            "t_s": block[:, 0] * self._programme.cycle_s,
            "circle": self._circle[run],
            "sweep": self._sweep[run],
            "direction": self._direction[run],
            "lap": block[:, 10].astype(np.int64),
            "angle_deg": block[:, 11],
            "feed_mm_min": self._feed_mm_min[run],
            **_named(SLIDER_COLUMNS, block[:, 3:9] / self._counts_per_mm),
            "reading_um": block[:, 2],
            **_named(TARGET_COLUMNS, block[:, 12:18]),
            "status": block[:, 1].astype(np.int32),
        }


def _named(names: Sequence[str], columns: NDArray[np.float64]) -> dict[str, NDArray[np.generic]]:
    return dict(zip(names, columns.T, strict=True))
