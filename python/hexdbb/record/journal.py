"""Journal of a running capture: an append-only Arrow IPC stream beside the record it becomes.

Samples are queued in memory and written by a thread of the journal, because a write may take longer than a cycle of
the capture. A second thread makes what is written durable (fsync), which on a busy disk takes up to a second and must
not hold up the next write: what is written survives the death of this program, what is durable survives that of the
computer. Whole batches are read back, and a torn tail is dropped.
"""

from __future__ import annotations

import fcntl
import math
import os
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

import numpy as np
import pyarrow as pa

from hexdbb.errors import InputError, RunError
from hexdbb.files.atomic_file import refuse_existing, sync_directory
from hexdbb.machine import MachineFile
from hexdbb.plan import Circle, Gauge, Mount
from hexdbb.record.abandoned import make_way
from hexdbb.record.arrow import array_of
from hexdbb.record.columns import REQUIRED_COLUMNS, BadRowError, Columns, RowSource, normalise
from hexdbb.record.journal_stream import write_batch
from hexdbb.record.parquet import SUFFIX, write_parquet
from hexdbb.record.record import Record
from hexdbb.record.recovery import read_journal
from hexdbb.record.tables import to_table

WRITE_PERIOD_S = 0.2
"""Time between two writes, s. A crash may cost at most one second of samples, which wait in the capture for a quarter
of it; the rest is left for a thread that the system lets wait."""
LATE_S = 0.4
"""Age of the oldest queued sample from which `append` writes by itself where it may, s: two periods, so that the thread
has missed one, and well within the second."""

REHEARSED_ROWS = 250
"""Rows of the batch that is written to memory beforehand: a second at 250 Hz, more than a batch holds."""


def journal_path(record_path: Path | str) -> Path:
    """Return the path of a record's journal, beside the record: `demo.parquet.journal`."""
    return Path(f"{record_path}.journal")


