"""What is whole of a damaged Parquet record: the row groups whose required columns are as they were written.

Assumption: a reading without its other required columns is of no use, one without optional columns is. Row groups with
a damaged required column are left out; another column that is damaged in a row group that stays is left out as a whole.
Where the file's index or its metadata (gauge, circles, machine) are damaged, their copy at the beginning of the file is
used (`footer_copy`); where that is damaged too, nothing can be saved.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.record.columns import REQUIRED_COLUMNS
from hexdbb.record.digests import Digests, column_digest, stated_digests, text_keys
from hexdbb.record.footer_copy import rebuilt
from hexdbb.record.parquet import DAMAGE, damaged_parts_error, read_parquet
from hexdbb.record.record import Record
from hexdbb.record.tables import from_table

Parts = dict[str, list[NDArray[Any] | None]]
"""Values of each column by row group; None where they are damaged."""


def salvage(path: Path) -> tuple[Record, str]:
    """Read the whole parts of a damaged Parquet record.

    Returns
    -------
    record : Record
        Its samples are not checked.
    lost : str
        What is missing, in words.

    Raises
    ------
    InputError
        The record is whole, or its metadata or every row group are damaged.
    """
    metadata, parts, index_lost = _with_copy(path)
    damaged = _damaged(parts)
    groups = range(len(next(iter(parts.values()))))
    required = [parts.get(name, []) for name in REQUIRED_COLUMNS]
    kept = [group for group in groups if all(group < len(each) and each[group] is not None for each in required)]
    if not kept:
        raise damaged_parts_error(path, damaged)
    whole = {}
    for name, values in parts.items():
        present = [each for group in kept if (each := values[group]) is not None]
        if len(present) == len(kept):
            whole[name] = np.concatenate(present)
    record = from_table(pa.table(whole, metadata=metadata), path)
    return record, _lost(path, index_lost, damaged, [group for group in groups if group not in kept], whole)


def _with_copy(path: Path) -> tuple[dict[str, bytes], Parts, str]:
    """Return metadata and parts, read by the copy of the index where that is damaged, and what is wrong with it."""
    try:
        read_parquet(path)
    except InputError as error:
        refused = str(error)
    else:
        raise InputError(f"{path}: is whole (expected a damaged record, or the journal of a capture)")
    copy = rebuilt(path)
    if copy is None:
        return *_read(path, path), ""
    metadata, parts = _read(copy, path)  # the copy proves itself by its digest, which the index at the end does not
    try:
        same = _damaged(_read(path, path)[1]) == _damaged(parts) != []
    except InputError:
        same = False
    return metadata, parts, "" if same else refused.removeprefix(f"{path}: ").partition(" (expected")[0]


def _damaged(parts: Parts) -> list[tuple[str, int]]:
    """Return column and row group of all that is damaged."""
    return [(name, group) for name, values in parts.items() for group, each in enumerate(values) if each is None]


def _read(source: Path | pa.BufferReader, path: Path) -> tuple[dict[str, bytes], Parts]:
    """Read metadata and all that is whole of the columns; raises `InputError` where index or metadata are damaged."""
    try:
        with pq.ParquetFile(source, page_checksum_verification=True) as file:
            metadata = text_keys(file.schema_arrow.metadata)
            digests = stated_digests(metadata, path)
            parts = _parts(file, digests)
    except DAMAGE as error:
        reason = next(iter(str(error).splitlines()), "damaged")
        raise InputError(f"{path}: its index is damaged: {reason} (expected a Parquet file with its end)") from None
    if digests is not None and (keys := digests.damaged_metadata(metadata)):
        raise InputError(
            f"{path}: metadata {', '.join(keys)}: damaged or changed (expected what was written: nothing can be saved)"
        )
    return metadata, parts


def _parts(file: pq.ParquetFile, digests: Digests | None) -> Parts:
    """Read every column of every row group; what cannot be read, or is not as it was written, becomes None."""
    names = list({**(digests.columns if digests else {}), **dict.fromkeys(file.schema_arrow.names)})
    count = max([file.num_row_groups, *(len(each) for each in (digests.columns.values() if digests else ()))])
    return {name: [_part(file, name, group, digests) for group in range(count)] for name in names}


def _part(file: pq.ParquetFile, name: str, group: int, digests: Digests | None) -> NDArray[Any] | None:
    try:
        table = file.read_row_group(group, columns=[name])
        table.validate(full=True)
        values: NDArray[Any] = table.column(name).to_numpy()
    except (*DAMAGE, IndexError):
        return None
    stated = digests.columns.get(name, [])[group : group + 1] if digests else None
    return values if stated is None or stated == [column_digest(name, values)] else None


def _lost(path: Path, index_lost: str, damaged: list[tuple[str, int]], groups: list[int], whole: dict[str, Any]) -> str:
    """Return in words which row groups and columns are missing, and which damage is the reason."""
    lost = [f"{index_lost}: read by its copy"] if index_lost else []
    if groups:
        reasons = ", ".join(dict.fromkeys(name for name, group in damaged if group in groups))
        lost.append(f"row group {', '.join(str(group + 1) for group in groups)} left out ({reasons} damaged)")
    lost += [f"column {name} left out" for name in dict.fromkeys(name for name, _ in damaged) if name not in whole]
    return f"{path.name} was damaged: {'; '.join(lost)}"
