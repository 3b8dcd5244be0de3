"""Text form of a record, for exchange with other programs: `NAME.csv` and `NAME.toml`.

Columns may come in any order and further ones are kept; floats are written so that they read back to the last bit.
A missing column `lap` is counted from the angle.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from pathlib import Path

import pyarrow as pa

from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, replacing
from hexdbb.files.delimited import read_rows
from hexdbb.files.validation import dump_toml, format_name, load_toml
from hexdbb.machine import machine_beside
from hexdbb.record.arrow import array_of
from hexdbb.record.cells import first_bad_cell, line_of_row
from hexdbb.record.checks import check_record
from hexdbb.record.columns import COLUMN_TYPES, REQUIRED_COLUMNS, Columns, RowSource, normalise
from hexdbb.record.conditions import described_metadata, with_description
from hexdbb.record.laps import counted_laps
from hexdbb.record.measurement import Measurement
from hexdbb.record.record import Record
from hexdbb.record.tables import to_columns


def read_text_form(path: Path) -> Record:
    """Read and check `NAME.csv` with the `NAME.toml` beside it.

    Raises
    ------
    InputError
        One line naming the file, the row, line and column or the key, the value and what was expected.
    """
    measurement_path = path.with_suffix(".toml")
    if not measurement_path.is_file():
        raise InputError(f"{path}: no such file {measurement_path} (expected gauge, mounts and circles beside the CSV)")
    measurement = load_toml(measurement_path, Measurement)
    source = RowSource(str(path), lambda row: line_of_row(path, row))
    columns = _read_columns(path)
    if "lap" not in columns and (laps := counted_laps(columns)) is not None:
        columns["lap"] = laps
    record = Record(
        columns=normalise(columns, source),
        gauge=measurement.gauge,
        mounts=measurement.mounts,
        circles=measurement.circles,
        machine=machine_beside(measurement.machine, measurement_path),
        metadata=described_metadata(measurement),
        path=path,
        complete=measurement.complete is not False,
    )
    check_record(record, source)
    return record


def _read_columns(path: Path) -> Columns:
    from pyarrow import csv as arrow_csv  # what commands on Parquet records need not wait for

    names = _header(path)
    types = {name: pa.float64() for name in names if name in COLUMN_TYPES}
    try:
        table = arrow_csv.read_csv(
            path,
            read_options=arrow_csv.ReadOptions(column_names=names, skip_rows=1),
            convert_options=arrow_csv.ConvertOptions(column_types=types, null_values=[""]),
        )
    except pa.ArrowInvalid as error:
        # Arrow's message names the fault, not its place.
        raise first_bad_cell(path, names, error) from None
    if any(_holds_line_end(column) for column in table.columns):
        raise first_bad_cell(path, names, ValueError("a cell holds a line end"))
    return to_columns(table)


def _holds_line_end(column: pa.ChunkedArray) -> bool:
    """Whether a text of the column has a line end: two stray quotes make one cell of all between them."""
    if not pa.types.is_string(column.type):
        return False
    import pyarrow.compute as pc  # registers hundreds of functions: 25 ms of every command's start

    return bool(pc.any(pc.match_substring_regex(column, "[\r\n]")).as_py())


def _header(path: Path) -> list[str]:
    """Read the column names; raise `InputError` where the first line does not hold them."""
    _, cells = next(read_rows(path), (1, []))
    names = [name.strip() for name in cells]
    if not names:
        raise InputError(f"{path}: empty file (expected a first line of column names: {', '.join(REQUIRED_COLUMNS)})")
    for index, name in enumerate(names):
        if name in names[:index]:
            raise InputError(f"{path}: column {format_name(name)}: occurs twice (expected each name once)")
    if len(names) == 1 and any(mark in names[0] for mark in ";\t"):
        raise InputError(f"{path}: line 1: one column {names[0]!r} (expected columns separated by commas)")
    return names


def _line(cells: Iterable[str]) -> str:
    """Return cells as a line of CSV, quoted where they hold commas or quotes."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(cells)
    return text.getvalue()


def write_text_form(record: Record, path: Path, overwrite: bool) -> None:
    """Write `NAME.csv`, `NAME.toml` and `NAME.machine.toml`, the CSV last; the samples are not checked.

    Raises
    ------
    InputError
        One of the files exists and `overwrite` is False, or their directory does not exist.
    RunError
        A file could not be written.
    """
    from pyarrow import csv as arrow_csv  # see `_read_columns`

    measurement_path, machine_path = path.with_suffix(".toml"), path.with_suffix(".machine.toml")
    for file in (path, measurement_path, machine_path):
        refuse_existing(file, overwrite)
    with replacing(machine_path) as temporary:
        temporary.write_text(dump_toml(record.machine), encoding="utf-8")
    with replacing(measurement_path) as temporary:
        temporary.write_text(
            dump_toml(with_description(record.measurement(machine_path.name), record.metadata)), encoding="utf-8"
        )
    with replacing(path) as temporary, temporary.open("wb") as stream:
        stream.write(_line(record.columns).encode())
        table = pa.table({name: array_of(values) for name, values in record.columns.items()})
        arrow_csv.write_csv(table, stream, arrow_csv.WriteOptions(include_header=False))
