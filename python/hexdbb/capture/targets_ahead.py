"""Targets of a run, read ahead of the loop from where they were kept when they were checked.

A thread reads block by block into a bounded queue, so that memory does not grow with the run and no cycle waits for a
disk; the first blocks are there before the axes are enabled.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Self

import numpy as np

from hexdbb.errors import RunError
from hexdbb.trajectory import Phase, Table

BLOCK_ROWS = 1024
"""Rows read at a time: 4 s at 250 Hz. Reading and converting them takes 1 ms, in steps shorter than a cycle."""
BLOCKS_AHEAD = 4
"""Blocks in the queue: 16 s at 250 Hz, longer than a disk that wakes up or a busy computer delays a read."""
PATIENCE_S = 10.0
"""Longest time to wait for a block, s, once the queue is empty. In real time the axes have stopped long before, because
the loop stalls; in lockstep nobody else would end the run."""


@dataclass(frozen=True, slots=True)
class Row:
    """One row of the targets.

    Attributes
    ----------
    index : int
        Number of the row, from 0.
    counts : list of int
        Targets, counts, shape (6,).
    phase : int
        `hexdbb.trajectory.Phase`.
    run : int
        Index of the run, -1 for none.
    captured : bool
        Whether the sample is recorded.
    columns : list of float
        Run, lap, angle (deg) and the six targets (mm), as the record takes them.
    """

    index: int
    counts: list[int]
    phase: int
    run: int
    captured: bool
    columns: list[float]

    @property
    def on_circle(self) -> bool:
        """Whether the bar is mounted and the ball on its circle, so that the reading must be valid."""
        return self.phase == Phase.ARC


class TargetsAhead:
    """Rows of targets in order, read by a thread ahead of their use.

    Parameters
    ----------
    part : callable
        Reads rows `first` to `last`, the last one left out; called in the thread.
    rows : int
        Number of rows.
    counts_per_mm : float
        Encoder scale.
    """

    def __init__(self, part: Callable[[int, int], Table], rows: int, counts_per_mm: float) -> None:
        self._part, self._rows, self._counts_per_mm = part, rows, counts_per_mm
        self._blocks: queue.Queue[list[Row] | Exception] = queue.Queue(BLOCKS_AHEAD)
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._read, name="hexdbb-targets", daemon=True)

    def begin(self) -> None:
        """Start to read, and wait for the first blocks."""
        self._thread.start()
        while self._thread.is_alive() and not self._blocks.full():
            self._thread.join(0.001)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """End the thread."""
        self._end.set()
        while self._thread.is_alive():
            self._drop_one()
            self._thread.join(0.01)

    def __iter__(self) -> Iterator[Row]:
        """Yield every row; raises `RunError` where they cannot be read in time."""
        for _ in range(0, self._rows, BLOCK_ROWS):
            try:
                block = self._blocks.get(timeout=PATIENCE_S)
            except queue.Empty:
                raise RunError(f"targets: not read within {PATIENCE_S:g} s (expected a disk that answers)") from None
            if isinstance(block, Exception):
                raise block
            yield from block

    def _read(self) -> None:
        for first in range(0, self._rows, BLOCK_ROWS):
            try:
                found: list[Row] | Exception = self._block(first)
            except Exception as error:  # raised where the rows are needed
                found = error
            self._blocks.put(found)
            if self._end.is_set() or isinstance(found, Exception):
                return

    def _block(self, first: int) -> list[Row]:
        table = self._part(first, min(first + BLOCK_ROWS, self._rows))
        counts = np.rint(table.sliders_mm * self._counts_per_mm).astype(np.int32).tolist()
        columns = np.column_stack([table.run, table.lap, table.angle_deg, table.sliders_mm]).tolist()
        each = zip(counts, table.phase.tolist(), table.run.tolist(), table.capture.tolist(), columns, strict=True)
        return [Row(first + k, *values) for k, values in enumerate(each)]

    def _drop_one(self) -> None:
        try:
            self._blocks.get_nowait()
        except queue.Empty:
            return
