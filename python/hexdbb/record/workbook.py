"""A record as an Excel workbook: the samples as a sheet, its measurement and machine file line by line as two others.

So a workbook stands alone, as a Parquet record does, and hexdbb reads it back. Numbers have 16 digits there, one short
of the last bit, so that its content hash is another: for a model it is another record.
"""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, replacing
from hexdbb.files.validation import dump_toml, parse_toml
from hexdbb.files.workbooks import MOST_ROWS, require_openpyxl, write_workbook
from hexdbb.machine import MachineFile
from hexdbb.record.checks import check_record
from hexdbb.record.columns import RowSource, normalise
from hexdbb.record.conditions import described_metadata, with_description
from hexdbb.record.measurement import Measurement
from hexdbb.record.record import Record

SAMPLES, MEASUREMENT, MACHINE = "samples", "measurement", "machine"
"""Names of the sheets."""


def write_record_workbook(record: Record, path: Path, overwrite: bool) -> None:
    """Write a record as a workbook; the samples are not checked.

    Raises
    ------
    InputError
        The file exists and `overwrite` is False, openpyxl is not installed, or a sheet has too few rows.
    RunError
        The file could not be written.
    """
    refuse_existing(path, overwrite)
    require_openpyxl(path)
    if len(record) + 1 > MOST_ROWS:
        raise InputError(
            f"{path}: {len(record)} samples (expected {MOST_ROWS - 1} at most, the rows of a sheet; .csv has no limit)"
        )
    measurement = with_description(record.measurement(MACHINE), record.metadata)
    sheets = {
        SAMPLES: _rows(record),
        MEASUREMENT: ([line] for line in dump_toml(measurement).splitlines()),
        MACHINE: ([line] for line in dump_toml(record.machine).splitlines()),
    }
    with replacing(path) as temporary:
        write_workbook(temporary, sheets)


def _rows(record: Record) -> Iterator[Sequence[Any]]:
    yield list(record.columns)
    columns = [values.tolist() for values in record.columns.values()]
    for row in zip(*columns, strict=True):
        yield [None if isinstance(cell, float) and np.isnan(cell) else cell for cell in row]


def is_record_workbook(path: Path) -> bool:
    """Return whether a file is a workbook with the sheets of a record."""
    try:
        with zipfile.ZipFile(path) as parts:
            book = parts.read("xl/workbook.xml").decode(errors="replace")
    except (OSError, zipfile.BadZipFile, KeyError, ValueError):
        return False
    return all(f'name="{sheet}"' in book for sheet in (SAMPLES, MEASUREMENT, MACHINE))


def read_record_workbook(path: Path) -> Record:
    """Read and check a record that `write_record_workbook` has written.

    Raises
    ------
    InputError
        One line naming the file, the sheet, the row and column or the key, the value and what was expected.
    """
    if not is_record_workbook(path):
        expected = f"sheets {SAMPLES}, {MEASUREMENT}, {MACHINE}; sheets of other programs need --plan"
        raise InputError(f"{path}: not a record (expected {expected})")
    book = require_openpyxl(path).load_workbook(path, read_only=True, data_only=True)
    try:
        rows = list(book[SAMPLES].iter_rows(values_only=True))
        texts = {
            name: "\n".join(str(row[0] or "") for row in book[name].iter_rows(values_only=True) if row)
            for name in (MEASUREMENT, MACHINE)
        }
    finally:
        book.close()
    measurement = parse_toml(texts[MEASUREMENT], Measurement, f"{path}: sheet {MEASUREMENT}")
    source = RowSource(f"{path}: sheet {SAMPLES}", lambda row: row + 2)
    names = [str(name) for name in rows[0]] if rows else []
    columns = {name: _column([row[place] for row in rows[1:]]) for place, name in enumerate(names)}
    record = Record(
        columns=normalise(columns, source),
        gauge=measurement.gauge,
        mounts=measurement.mounts,
        circles=measurement.circles,
        machine=parse_toml(texts[MACHINE], MachineFile, f"{path}: sheet {MACHINE}"),
        metadata=described_metadata(measurement),
        path=path,
        complete=measurement.complete is not False,
    )
    check_record(record, source)
    return record


def _column(cells: list[Any]) -> np.ndarray:
    if all(cell is None or isinstance(cell, (int, float)) for cell in cells):
        return np.array([np.nan if cell is None else cell for cell in cells], dtype=np.float64)
    return np.array(cells, dtype=object)
