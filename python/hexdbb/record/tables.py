"""Records as Arrow tables: the columns, and all else as schema metadata, as the Parquet file and the journal keep it.

Metadata keys: `hexdbb` (JSON: format, software version, complete or not, what else is known), `hexdbb.measurement` and
`hexdbb.machine` (TOML, as in files of their own).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final, Literal

import pyarrow as pa
from pydantic import BaseModel, ValidationError

from hexdbb import __version__
from hexdbb.errors import InputError
from hexdbb.files.validation import dump_toml, format_location, format_value, parse_toml
from hexdbb.machine import MachineFile
from hexdbb.record.columns import Columns
from hexdbb.record.measurement import Measurement
from hexdbb.record.record import Record

KEY, MEASUREMENT_KEY, MACHINE_KEY = "hexdbb", "hexdbb.measurement", "hexdbb.machine"
FORMAT: Final = "hexdbb.record/1"


class Head(BaseModel):
    """The JSON under `hexdbb`; keys that later versions add do no harm."""

    format: Literal["hexdbb.record/1"] = FORMAT
    software: str
    """What measured or converted."""
    complete: bool
    metadata: dict[str, Any]


def to_table(record: Record) -> pa.Table:
    """Give a record as an Arrow table that stands alone."""
    return pa.table({name: pa.array(values) for name, values in record.columns.items()}, metadata=_metadata(record))


def _metadata(record: Record) -> dict[str, str]:
    head = Head(software=f"hexdbb {__version__}", complete=record.complete, metadata=record.metadata)
    return {
        KEY: head.model_dump_json(),
        MEASUREMENT_KEY: dump_toml(record.measurement(MACHINE_KEY)),
        MACHINE_KEY: dump_toml(record.machine),
    }


def to_columns(table: pa.Table) -> Columns:
    """Give the columns of an Arrow table as NumPy arrays; empty cells of a number column become NaN."""
    return {name: table.column(name).to_numpy() for name in table.column_names}


def from_table(table: pa.Table, path: Path) -> Record:
    """Make a record of an Arrow table that was read from `path`.

    Raises
    ------
    InputError
        The table is not a record, or of a later format.
    """
    metadata = {key.decode(errors="replace"): value for key, value in (table.schema.metadata or {}).items()}
    if not {KEY, MEASUREMENT_KEY, MACHINE_KEY} <= metadata.keys():
        raise InputError(f'{path}: not a record (expected metadata "{KEY}"; bring data of other programs as .csv)')
    head = _read_head(metadata[KEY], path)
    measurement = parse_toml(metadata[MEASUREMENT_KEY].decode(errors="replace"), Measurement, f"{path}: measurement")
    return Record(
        columns=to_columns(table),
        gauge=measurement.gauge,
        mounts=measurement.mounts,
        circles=measurement.circles,
        machine=parse_toml(metadata[MACHINE_KEY].decode(errors="replace"), MachineFile, f"{path}: machine"),
        metadata={"software": head.software, **head.metadata},
        path=path,
        complete=head.complete,
    )


def _read_head(content: bytes, path: Path) -> Head:
    try:
        return Head.model_validate_json(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = format_location(first["loc"]) or KEY
        expected = f'a record of the format "{FORMAT}"'
        raise InputError(f"{path}: {where}: {format_value(first['input'])} (expected {expected})") from None
