"""The forms of a record on disk, by suffix."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from hexdbb.errors import InputError
from hexdbb.record.checks import check_record
from hexdbb.record.columns import Origin
from hexdbb.record.parquet import read_parquet, write_parquet
from hexdbb.record.record import Record
from hexdbb.record.text_form import read_text_form, write_text_form


@dataclass(frozen=True)
class Form:
    """How one form of a record is read and written."""

    read: Callable[[Path], Record]
    write: Callable[[Record, Path, bool], None]


FORMS = {".parquet": Form(read_parquet, write_parquet), ".csv": Form(read_text_form, write_text_form)}
"""Forms by suffix; another form is another entry."""


def read_record(path: Path | str) -> Record:
    """Read and check a record.

    Parameters
    ----------
    path : Path or str
        A Parquet record, or the CSV of a text form (its TOML beside it).

    Returns
    -------
    Record

    Raises
    ------
    InputError
        One line naming the file, the row and column or key, the value and what was expected.
    """
    path = Path(path)
    form = _form_of(path)
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    return form.read(path)


def write_record(record: Record, path: Path | str, overwrite: bool = False) -> None:
    """Check and write a record, whole or not at all.

    Parameters
    ----------
    record : Record
    path : Path or str
        ``.parquet``, or ``.csv`` for the text form: ``NAME.csv``, ``NAME.toml`` and ``NAME.machine.toml``.
    overwrite : bool
        Whether what stands there may be replaced.

    Raises
    ------
    InputError
        The suffix is unknown, a sample is wrong, or the file exists.
    RunError
        It could not be written.
    """
    form = _form_of(Path(path))
    check_record(record, Origin(record.name))
    form.write(record, Path(path), overwrite)


def _form_of(path: Path) -> Form:
    if path.suffix == ".journal":
        raise InputError(f"{path}: the journal of a capture (expected a record; make one with: hexdbb recover {path})")
    if path.suffix not in FORMS:
        raise InputError(f"{path}: suffix {path.suffix!r} (expected a record: {' or '.join(FORMS)})")
    return FORMS[path.suffix]
