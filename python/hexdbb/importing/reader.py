"""One function that reads readings of any file: records, the text form, tables of other programs, Renishaw tests."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hexdbb.errors import InputError
from hexdbb.files.validation import read_text
from hexdbb.importing.mapping import SCHEMA, Mapping, load_mapping, mapping_of
from hexdbb.record import Record
from hexdbb.record import read_record as read_own_record
from hexdbb.record.formats import FORMATS
from hexdbb.record.workbook import is_record_workbook

Tell = Callable[[str], None]
BEFORE = {
    (".xls", ".xlsb", ".ods", ".numbers"): "the sheet saved as .xlsx or .csv",
    (".gz", ".zip", ".bz2", ".xz", ".7z"): "the file unpacked",
}
"""What to do first with a file that is not read, by its suffix."""


def read_measured(path: Path | str, mapping: Mapping | None = None, tell: Tell = lambda _: None) -> Record:
    """Read and check a record, or readings of another program.

    Parameters
    ----------
    path : Path or str
        A record (.parquet, or .xlsx as `hexdbb convert` writes it), the CSV of a text form (a measurement file of the
        same name beside it), or a file of another program: delimited text, an Excel sheet, a Renishaw test.
    mapping : Mapping, optional
        How to read a file of another program. Keys that it lacks are those of the mapping file `NAME.toml` beside the
        file, where there is one. Its name of the set-up (`mount`) holds for records too.
    tell : callable
        Is told in one line what was detected in a file of another program.

    Raises
    ------
    InputError
        One line naming the file, row, column or key, the value and what was expected.
    """
    path = Path(path)
    if _is_own(path):
        record = read_own_record(path)
        return record if mapping is None or mapping.mount is None else record.of_fixing(mapping.mount)
    from hexdbb.importing.foreign import (  # what our own records need not wait for: a tenth of the start
        READERS,
        imported,
    )

    if path.suffix.lower() not in READERS:
        known = ", ".join(dict.fromkeys((*FORMATS, *READERS)))
        first = next((f"{do}; " for suffixes, do in BEFORE.items() if path.suffix.lower() in suffixes), "")
        raise InputError(f"{path}: suffix {path.suffix!r} (expected {first}one of {known})")
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    return imported(path, (mapping or Mapping()).over(_beside(path)), tell)


def read_record(path: Path | str, mapping: Path | str | None = None, **choices: Any) -> Record:
    """Read and check a record, or readings of another program.

    Parameters
    ----------
    path : Path or str
        As of ``hexdbb convert``: .parquet, .csv, .txt, .xlsx, .b5r and others.
    mapping : Path or str, optional
        Mapping file.
    **choices
        Keys of a mapping file, which replace those of the file: ``plan="thesis"``, ``circle=0``,
        ``columns={"reading": "Abweichung"}``, ``units={"reading": "mm"}``.

    Returns
    -------
    Record

    Raises
    ------
    InputError
        One line naming the file, the row and column or key, the value and what was expected.
    """
    wanted = mapping_of("read_record", **choices)
    return read_measured(path, wanted if mapping is None else wanted.over(load_mapping(mapping)))


def _is_own(path: Path) -> bool:
    """Return whether a file is a record that says itself what it is."""
    if path.suffix == ".csv":
        return _schema_beside(path) not in (None, SCHEMA)
    if path.suffix == ".xlsx":
        return path.is_file() and is_record_workbook(path)
    return path.suffix in FORMATS or path.suffix == ".journal"


def _schema_beside(path: Path) -> str | None:
    """Return the schema of the TOML file beside a file; empty for one that states none, None where there is none."""
    beside = path.with_suffix(".toml")
    if not beside.is_file():
        return None
    try:
        return str(tomllib.loads(read_text(beside)).get("schema", ""))
    except (ValueError, RecursionError):  # its own reader says what is wrong with it
        return ""


def _beside(path: Path) -> Mapping:
    return load_mapping(path.with_suffix(".toml")) if _schema_beside(path) == SCHEMA else Mapping()
