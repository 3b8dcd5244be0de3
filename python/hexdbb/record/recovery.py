"""What a journal holds, read back: every whole batch, up to a torn tail or to the first sample that is wrong."""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO

import pyarrow as pa

from hexdbb.errors import InputError
from hexdbb.record.checks import check_record
from hexdbb.record.columns import BadRowError, Origin
from hexdbb.record.record import Record
from hexdbb.record.tables import from_table


def recover(path: Path | str) -> Record:
    """Make a record, marked incomplete, of what an interrupted capture left.

    Parameters
    ----------
    path : Path or str
        The journal; it stays.

    Returns
    -------
    Record
        Of every whole batch, up to the first sample that is wrong; its metadata say why it is incomplete.

    Raises
    ------
    InputError
        There is no such journal, it holds no samples, or a running capture is writing it.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    with path.open("rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(f"{path}: a running capture writes it (expected one that has ended)") from None
    return read_journal(path, complete=False, reason="the capture was interrupted")[0]


def read_journal(path: Path, complete: bool, reason: str | None) -> tuple[Record, int]:
    """Read a journal.

    Parameters
    ----------
    path : Path
        The journal.
    complete : bool
        Whether the capture ran to its end.
    reason : str or None
        Why it did not.

    Returns
    -------
    record : Record
        Its path is the journal's. Not complete if rows were left out.
    dropped : int
        Rows left out, because one of them is wrong and those after it cannot be trusted.
    """
    record = _whole_batches(path)
    try:
        check_record(record, Origin(str(path)))
    except BadRowError as error:
        dropped, complete, reason = len(record) - error.row, False, str(error)
        good = {name: values[: error.row] for name, values in record.columns.items()}
        record = replace(record, columns=good)
        check_record(record, Origin(str(path)))
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
    """Yield batches until the stream ends, as it should or by a torn tail."""
    try:
        with pa.ipc.open_stream(file) as stream:
            for batch in stream:
                batch.validate(full=True)
                yield batch
    except (pa.ArrowException, OSError):
        return
