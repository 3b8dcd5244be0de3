"""Records as Arrow tables: samples as columns, everything else as schema metadata; used by Parquet file and journal.

Metadata keys: `hexdbb` (JSON: format, software version, completeness, further metadata), `hexdbb.measurement` and
`hexdbb.machine` (TOML, in the form of the files of these kinds). The Parquet file adds `hexdbb.digests` (`digests`).
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any, Final, Literal, TypeVar

import pyarrow as pa
from pydantic import BaseModel, ValidationError

from hexdbb.errors import InputError
from hexdbb.files.validation import FileModel, dump_toml, format_location, format_value, parse_toml
from hexdbb.machine import MachineFile
from hexdbb.record.arrow import array_of, values_of
from hexdbb.record.columns import Columns
from hexdbb.record.digests import text_keys
from hexdbb.record.measurement import Measurement
from hexdbb.record.record import Record

KEY, MEASUREMENT_KEY, MACHINE_KEY = "hexdbb", "hexdbb.measurement", "hexdbb.machine"
FORMAT: Final = "hexdbb.record/1"
FileT = TypeVar("FileT", bound=FileModel)


class RecordHeader(BaseModel):
    """JSON under the metadata key `hexdbb`; unknown keys are ignored, so that later versions may add some."""

    format: Literal["hexdbb.record/1"] = FORMAT
    software: str
    """Name and version of the program that wrote the record."""
    complete: bool
    metadata: dict[str, Any]


def to_table(record: Record) -> pa.Table:
    """Return a record as an Arrow table that is complete in itself: n rows, metadata included."""
    return pa.table({name: array_of(values) for name, values in record.columns.items()}, metadata=_metadata(record))


def _metadata(record: Record) -> dict[str, str]:
    from hexdbb import __version__  # looked up for those who write

    header = RecordHeader(software=f"hexdbb {__version__}", complete=record.complete, metadata=record.metadata)
    return {
        KEY: header.model_dump_json(),
        MEASUREMENT_KEY: dump_toml(record.measurement(MACHINE_KEY)),
        MACHINE_KEY: dump_toml(record.machine),
    }


def to_columns(table: pa.Table) -> Columns:
    """Return the columns of an Arrow table as NumPy arrays of shape (n,); empty numeric cells become NaN."""
    return {name: values_of(table.column(name)) for name in table.column_names}


def batch_columns(batch: pa.RecordBatch) -> Columns:
    """Return the columns of one batch as NumPy arrays of shape (n,)."""
    return to_columns(pa.Table.from_batches([batch]))


def from_table(table: pa.Table, path: Path) -> Record:
    """Build a record from an Arrow table read from `path`; its samples are not checked.

    Raises
    ------
    InputError
        The table is not a record, or of a later format, or a column has the wrong type or length.
    """
    return from_columns(to_columns(table), text_keys(table.schema.metadata), path)


def from_columns(columns: Columns, metadata: dict[str, bytes], path: Path) -> Record:
    """Build a record from columns, each of shape (n,), and the metadata of the table they were read from.

    Raises
    ------
    InputError
        As `from_table`.
    """
    if missing := [each for each in (KEY, MEASUREMENT_KEY, MACHINE_KEY) if each not in metadata]:
        raise InputError(
            f'{path}: not a record (expected metadata "{missing[0]}"; bring data of other programs as .csv)'
        )
    header = read_header(metadata[KEY], path)
    measurement = _file(metadata[MEASUREMENT_KEY], Measurement, f"{path}: measurement")
    return Record(
        columns=columns,
        gauge=measurement.gauge,
        mounts=measurement.mounts,
        circles=measurement.circles,
        machine=_file(metadata[MACHINE_KEY], MachineFile, f"{path}: machine"),
        metadata={"software": header.software, **header.metadata},
        path=path,
        complete=header.complete,
    )


def _file(content: bytes, model: type[FileT], origin: str) -> FileT:
    """Return the file that a metadata entry holds; `InputError` names `origin`."""
    text = content.decode(errors="replace")
    try:
        found: FileT = _parsed(text, model)
    except InputError:
        return parse_toml(text, model, origin)  # raises it again, with the name of this record
    return found


@lru_cache(maxsize=64)
def _parsed(text: str, model: type[FileT]) -> FileT:
    """Parse a text once: the records of a machine, and of a plan, hold the same. What is returned cannot be changed."""
    return parse_toml(text, model, "")


def read_header(content: bytes, path: Path) -> RecordHeader:
    """Parse the JSON under `KEY`; raise `InputError` for another or a later format."""
    try:
        return RecordHeader.model_validate_json(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = format_location(first["loc"]) or KEY
        expected = f'a record of the format "{FORMAT}"'
        raise InputError(f"{path}: {where}: {format_value(first['input'])} (expected {expected})") from None
