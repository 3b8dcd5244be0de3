"""Records read back from journals and from damaged Parquet files: what is whole, up to the first wrong sample."""

from __future__ import annotations

import fcntl
from dataclasses import replace
from pathlib import Path

import pyarrow as pa

from hexdbb.errors import InputError
from hexdbb.record.checks import check_record
from hexdbb.record.columns import BadRowError, RowSource
from hexdbb.record.journal_stream import read_batches
from hexdbb.record.parquet import SUFFIX
from hexdbb.record.record import Record
from hexdbb.record.salvage import salvage
from hexdbb.record.tables import from_table


def recover(path: Path | str) -> Record:
    """Read what is whole of an interrupted capture's journal or of a damaged Parquet record, marked incomplete.

    Parameters
    ----------
    path : Path or str
        The journal, or the record (``.parquet``); it is kept.

    Returns
    -------
    Record
        Every whole batch or row group up to the first wrong sample, checked; its metadata hold the reason under
        ``incomplete_because``.

    Raises
    ------
    InputError
        There is no such file, it holds no right sample, a running capture is writing it, or the record is whole.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    if path.suffix == SUFFIX:
        record, lost = salvage(path)
        return _checked(record, complete=False, reason=lost)[0]
    with path.open("rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(f"{path}: in use by a running capture (expected one that has ended)") from None
    return read_journal(path, complete=False, reason="the capture was interrupted")[0]


def read_journal(path: Path, complete: bool, reason: str | None, rows: int | None = None) -> tuple[Record, int]:
    """Read and check a journal.

    Parameters
    ----------
    path : Path
        The journal.
    complete : bool
        Whether the capture ran to its end.
    reason : str or None
        Why it did not; None for a complete one.
    rows : int, optional
        Rows that were written to it; None where that is not known.

    Returns
    -------
    record : Record
        Its path is the journal's. Incomplete if rows were dropped.
    dropped : int
        Rows dropped: damaged ones, and the first wrong one with all after it.

    Raises
    ------
    InputError
        The journal holds no samples, or the first one is wrong.
    """
    read = read_batches(path)
    if not read.whole:
        damaged = f": {'; '.join(read.damaged)} damaged" if read.damaged else ""
        raise InputError(f"{path}: holds no samples{damaged} (expected the journal of a capture)")
    record = from_table(pa.Table.from_batches(read.whole), path)
    read.skip(rows or 0, [])
    if read.damaged:
        complete = False
        lost = f"{path.name}: damaged and left out: {'; '.join(read.damaged)}"
        reason = lost if reason is None else f"{reason}; {lost}"
    record, dropped = _checked(record, complete, reason)
    return record, dropped + read.lost


def _checked(record: Record, complete: bool, reason: str | None) -> tuple[Record, int]:
    """Return a record up to its first wrong sample, and the number of rows dropped.

    All rows after a wrong one are dropped too, since what made it wrong may have affected them.
    """
    dropped = 0
    try:
        check_record(record, RowSource(record.name))
    except BadRowError as error:
        if error.row == 0:
            raise
        # The rows before the first wrong one need no second check: a row is judged by itself and by earlier rows only.
        dropped, complete = len(record) - error.row, False
        reason = str(error) if reason is None else f"{reason}; {error}"
        record = replace(record, columns={name: values[: error.row] for name, values in record.columns.items()})
    because = {} if reason is None else {"incomplete_because": reason}
    return replace(record, complete=complete, metadata=record.metadata | because), dropped
