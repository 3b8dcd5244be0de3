"""Records read back from journals: every whole batch, up to a torn tail or to the first wrong sample."""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO

import pyarrow as pa

from hexdbb.errors import InputError
from hexdbb.record.checks import check_record
from hexdbb.record.columns import BadRowError, RowSource
from hexdbb.record.record import Record
from hexdbb.record.tables import from_table


def recover(path: Path | str) -> Record:
    """Read the record of an interrupted capture from its journal; it is checked and marked incomplete.

    Parameters
    ----------
    path : Path or str
        The journal; it is kept.

    Returns
    -------
    Record
        Every whole batch up to the first wrong sample; its metadata hold the reason under ``incomplete_because``.

    Raises
    ------
    InputError
        There is no such journal, it holds no right sample, or a running capture is writing it.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    with path.open("rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(f"{path}: in use by a running capture (expected one that has ended)") from None
    return read_journal(path, complete=False, reason="the capture was interrupted")[0]


def read_journal(path: Path, complete: bool, reason: str | None) -> tuple[Record, int]:
    """Read and check a journal.

    Parameters
    ----------
    path : Path
        The journal.
    complete : bool
        Whether the capture ran to its end.
    reason : str or None
        Why it did not; None for a complete one.

    Returns
    -------
    record : Record
        Its path is the journal's. Incomplete if rows were dropped.
    dropped : int
        Rows dropped: the first wrong one and all after it, since what made it wrong may have affected them.

    Raises
    ------
    InputError
        The journal holds no samples, or the first one is wrong.
    """
    record = _whole_batches(path)
    try:
        check_record(record, RowSource(str(path)))
    except BadRowError as error:
        if error.row == 0:
            raise
        # The rows before the first wrong one need no second check: a row is judged by itself and by earlier rows only.
        dropped, complete, reason = len(record) - error.row, False, str(error)
        record = replace(record, columns={name: values[: error.row] for name, values in record.columns.items()})
    else:
        dropped = 0
    because = {} if reason is None else {"incomplete_because": reason}
    return replace(record, complete=complete, metadata=record.metadata | because), dropped


def _whole_batches(path: Path) -> Record:
    with path.open("rb") as file:
        batches = list(_batches(file))
    if not batches:
        raise InputError(f"{path}: holds no samples (expected the journal of a capture)")
    return from_table(pa.Table.from_batches(batches), path)


def _batches(file: BinaryIO) -> Iterator[pa.RecordBatch]:
    """Yield batches until the stream ends, regularly or in a torn tail."""
    try:
        with pa.ipc.open_stream(file) as stream:
            for batch in stream:
                batch.validate(full=True)
                yield batch
    except (pa.ArrowException, OSError):
        return
