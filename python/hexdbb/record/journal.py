"""The journal of a running capture: an append-only Arrow IPC stream beside the record it becomes.

Samples are handed over in memory and written by a thread of the journal's own, because waiting for a disk takes longer
than a cycle of the capture; they are on the disk (fsync) at most `SYNC_PERIOD_S` plus one write later. A crash of
any kind loses no more than that: whole batches are read back, and a torn tail is left out.
"""

from __future__ import annotations

import fcntl
import os
import threading
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

import numpy as np
import pyarrow as pa

from hexdbb.errors import InputError, RunError
from hexdbb.files.atomic_file import refuse_existing, sync_directory
from hexdbb.machine import MachineFile
from hexdbb.plan import Circle, Gauge, Mount
from hexdbb.record.columns import REQUIRED_COLUMNS, Columns, Origin, normalise
from hexdbb.record.formats import write_record
from hexdbb.record.record import Record
from hexdbb.record.recovery import read_journal
from hexdbb.record.tables import to_table

SYNC_PERIOD_S = 0.5
"""Longest time samples wait before they are written; half of what a crash may cost."""


def journal_path(record_path: Path | str) -> Path:
    """Give the journal's place beside the record's: `demo.parquet.journal`."""
    return Path(f"{record_path}.journal")


class Journal:
    """Samples of a running capture, on disk within a second.

    Parameters
    ----------
    path : Path or str
        The Parquet record it will become; the journal stands beside it.
    machine, gauge, mounts, circles, metadata
        As in `Record`.
    overwrite : bool
        Whether a record or journal that stands there may be replaced.

    Raises
    ------
    InputError
        The record exists, or the journal of an interrupted capture does.
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
    ) -> None:
        self.path, self.journal_path = Path(path), journal_path(path)
        self._overwrite = overwrite
        if self.path.suffix != ".parquet":
            raise InputError(f"{path}: suffix {self.path.suffix!r} (expected .parquet)")
        refuse_existing(self.path, overwrite)
        if self.journal_path.exists() and not overwrite:
            expected = f"none; make a record of it with: hexdbb recover {self.journal_path}"
            raise InputError(f"{self.journal_path}: left by an interrupted capture (expected {expected})")
        empty = {name: np.empty(0, kind) for name, kind in REQUIRED_COLUMNS.items()}
        self._header = Record(empty, gauge, mounts, circles, machine, dict(metadata or {}), self.path, complete=False)
        to_table(self._header)  # metadata that JSON cannot hold are refused here, not by the writing thread
        self._file = _open_alone(self.journal_path)
        self._stream: pa.ipc.RecordBatchStreamWriter | None = None
        self._names: tuple[str, ...] | None = None
        self._waiting: list[Columns] = []
        self._lock, self._stop = threading.Lock(), threading.Event()
        self._failure: Exception | None = None
        self._thread = threading.Thread(target=self._write_until_stopped, name="hexdbb-journal", daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def append(self, rows: Mapping[str, Any]) -> None:
        """Hand over samples; returns at once.

        Parameters
        ----------
        rows : mapping of str to array_like, each of shape (n,) or ()
            The columns of a record; the same ones with every call.

        Raises
        ------
        InputError
            The columns are not those of a record, or not those of the first call.
        RunError
            Earlier samples could not be written.
        """
        self._raise_failure()
        if self._stop.is_set():
            raise RunError(f"{self.journal_path}: closed; no more samples can be kept")
        columns = normalise(rows, Origin(str(self.journal_path)))
        if self._names is None:
            self._names = tuple(columns)
        if tuple(columns) != self._names:
            raise InputError(f"{self.journal_path}: columns {', '.join(columns)} (expected {', '.join(self._names)})")
        with self._lock:
            self._waiting.append(columns)

    def close(self) -> None:
        """Write what waits and leave the journal to be recovered; one without samples is removed."""
        if self._file.closed:
            return
        self._stop.set()
        self._thread.join()
        try:
            self._file.close()
        except OSError as error:
            self._failure = self._failure or error
        if self._stream is None:
            self.journal_path.unlink()

    def finish(self, complete: bool = True, reason: str | None = None) -> Record:
        """Make the Parquet record and remove the journal.

        Parameters
        ----------
        complete : bool
            Whether the capture ran to its end.
        reason : str, optional
            Why it did not; kept in the record's metadata as ``incomplete_because``.

        Raises
        ------
        RunError
            The journal or the record could not be written, and the journal stays; or there are no samples.
        """
        self.close()
        self._raise_failure()
        if self._stream is None:
            raise RunError(f"{self.path}: not written: no samples were captured")
        record, dropped = read_journal(self.journal_path, complete, reason)
        record.path = self.path
        write_record(record, self.path, overwrite=self._overwrite)
        if not dropped:
            self.journal_path.unlink()
        return record

    def _raise_failure(self) -> None:
        if self._failure is not None:
            kept = f"what was written before is kept: hexdbb recover {self.journal_path}"
            raise RunError(f"{self.journal_path}: cannot be written: {self._failure} ({kept})")

    def _write_until_stopped(self) -> None:
        try:
            while not self._stop.wait(SYNC_PERIOD_S):
                self._write_waiting()
            self._write_waiting()
            if self._stream is not None:
                self._stream.close()
                self._sync()
        except (OSError, pa.ArrowException) as error:
            self._failure = error

    def _write_waiting(self) -> None:
        """Write what waits as one batch, and wait for the disk."""
        with self._lock:
            waiting, self._waiting = self._waiting, []
        if not waiting:
            return
        columns = {name: np.concatenate([rows[name] for rows in waiting]) for name in waiting[0]}
        table = to_table(replace(self._header, columns=columns))
        if self._stream is None:
            self._stream = pa.ipc.new_stream(self._file, table.schema)
        self._stream.write_table(table)
        self._sync()

    def _sync(self) -> None:
        self._file.flush()
        os.fsync(self._file.fileno())


def _open_alone(path: Path) -> BinaryIO:
    """Open a journal for this process alone, and empty it once that is sure."""
    try:
        file = path.open("ab")
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        raise InputError(f"{path}: a running capture writes it (expected another record name)") from None
    file.truncate(0)
    sync_directory(path.parent)
    return file
