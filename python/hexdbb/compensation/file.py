"""The compensation file: the part of a model that a motion controller can correct, written and read.

The engine decides which effects a controller can correct and defines the format (`compensation_file.hpp`). This module
passes it a model and turns its refusals into `InputError`. The format is described in docs/compensation.md.
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import replace
from pathlib import Path

from hexdbb import _core
from hexdbb.compensation.own_tables import own_tables
from hexdbb.compensation.tables import NoTableError, learned_tables
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import write_text
from hexdbb.kinematics import engine_machine
from hexdbb.machine import MachineFile
from hexdbb.model import Model
from hexdbb.record import Record

SUFFIX = ".hexcomp"

MAX_CORRECTION_MM = 1.0
"""Default limit of the correction of one slider. Leg errors of 0.1 mm need up to 1 mm where a leg stands steeply on its
guideway; a larger correction points to a model that extrapolates (docs/closed-loop.md)."""

REVERSAL_TRAVEL_MM = 0.01
"""Default slider travel after a reversal over which a direction-dependent correction changes over. Of the size of the
play in a good drive (5-20 µm), so that the correction moves about as fast as the slider itself."""


def make_compensation(
    model: Model,
    *,
    max_correction_mm: float = MAX_CORRECTION_MM,
    reversal_travel_mm: float = REVERSAL_TRAVEL_MM,
    reference_temperature_c: float | None = None,
) -> _core.CompensationData:
    """Return the part of a model that a controller can correct.

    Parameters
    ----------
    model : Model
        Learned effects, and users' effects that are functions of one variable, go in as tables.
    max_correction_mm : float
        Largest correction of one slider, mm; a controller refuses poses that need more.
    reversal_travel_mm : float
        Slider travel after a reversal over which a direction-dependent correction changes over, mm.
    reference_temperature_c : float, optional
        Temperature at the first sample of the record to which the model was fitted, °C; without it,
        temperature-dependent effects are left out.

    Returns
    -------
    CompensationData
        `effects` lists the corrected effects, `left_out` the others with the reason; `model_sha256` and
        `record_sha256` state its origin, in a file and in a C header too.
    """
    content = model.path.read_bytes() if model.path is not None and model.path.is_file() else b""
    known = replace(model, terms=tuple(term for term in model.terms if model.own(term.effect) is None))
    tables, left_out = _tables(model)
    return _core.compensation_of(
        known.engine(),
        name=model.machine.name,
        model_sha256=hashlib.sha256(content).hexdigest() if content else "",
        max_correction_mm=max_correction_mm,
        reversal_travel_mm=reversal_travel_mm,
        reference_temperature_c=math.nan if reference_temperature_c is None else reference_temperature_c,
        tables=tables,
        left_out=left_out,
        record_sha256=_record_hashes(model),
    )


def _record_hashes(model: Model) -> list[str]:
    """Return the content hashes of the records that the model's present values were fitted to; none if never fitted."""
    return list(next((step.record_hashes for step in reversed(model.ledger) if step.record_hashes), ()))


def _tables(model: Model) -> tuple[list[_core.CompensationTable], list[tuple[str, str]]]:
    """Return the tables of all effects that the engine does not have, and those that have none, with the reason."""
    tables, left_out = [], []
    for term in model.terms:
        own = model.own(term.effect)
        try:
            if term.learned is not None:
                tables += learned_tables(term, model.machine)
            elif own is not None:
                tables += own_tables(own, term.values, model.machine)
        except NoTableError as why:
            left_out.append((term.effect, str(why)))
    return tables, left_out


def reference_temperature_of(model: Model, record: Record) -> float:
    """Return the reference temperature of a model: that of the first sample of a record to which it was fitted.

    Returns
    -------
    float
        °C.

    Raises
    ------
    InputError
        The model was not fitted to this record, or the record has no temperature.
    """
    if record.content_hash() not in {each for step in model.ledger for each in step.record_hashes}:
        raise InputError(f"{record.name}: the model was not fitted to it (expected a record that its history names)")
    _, temperature_c = record.origin if record.origin is not None else (0.0, math.nan)
    if math.isnan(temperature_c):
        raise InputError(f"{record.name}: temperature_c: not measured (expected a record with a temperature)")
    return temperature_c


def write_compensation(data: _core.CompensationData, path: Path) -> None:
    """Write a compensation file whole or not at all, replacing an existing one.

    Raises
    ------
    RunError
        The file cannot be written.
    """
    write_text(path, data.text())


def read_compensation(path: Path, machine: MachineFile | None = None) -> _core.CompensationData:
    """Read and check a compensation file.

    Parameters
    ----------
    path : Path
    machine : MachineFile, optional
        The machine to be driven; a file made for another machine is refused.

    Raises
    ------
    InputError
        The file cannot be read, is malformed, truncated, altered, of a later version or made for another machine, or
        names an unknown effect.
    """
    try:
        data = _core.read_compensation(str(path))
        if machine is not None:
            _core.require_machine(data.machine, engine_machine(machine), str(path))
    except _core.CompensationError as error:
        # A message that quotes what is not UTF-8 is lost on some versions of Python, and an error of its own on others.
        raise InputError(str(error) or f"{path}: not UTF-8 (expected a compensation file)") from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: not UTF-8 (expected a compensation file)") from None
    return data
