"""Parquet file of a record, zstd-compressed and complete in itself; pandas, polars, DuckDB and MATLAB read it.

A file proves itself twice: each page has the checksum of the Parquet format (CRC-32), and the metadata hold a digest of
every column of every row group and of every other metadata entry (`digests`), which covers what page checksums do not:
the file's index, types and names. A copy of the index lies at the beginning of the file (`footer_copy`). Files of
versions before digests, and of other programs, are read without.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, replacing
from hexdbb.record.checks import check_record
from hexdbb.record.columns import Columns, RowSource, joined
from hexdbb.record.digests import DIGESTS_KEY, digests_of, stated_digests, text_keys
from hexdbb.record.footer_copy import rebuilt, write_with_copy
from hexdbb.record.record import Record
from hexdbb.record.tables import KEY, from_columns, read_header, to_columns, to_table

SUFFIX = ".parquet"
ROWS_PER_GROUP = 4096
"""Limits what one damaged place can cost: the rows of one row group, 16 s at 250 Hz. Fewer rows would compress worse
and make the file's index, of 200 bytes a column and row group, larger than a hundredth of the data."""
GROUPS_AT_ONCE = 32
"""Row groups that are read together: 13 MB of an own record's 14 columns, and still long enough to be read in threads.
"""
THREADS_FROM = 16
"""Row groups from which the columns are read in threads. Below, 65,000 rows, one thread reads them within 8 ms, which
other threads hardly shorten, and on a computer whose cores are all busy waiting for them takes longer."""

DAMAGE = (pa.ArrowException, OSError, ValueError, KeyError, OverflowError, MemoryError)
"""What pyarrow raises for damaged files; `UnicodeDecodeError` of a name that is not text is a `ValueError`."""


def read_parquet(path: Path) -> Record:
    """Read and check a Parquet record.

    Raises
    ------
    InputError
        The file is damaged (names column and row group), not a record, of a later format, or holds a wrong sample.
    """
    try:
        with pq.ParquetFile(path, page_checksum_verification=True) as file:
            metadata, columns = _contents(file)
    except DAMAGE as error:
        raise _damage(path, error) from None
    if KEY in metadata:
        read_header(metadata[KEY], path)  # a later format may state its digests in another way
    digests = stated_digests(metadata, path)
    if digests is not None and (keys := digests.damaged_metadata(metadata)):
        raise InputError(f"{path}: metadata {', '.join(keys)}: damaged or changed (expected what was written)")
    record = from_columns(columns, metadata, path)
    if digests is not None and (parts := list(digests.damaged_parts(record.columns))):
        raise damaged_parts_error(path, parts)
    check_record(record, RowSource(str(path)))
    return record


def _contents(file: pq.ParquetFile) -> tuple[dict[str, bytes], Columns]:
    """Read metadata and all columns, some row groups at a time, so that no second copy of the whole is held."""
    metadata: dict[str, bytes] = {}
    parts: dict[str, list[NDArray[Any]]] = {}
    for first in range(0, max(file.num_row_groups, 1), GROUPS_AT_ONCE):
        groups = range(file.num_row_groups)[first : first + GROUPS_AT_ONCE]
        table = file.read_row_groups(list(groups), use_threads=len(groups) >= THREADS_FROM)
        table.validate(full=True)
        metadata = metadata or text_keys(table.schema.metadata)
        # A damaged file may hold column names that are not text; pyarrow decodes them only on access.
        for name, values in to_columns(table).items():
            parts.setdefault(name, []).append(values)
    columns = {name: joined(parts.pop(name)) for name in list(parts)}
    if any(len(values) != file.metadata.num_rows for values in columns.values()):
        raise ValueError(f"its index states {file.metadata.num_rows} rows")
    return metadata, columns


def damaged_parts_error(path: Path, parts: list[tuple[str, int]]) -> InputError:
    """Return the error that names the first damaged part, and how to save the others."""
    column, group = parts[0]
    more = f" and {len(parts) - 1} more" if len(parts) > 1 else ""
    return InputError(
        f"{path}: column {column}, row group {group + 1}{more}: damaged or changed"
        f" (expected what was written; save the rest with: hexdbb recover {path} -o NEW{SUFFIX})"
    )


def unreadable_parts(path: Path) -> list[tuple[str, int]]:
    """Return column and row group (from 0) of all that cannot be read; raises one of `DAMAGE` for a damaged index."""
    parts = []
    with pq.ParquetFile(path, page_checksum_verification=True) as file:
        for group in range(file.num_row_groups):
            for name in file.schema_arrow.names:
                try:
                    file.read_row_group(group, columns=[name]).validate(full=True)
                except DAMAGE:
                    parts.append((name, group))
    return parts


def _damage(path: Path, error: BaseException) -> InputError:
    """Return the error of a file that cannot be read whole: the part that is damaged, or the reader's reason."""
    try:
        if parts := unreadable_parts(path):
            return damaged_parts_error(path, parts)
    except DAMAGE:
        pass
    reason = next(iter(str(error).splitlines()), "damaged")
    saved = f"; save what is whole with: hexdbb recover {path} -o NEW{SUFFIX}" if rebuilt(path) is not None else ""
    return InputError(f"{path}: not a whole Parquet file: {reason} (expected a record of hexdbb{saved})")


def write_parquet(record: Record, path: Path, overwrite: bool) -> None:
    """Write a Parquet record with its digests, whole or not at all; its samples are not checked.

    Raises
    ------
    InputError
        The file exists and `overwrite` is False, or its directory does not exist.
    RunError
        The file could not be written.
    """
    refuse_existing(path, overwrite)
    table = to_table(record)
    metadata = text_keys(table.schema.metadata)
    digests = digests_of(record.columns, metadata, ROWS_PER_GROUP)
    table = table.replace_schema_metadata(metadata | {DIGESTS_KEY: digests.model_dump_json().encode()})
    measured = [name for name, values in record.columns.items() if values.dtype.kind == "f"]
    with replacing(path) as temporary:
        write_with_copy(
            table,
            temporary,
            ROWS_PER_GROUP,
            compression="zstd",
            compression_level=3,
            write_page_checksum=True,
            # Measured values hardly repeat: a dictionary of them would make the file a sixth larger. With the first
            # bytes of all values side by side, then their second ones, it is 3 to 15 % larger and decoded in 0.6 of the
            # time, which of many records counts more.
            use_dictionary=[name for name in record.columns if name not in measured],
            column_encoding=dict.fromkeys(measured, "BYTE_STREAM_SPLIT"),
        )