class Journal:
    """Samples of a running capture, on disk within one second.

    Parameters
    ----------
    path : Path or str
        Parquet record to be written; the journal is created beside it.
    machine, gauge, mounts, circles, metadata
        As in `Record`.
    overwrite : bool
        Whether an existing record may be replaced, and a journal set aside.
    written : callable, optional
        Takes the columns of every batch when it is on disk, in a thread of the journal; returns at once and does not
        raise.
    may_wait : bool
        Whether `append` may write samples itself where the thread is late: in lockstep, not in real time.

    Attributes
    ----------
    set_aside : Path or None
        Where the journal of an earlier, interrupted capture is kept now.

    Raises
    ------
    InputError
        The record exists, or the journal of an interrupted capture with samples does.
    """

    def __init__(
        self,
        path: Path | str,
        *,
        machine: MachineFile,
        gauge: Gauge,
        mounts: tuple[Mount, ...],
        circles: tuple[Circle, ...],
        metadata: Mapping[str, Any] | None = None,
        overwrite: bool = False,
        written: Callable[[Columns], None] | None = None,
        may_wait: bool = False,
    ) -> None:
        self.path, self.journal_path, self._may_wait = Path(path), journal_path(path), may_wait
        self._overwrite, self._written = overwrite, written
        if self.path.suffix != SUFFIX:
            raise InputError(f"{path}: suffix {self.path.suffix!r} (expected {SUFFIX})")
        refuse_existing(self.path, overwrite)
        self.set_aside = make_way(self.journal_path, overwrite)
        empty = {name: np.empty(0, kind) for name, kind in REQUIRED_COLUMNS.items()}
        header = Record(empty, gauge, mounts, circles, machine, dict(metadata or {}), self.path, complete=False)
        # Once and here: it takes milliseconds, and raises for metadata that JSON cannot hold.
        self._metadata = to_table(header).schema.metadata
        self._rehearse()
        self._file = _open_alone(self.journal_path)
        self._stream: pa.ipc.RecordBatchStreamWriter | None = None
        self._names: tuple[str, ...] | None = None
        self._rows_written = 0
        self._queued: list[Columns] = []
        self._queued_since_s = math.inf
        self._not_durable: deque[Columns] = deque()
        self._lock, self._writing = threading.Lock(), threading.Lock()
        self._stop, self._unsynced, self._written_all = threading.Event(), threading.Event(), threading.Event()
        self._failure: Exception | None = None
        self._threads = [
            threading.Thread(target=work, name="hexdbb-journal", daemon=True)
            for work in (self._write_until_stopped, self._sync_until_stopped)
        ]
        for thread in self._threads:
            thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def append(self, rows: Mapping[str, Any]) -> None:
        """Queue samples for writing and return at once, or once they are written where the thread is late.

        Parameters
        ----------
        rows : mapping of str to array_like, each of shape (n,) or ()
            Columns of a record; the same ones in every call.

        Raises
        ------
        InputError
            The columns are not those of a record, or not those of the first call.
        RunError
            Earlier samples could not be written.
        """
        self._raise_failure()
        if self._stop.is_set():
            raise RunError(f"{self.journal_path}: closed; it takes no more samples")
        columns = normalise(rows, RowSource(str(self.journal_path)))
        if self._names is None:
            self._names = tuple(columns)
        if tuple(columns) != self._names:
            raise InputError(f"{self.journal_path}: columns {', '.join(columns)} (expected {', '.join(self._names)})")
        now_s = time.monotonic()
        with self._lock:
            self._queued.append(columns)
            self._queued_since_s = min(self._queued_since_s, now_s)
            late = now_s - self._queued_since_s > LATE_S
        if late and self._may_wait:
            self._write_guarded()

    def close(self) -> None:
        """Write the queued samples and close the journal, to be recovered; a journal without samples is removed."""
        if self._file.closed:
            return
        self._stop.set()
        for thread in self._threads:
            thread.join()
        try:
            self._file.close()
        except OSError as error:
            self._failure = self._failure or error
        if self._stream is None:
            self.journal_path.unlink()

    def finish(
        self,
        complete: bool = True,
        reason: str | None = None,
        until_s: float = math.inf,
        metadata: Mapping[str, Any] | None = None,
    ) -> Record:
        """Write the Parquet record and remove the journal; the samples are checked once.

        Parameters
        ----------
        complete : bool
            Whether the capture ran to its end.
        reason : str, optional
            Why it did not; kept in the record's metadata as ``incomplete_because``.
        until_s : float
            Time (``t_s``) from which samples are left out.
        metadata : mapping, optional
            What became known while capturing; replaces entries that the journal was opened with.

        Raises
        ------
        RunError
            The journal or the record could not be written or the first sample is wrong, and the journal is kept; or
            there are no samples.
        """
        self.close()
        self._raise_failure()
        if self._stream is None:
            raise RunError(f"{self.path}: not written: no samples were captured")
        try:
            record, dropped = read_journal(self.journal_path, complete, reason, self._rows_written)
        except BadRowError as error:
            raise RunError(f"{self.path}: not written: {error}; the journal is kept") from None
        record.path = self.path
        record.metadata.update(metadata or {})
        before = record.columns["t_s"] < until_s
        if not before.any():
            self.journal_path.unlink()
            raise RunError(f"{self.path}: not written: no certain samples were captured")
        record.columns = {name: column[before] for name, column in record.columns.items()}
        try:
            write_parquet(record, self.path, self._overwrite)
        except RunError as error:
            raise RunError(f"{error}; the samples are kept: hexdbb recover {self.journal_path}") from None
        if not dropped:
            self.journal_path.unlink()
        return record

    def _raise_failure(self) -> None:
        if self._failure is not None:
            kept = f"what was written before is kept: hexdbb recover {self.journal_path}"
            raise RunError(f"{self.journal_path}: cannot be written: {self._failure} ({kept})")

    def _rehearse(self) -> None:
        """Write a batch to memory: what a first one costs must not be paid while axes move."""
        columns = {name: np.zeros(REHEARSED_ROWS, kind) for name, kind in REQUIRED_COLUMNS.items()}
        table = pa.table({name: array_of(values) for name, values in columns.items()}, metadata=self._metadata)
        with pa.ipc.new_stream(pa.BufferOutputStream(), table.schema) as stream:
            for batch in table.to_batches():
                write_batch(stream, batch, 0)

    def _write_until_stopped(self) -> None:
        due_s = time.monotonic()
        while not self._stop.is_set() and self._failure is None:
            # By the clock, not after the last write: a slow one must not delay the next.
            due_s = max(due_s + WRITE_PERIOD_S, time.monotonic())
            self._stop.wait(due_s - time.monotonic())
            self._write_guarded()
        self._write_guarded(last=True)
        self._written_all.set()
        self._unsynced.set()

    def _write_guarded(self, last: bool = False) -> None:
        """Write what is queued, and the end of the stream if `last`; keep an error, which the next `append` raises."""
        with self._writing:
            if self._failure is not None:
                return
            try:
                self._write_queued()
                if last and self._stream is not None:
                    self._stream.close()
                    self._file.flush()
            except (OSError, pa.ArrowException) as error:
                self._failure = error

    def _write_queued(self) -> None:
        """Write the queued samples as one batch."""
        with self._lock:
            queued, self._queued, self._queued_since_s = self._queued, [], math.inf
        if not queued:
            return
        columns = {name: np.concatenate([rows[name] for rows in queued]) for name in queued[0]}
        table = pa.table({name: array_of(values) for name, values in columns.items()}, metadata=self._metadata)
        if self._stream is None:
            self._stream = pa.ipc.new_stream(self._file, table.schema)
        for batch in table.to_batches():
            write_batch(self._stream, batch, self._rows_written)
            self._rows_written += batch.num_rows
        self._file.flush()
        self._not_durable.append(columns)
        self._unsynced.set()

    def _sync_until_stopped(self) -> None:
        """Make what is written durable, again and again, until all is written."""
        while not self._written_all.is_set() and self._failure is None:
            self._unsynced.wait()
            self._unsynced.clear()
            self._sync()
        self._sync()

    def _sync(self) -> None:
        """Wait until all that is written is on disk, and pass it on."""
        written = len(self._not_durable)
        try:
            os.fsync(self._file.fileno())
        except OSError as error:
            self._failure = self._failure or error
            return
        for _ in range(written):
            columns = self._not_durable.popleft()
            if self._written is not None:
                self._written(columns)


def _open_alone(path: Path) -> BinaryIO:
    """Open a journal under an exclusive lock and empty it."""
    try:
        file = path.open("ab")
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        raise InputError(f"{path}: in use by a running capture (expected another record name)") from None
    file.truncate(0)
    sync_directory(path.parent)
    return file
