"""Rows of the table that are captured, on their way to the record."""

from __future__ import annotations

from hexdbb.capture.exchange import Feedback
from hexdbb.capture.loop import Loop
from hexdbb.capture.request import RunProgress
from hexdbb.capture.sample_buffer import SampleBuffer
from hexdbb.capture.targets_ahead import Row


class CapturedRows:
    """Passes the captured rows on to a sample buffer and reports progress.

    Parameters
    ----------
    samples : SampleBuffer
    loop : Loop
        Tells the time of motion.
    progress : RunProgress
        Updated with every row.
    """

    def __init__(self, samples: SampleBuffer, loop: Loop, progress: RunProgress) -> None:
        self._samples, self._loop, self._progress = samples, loop, progress

    def keep(self, row: Row, feedback: Feedback) -> None:
        """Take the answers of a row, to be confirmed or dropped later."""
        progress, loop = self._progress, self._loop
        progress.row, progress.place = row.index, (row.phase, row.run)
        progress.cycle_index, progress.reading_um = loop.cycle_index, feedback.reading_um
        progress.missed = loop.missed
        if row.captured:
            self._samples.keep(row.columns, loop.cycle_index, loop.last_missed, feedback)

    def settle(self, paired: bool, held: int) -> None:
        """Accept all but the last `held` rows taken, or drop all not accepted yet if not `paired`."""
        if paired:
            self._samples.confirm(held)
        else:
            self._samples.drop()
        self._progress.samples = self._samples.count

    def pause(self) -> None:
        """Append what was accepted to the journal."""
        self._samples.flush()
