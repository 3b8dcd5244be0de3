"""File formats of a record, chosen by suffix: Parquet, the text form, an Excel workbook."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from hexdbb.errors import InputError
from hexdbb.record.checks import check_record
from hexdbb.record.columns import RowSource
from hexdbb.record.parquet import read_parquet, write_parquet
from hexdbb.record.record import Record
from hexdbb.record.text_form import read_text_form, write_text_form
from hexdbb.record.workbook import read_record_workbook, write_record_workbook


@dataclass(frozen=True)
class FileFormat:
    """Reader and writer of one file format of a record.

    Attributes
    ----------
    read : reads and checks a record
    write : writes a record without a check; arguments: record, path, overwrite
    """

    read: Callable[[Path], Record]
    write: Callable[[Record, Path, bool], None]


FORMATS = {
    ".parquet": FileFormat(read_parquet, write_parquet),
    ".csv": FileFormat(read_text_form, write_text_form),
    ".xlsx": FileFormat(read_record_workbook, write_record_workbook),
}
"""Formats by suffix; a further format is a further entry."""


def read_record(path: Path | str) -> Record:
    """Read and check a record.

    Parameters
    ----------
    path : Path or str
        A Parquet record, the CSV of a text form (its TOML beside it), or a workbook written by `write_record`.

    Returns
    -------
    Record

    Raises
    ------
    InputError
        One line naming the file, the row and column or key, the value and what was expected.
    """
    path = Path(path)
    file_format = _format_of(path)
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    return file_format.read(path)


def write_record(record: Record, path: Path | str, overwrite: bool = False, *, checked: bool = False) -> None:
    """Check a record and write it whole or not at all.

    Parameters
    ----------
    record : Record
    path : Path or str
        ``.parquet``, ``.xlsx``, or ``.csv`` for the text form: ``NAME.csv``, ``NAME.toml`` and ``NAME.machine.toml``.
    overwrite : bool
        Whether an existing file may be replaced.
    checked : bool
        True for a record unchanged since `read_record` or `recover` returned it: its samples are not checked again.

    Raises
    ------
    InputError
        The suffix is unknown, a sample is wrong, or the file exists.
    RunError
        The file could not be written.
    """
    file_format = _format_of(Path(path))
    if not checked:
        check_record(record, RowSource(record.name))
    file_format.write(record, Path(path), overwrite)


def _format_of(path: Path) -> FileFormat:
    if path.suffix == ".journal":
        raise InputError(f"{path}: the journal of a capture (expected a record; make one with: hexdbb recover {path})")
    if path.suffix not in FORMATS:
        raise InputError(f"{path}: suffix {path.suffix!r} (expected a record: {', '.join(FORMATS)})")
    return FORMATS[path.suffix]
