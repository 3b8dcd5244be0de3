"""One record judged, on a worker: read, fitted or looked into for what is missing, and told in rows.

A record that cannot be judged is a result as well: its row says why. What is raised beyond that, a store that does not
answer, is the task's failure and tried again.
"""

from __future__ import annotations

import tempfile
import time
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from hexdbb import __version__
from hexdbb.cluster import storage_of
from hexdbb.comparison import UM_PER_MM, largest_quantities
from hexdbb.diagnosis import fit_free
from hexdbb.discovery import discover
from hexdbb.errors import HexdbbError, InputError
from hexdbb.files.results import number_or_none
from hexdbb.fleet.columns import UNKNOWN, machine_key
from hexdbb.importing import read_measured
from hexdbb.machine import load_machine
from hexdbb.model import Model, load_model, new_model
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb.threads import one_thread
from hexdbb.trend import dated
from hexdbb.trend.series import WATCHED_QUANTITIES

Row = dict[str, Any]
GEOMETRIC = "geometric errors"
"""Name of the model that is made where none is given."""


@one_thread
def judge(payload: dict[str, Any]) -> list[Row]:
    """Return the rows of a record.

    Parameters
    ----------
    payload : dict
        ``source``, its URL; ``files``, the paths of its files in the store, the record's own first; ``command``;
        ``model``, the text of a model file or machine file, or None.

    Raises
    ------
    RunError
        The store refuses or does not answer.
    """
    begun = time.perf_counter()
    row: Row = {"source": payload["source"], "command": payload["command"], "hexdbb": __version__}
    row |= {"machine": UNKNOWN, "month": UNKNOWN}
    with _local(payload["source"], payload["files"]) as path:
        try:
            row |= _of_record(record := _read(path, payload["source"]))
            found = _judged(record, _model_of(record, payload["model"]), payload["command"])
        except HexdbbError as error:
            found = [{"error": str(error)}]
    seconds = time.perf_counter() - begun
    return [{**row, **each, "seconds": seconds} for each in found]


@contextmanager
def _local(source: str, files: list[str]) -> Iterator[Path]:
    """Yield a record's file in this computer's file system, its companions beside it."""
    storage = storage_of(source)
    if storage.is_local:
        yield Path(files[0])
        return
    with tempfile.TemporaryDirectory(prefix="hexdbb-") as folder:
        for each in files:
            (Path(folder) / PurePosixPath(each).name).write_bytes(storage.read(each))
        yield Path(folder) / PurePosixPath(files[0]).name


def _read(path: Path, source: str) -> Record:
    """Read a record; errors name its source, not the copy that was read."""
    try:
        record = read_measured(path)
    except HexdbbError as error:
        raise InputError(str(error).replace(str(path.parent), source.rpartition("/")[0])) from None
    if not record.complete:
        raise InputError(f"{source}: the capture was interrupted (expected a complete record)")
    return record


def _of_record(record: Record) -> Row:
    """Return what a record says of itself; one without a time is judged too."""
    machine, metadata = record.machine, record.metadata
    found: Row = {
        "machine": machine_key(machine.name, machine.serial_number),
        "record": record.content_hash(),
        "machine_name": machine.name,
        "serial_number": machine.serial_number,
        "batch": _text(metadata.get("batch")),
        "plan": _text(metadata.get("plan")),
        "readings": len(record),
    }
    try:
        when = dated(record)
    except InputError:
        return found
    return found | {"measured_utc": when.measured.replace(tzinfo=None), "month": when.month}


def _text(stated: object) -> str | None:
    return None if stated is None else str(stated)


@dataclass(frozen=True)
class _Start:
    """What a fit starts from, and what it is called."""

    model: Model
    name: str


def _model_of(record: Record, text: str | None) -> _Start:
    return _Start(new_model(record.machine), GEOMETRIC) if text is None else _given(text)


@cache
def _given(text: str) -> _Start:
    """Return the model of a model file's text, or a new one of a machine file's; kept for the next record."""
    with tempfile.TemporaryDirectory(prefix="hexdbb-") as folder:
        path = Path(folder) / "model.toml"
        path.write_text(text, encoding="utf-8")
        if is_machine(text):
            machine = load_machine(path)
            return _Start(new_model(machine), f"{GEOMETRIC} of {machine.name}")
        model = load_model(path)
        return _Start(model, ", ".join(term.effect for term in model.terms if term.free.any()))


def is_machine(text: str) -> bool:
    """Return whether the text of a TOML file is that of a machine file."""
    try:
        return str(tomllib.loads(text).get("schema")).startswith("hexdbb.machine/")
    except tomllib.TOMLDecodeError:
        return False


def _judged(record: Record, start: _Start, command: str) -> list[Row]:
    samples = Samples.of([record])
    common: Row = {"model": start.name}
    for key, value in largest_quantities(samples, WATCHED_QUANTITIES).items():
        common[f"{key}_um"] = None if value is None else value * UM_PER_MM
    rows = _diagnosed(samples, start.model) if command == "diagnose" else _discovered(samples, start.model)
    return [{**common, **row} for row in rows]


def _diagnosed(samples: Samples, model: Model) -> list[Row]:
    """Return a row for every value of the machine's own that was fitted; sigma is null where not known alone."""
    found = fit_free(samples, model)
    enough = found.assess_sufficiency()
    columns, parameters = found.model.columns(), found.model.parameters()
    common: Row = {
        "rms_before_um": found.first.rms_before_mm * UM_PER_MM,
        "rms_after_um": found.result.rms_after_mm * UM_PER_MM,
        "noise_um": found.noise.sigma_mm * UM_PER_MM,
        "verdict": "sufficient" if enough.is_sufficient else "insufficient",
        "sentence": enough.sentence,
    }
    return [
        {
            **common,
            **{key: str(columns[key][row]) for key in ("effect", "element", "name", "unit")},
            "value": float(columns["value"][row]),
            "sigma": number_or_none(float(columns["sigma"][row])),
        }
        for row in np.flatnonzero(found.model.free)
        if not parameters[row].is_set_up
    ]


def _discovered(samples: Samples, model: Model) -> list[Row]:
    """Return a row for every value of every cause, or one without an effect where there is none."""
    found = discover(samples, model, with_tables=False)
    common: Row = {
        "rms_before_um": found.rms_before_um,
        "rms_after_um": found.rms_after_um,
        "noise_um": found.lack_of_fit.noise_um,
        "verdict": found.verdict,
        "sentence": found.sentence,
    }
    rows = [
        {
            **common,
            "effect": cause.effect,
            "element": size.element,
            "name": size.name,
            "value": size.value,
            "sigma": size.sigma,
            "unit": size.unit,
        }
        for cause in found.causes
        for size in cause.values
    ]
    named = [{**common, "effect": cause.effect} for cause in found.causes if not cause.values]
    return [*rows, *named] or [common]
