"""What a logbook keeps: records, models, verdicts, compensation files; each is known by its content, not by its name.

A record's hash is that of its content (`Record.content_hash`), the same in every format: the CSV of a record that is
there as Parquet is the same entry. Of all other files it is the SHA-256 of their bytes.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from hexdbb.compensation import read_compensation
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import replacing
from hexdbb.files.validation import read_text
from hexdbb.machine import MachineFile
from hexdbb.model import load_model
from hexdbb.record import Record, read_record, write_record

FOLDERS = {"record": "records", "model": "models", "verdict": "verdicts", "compensation": "compensations"}
"""Kinds of entries, and the folder of each."""
SUFFIXES = {"record": ".parquet", "model": ".toml", "verdict": ".json", "compensation": ".hexcomp"}
MEASURED = (".parquet", ".csv", ".txt", ".tsv", ".dat", ".asc", ".xlsx", ".xlsm", ".b5r", ".xml")
"""Suffixes of records, and of readings of other programs."""
ReadRecord = Callable[[Path], Record]
MODEL_SCHEMA, RESULT_SCHEMA = "hexdbb.model/", "hexdbb."


@dataclass(frozen=True, eq=False)
class Content:
    """A file as a logbook sees it.

    Attributes
    ----------
    kind : str
        Key of `FOLDERS`.
    sha256 : str
    path : Path
        Where it was read.
    machine : MachineFile or None
        Whose it is; None where the file does not say.
    measured : str or None
        Time that the file itself states, ISO 8601.
    facts : dict
        What lists show, as JSON can represent it.
    record : Record or None
        The record itself.
    as_it_is : bool
        Whether its bytes are kept as they are; a record that is not Parquet, or was given a time, is written anew.
    """

    kind: str
    sha256: str
    path: Path
    machine: MachineFile | None
    measured: str | None
    facts: dict[str, Any]
    record: Record | None = None
    as_it_is: bool = True

    @property
    def place(self) -> str:
        """Path of the entry inside a logbook."""
        return f"{FOLDERS[self.kind]}/{self.sha256}{SUFFIXES[self.kind]}"

    def measured_at(self, measured: str) -> Content:
        """Return the same content with another time; a record's stands in its metadata, which its hash leaves out."""
        if self.record is None:
            return replace(self, measured=measured)
        record = replace(self.record, metadata={**self.record.metadata, "started": measured})
        return replace(self, measured=measured, record=record, as_it_is=False)

    def write(self, target: Path) -> None:
        """Write the content whole or not at all: the bytes as they are, or a record as Parquet.

        Raises
        ------
        RunError
            The file cannot be written.
        """
        if self.record is not None and not self.as_it_is:
            write_record(self.record, target, overwrite=True, checked=True)
            return
        with replacing(target) as temporary:
            temporary.write_bytes(self.path.read_bytes())


def content_of(path: Path, machine: MachineFile | None = None, read: ReadRecord = read_record) -> Content:
    """Read and check a file.

    Parameters
    ----------
    path : Path
    machine : MachineFile, optional
        Of the logbook, by which a compensation file is checked.
    read : callable
        Reads a record, or readings of another program as one.

    Raises
    ------
    InputError
        It is none of what a logbook keeps, or damaged.
    """
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    suffix = path.suffix.lower()
    if suffix in MEASURED:
        return _record(path, read)
    reader = {".toml": _model, ".json": _verdict}.get(suffix)
    return reader(path) if reader is not None else _compensation(path, machine)


def _record(path: Path, read: ReadRecord) -> Content:
    record = read(path)
    readings = record.columns["reading_um"]
    facts = {
        "samples": len(record),
        "circles": len(record.circles),
        "plan": str(record.metadata.get("plan", "")),
        "complete": record.complete,
        "readings_um": [float(readings.min()), float(readings.max())] if len(record) else [],
    }
    stated = record.metadata.get("started")
    return Content(
        "record",
        record.content_hash(),
        path,
        record.machine,
        None if stated is None else str(stated),
        facts,
        record,
        as_it_is=path.suffix == ".parquet" and read is read_record,
    )


def _model(path: Path) -> Content:
    model = load_model(path)
    facts = {
        "effects": [term.effect for term in model.terms],
        "steps": len(model.ledger),
        "records": list(dict.fromkeys(each for step in model.ledger for each in step.record_hashes)),
    }
    return Content("model", _sha256(path), path, model.machine, None, facts)


def _verdict(path: Path) -> Content:
    try:
        found = json.loads(read_text(path))
    except ValueError as error:
        raise InputError(f"{path}: not valid JSON: {error}") from None
    schema = found.get("schema") if isinstance(found, dict) else None
    if not isinstance(schema, str) or not schema.startswith(RESULT_SCHEMA):
        raise InputError(f"{path}: schema: {schema!r} (expected what a command printed with --json)")
    facts = {"schema": schema, "verdict": str(found.get("verdict", "")), "sentence": str(found.get("sentence", ""))}
    return Content("verdict", _sha256(path), path, None, None, facts)


def _compensation(path: Path, machine: MachineFile | None) -> Content:
    try:
        data = read_compensation(path, machine)
    except InputError as error:
        if "not a compensation file" not in str(error):
            raise
        expected = "a record, a model, what a command printed with --json, or a compensation file"
        raise InputError(f"{path}: nothing that a logbook keeps (expected {expected})") from None
    return Content("compensation", _sha256(path), path, None, None, {"name": data.name, "model": data.model_sha256})


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
