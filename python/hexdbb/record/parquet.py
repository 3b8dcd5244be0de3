"""Parquet file of a record, zstd-compressed and complete in itself; pandas, polars, DuckDB and MATLAB read it."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, replacing
from hexdbb.record.checks import check_record
from hexdbb.record.columns import RowSource
from hexdbb.record.record import Record
from hexdbb.record.tables import from_table, to_table


def read_parquet(path: Path) -> Record:
    """Read and check a Parquet record.

    Raises
    ------
    InputError
        The file is damaged, not a record, of a later format, or holds a wrong sample.
    """
    try:
        table = pq.read_table(path)
        table.validate(full=True)
        # A damaged file may hold column names that are not text; pyarrow decodes them only on access.
        table.column_names  # noqa: B018
    except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
        reason = next(iter(str(error).splitlines()), "damaged")
        raise InputError(f"{path}: not a whole Parquet file: {reason} (expected a record of hexdbb)") from None
    record = from_table(table, path)
    check_record(record, RowSource(str(path)))
    return record


def write_parquet(record: Record, path: Path, overwrite: bool) -> None:
    """Write a Parquet record, whole or not at all; its samples are not checked.

    Raises
    ------
    InputError
        The file exists and `overwrite` is False, or its directory does not exist.
    RunError
        The file could not be written.
    """
    refuse_existing(path, overwrite)
    with replacing(path) as temporary:
        pq.write_table(to_table(record), temporary, compression="zstd")
