"""Records as Arrow tables: the columns, and all else as schema metadata, as the Parquet file and the journal keep it.

Metadata keys: `hexdbb` (JSON: format, software version, complete or not, what else is known), `hexdbb.measurement` and
`hexdbb.machine` (TOML, as in files of their own).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pyarrow as pa

from hexdbb import __version__
from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.record.columns import Columns
from hexdbb.record.measurement import Measurement
from hexdbb.record.record import Record
from hexdbb.validation import dump_toml, parse_toml

FORMAT = "hexdbb.record/1"
KEY, MEASUREMENT_KEY, MACHINE_KEY = b"hexdbb", b"hexdbb.measurement", b"hexdbb.machine"


def to_table(record: Record) -> pa.Table:
    """Give a record as an Arrow table that stands alone."""
    return pa.table({name: pa.array(values) for name, values in record.columns.items()}, metadata=_metadata(record))


def _metadata(record: Record) -> dict[bytes, bytes]:
    head = {"format": FORMAT, "software": f"hexdbb {__version__}", "complete": record.complete}
    return {
        KEY: json.dumps(head | {"metadata": record.metadata}).encode(),
        MEASUREMENT_KEY: dump_toml(record.measurement(MACHINE_KEY.decode())).encode(),
        MACHINE_KEY: dump_toml(record.machine).encode(),
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
    metadata: dict[bytes, bytes] = table.schema.metadata or {}
    if not {KEY, MEASUREMENT_KEY, MACHINE_KEY} <= metadata.keys():
        raise InputError(
            f"{path}: not a record (expected file metadata {KEY.decode()!r}; others' data: .csv and .toml)"
        )
    head: dict[str, Any] = json.loads(metadata[KEY])
    if head.get("format") != FORMAT:
        raise InputError(f'{path}: format: "{head.get("format")}" (expected "{FORMAT}"; written by {head["software"]})')
    measurement = parse_toml(metadata[MEASUREMENT_KEY].decode(), Measurement, f"{path}: {MEASUREMENT_KEY.decode()}")
    return Record(
        columns=to_columns(table),
        gauge=measurement.gauge,
        mounts=measurement.mounts,
        circles=measurement.circles,
        machine=parse_toml(metadata[MACHINE_KEY].decode(), MachineFile, f"{path}: {MACHINE_KEY.decode()}"),
        metadata={"software": head["software"], **head["metadata"]},
        path=path,
        complete=head["complete"],
    )
