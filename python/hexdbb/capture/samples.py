"""From answers to samples: the columns of a record, handed to its journal in blocks.

Pairing: the positions and the reading of a row come from the answers to one SYNC; the row's commanded angle and
targets are those of the SYNC before, where the drives have been led to by then (`exchange`). What the position loop
lags behind is in the difference between target and position columns.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb.capture.exchange import Feedback
from hexdbb.record import SLIDER_COLUMNS, TARGET_COLUMNS, Journal
from hexdbb.trajectory import Programme

BLOCK_S = 0.25
"""Machine time of the samples handed over at once: with the journal's own period, well under a second is unwritten."""
MISSED_BEFORE = 1 << 8
"""Bit of the status column: cycles were missed just before this sample. Bits 0-7 are the gauge's status 6150h."""


class Samples:
    """Collects the captured rows of a programme.

    Parameters
    ----------
    programme : whose table the rows are of
    journal : where blocks go
    counts_per_mm : scale of the positions

    Attributes
    ----------
    count : samples collected
    """

    def __init__(self, programme: Programme, journal: Journal, counts_per_mm: float) -> None:
        self._programme, self._journal, self._counts_per_mm = programme, journal, counts_per_mm
        runs = programme.runs
        self._circle = np.array([run.circle.id for run in runs])
        self._sweep = np.array([run.sweep for run in runs])
        self._direction = np.array([run.direction for run in runs])
        self._feed_mm_min = np.array([run.feed_mm_min for run in runs])
        self._block: list[tuple[float, ...]] = []
        self._block_size = max(1, round(BLOCK_S / programme.cycle_s))
        self.count = 0

    def keep(self, row: int, slot: int, missed: int, feedback: Feedback) -> None:
        """Take the answers of one captured row, sampled in time slot `slot`."""
        status = feedback.gauge_status | (MISSED_BEFORE if missed else 0)
        self._block.append((row, slot, status, feedback.reading_um, *feedback.position))
        self.count += 1
        if len(self._block) >= self._block_size:
            self.flush()

    def flush(self) -> None:
        """Hand over what has been collected; raises `RunError` where earlier samples could not be written."""
        if self._block:
            block = np.array(self._block)
            self._block.clear()
            self._journal.append(self._columns(block))

    def _columns(self, block: NDArray[np.float64]) -> dict[str, NDArray[np.generic]]:
        table = self._programme.table
        row = block[:, 0].astype(np.intp)
        run = table.run[row]
        return {
            "t_s": block[:, 1] * self._programme.cycle_s,
            "circle": self._circle[run],
            "sweep": self._sweep[run],
            "direction": self._direction[run],
            "lap": table.lap[row],
            "angle_deg": table.angle_deg[row],
            "feed_mm_min": self._feed_mm_min[run],
            **_named(SLIDER_COLUMNS, block[:, 4:10] / self._counts_per_mm),
            "reading_um": block[:, 3],
            **_named(TARGET_COLUMNS, table.sliders_mm[row]),
            "status": block[:, 2].astype(np.int32),
        }


def _named(names: Sequence[str], columns: NDArray[np.float64]) -> dict[str, NDArray[np.generic]]:
    return dict(zip(names, columns.T, strict=True))
