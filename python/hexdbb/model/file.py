"""The model file: machine, effects with values, uncertainties and units, ledger of steps, hashes of the records."""

from __future__ import annotations

import math
import shutil
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from hexdbb.atomic_file import replacing
from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.model.model import LedgerStep, Model, MountKey, Parameter, Term, effect_info
from hexdbb.units import shown_factor, shown_unit
from hexdbb.validation import FileModel, NotNegative, Number, StrictModel, dump_toml, load_toml


class ParameterEntry(StrictModel):
    """One value of an effect in its unit; without `sigma` it is not known on its own, free it may be fitted."""

    element: str
    name: str
    value: Number
    unit: str
    sigma: NotNegative | None = None
    identifiable: bool = False
    free: bool = True


class EffectEntry(StrictModel):
    """One effect with its values, element by element."""

    name: str
    parameters: tuple[ParameterEntry, ...] = Field(default=(), strict=False, alias="parameter")


class MountEntry(StrictModel):
    """A fixing of the cup: the record that has it, by the hash of its content, and its id there."""

    record_sha256: str
    id: int


class StepEntry(StrictModel):
    """One step of the ledger."""

    step: int
    what: str
    rms_before_um: NotNegative
    rms_after_um: NotNegative
    records: Annotated[tuple[str, ...], Field(strict=False)] = ()


class ModelFile(FileModel):
    """A model file, validated."""

    schema_id: Literal["hexdbb.model/1"] = Field(default="hexdbb.model/1", alias="schema")
    machine: MachineFile
    effects: tuple[EffectEntry, ...] = Field(default=(), strict=False, alias="effect")
    mounts: tuple[MountEntry, ...] = Field(default=(), strict=False, alias="mount")
    steps: tuple[StepEntry, ...] = Field(default=(), strict=False, alias="step")


def load_model(path: Path | str) -> Model:
    """Read a model file.

    Raises
    ------
    InputError
        One line naming file, key, value and what was expected.
    """
    file = load_toml(path, ModelFile)
    mounts = tuple(MountKey(entry.record_sha256, entry.id) for entry in file.mounts)
    model = Model(file.machine, (), mounts)
    terms = tuple(_term(model, entry, f"{path}: effect[{index}]") for index, entry in enumerate(file.effects))
    names = [term.effect for term in terms]
    if len(set(names)) != len(names):
        raise InputError(f"{path}: effect: {', '.join(names)} (expected each effect once)")
    ledger = tuple(
        LedgerStep(entry.step, entry.what, entry.rms_before_um, entry.rms_after_um, entry.records)
        for entry in file.steps
    )
    return Model(file.machine, terms, mounts, ledger, Path(path))


def save_model(model: Model, path: Path | str) -> None:
    """Write a model file, whole or not at all; what stood there is kept as `NAME.previous.toml`.

    Raises
    ------
    RunError
        Where the file cannot be written.
    """
    place = Path(path)
    parameters = iter(model.parameters())
    effects = tuple(_entry(term, [next(parameters) for _ in term.values]) for term in model.terms)
    file = ModelFile(
        machine=model.machine,
        effect=effects,
        mount=tuple(MountEntry(record_sha256=key.record_hash, id=key.mount_id) for key in model.mounts),
        step=tuple(
            StepEntry(
                step=each.step,
                what=each.what,
                rms_before_um=each.rms_before_um,
                rms_after_um=each.rms_after_um,
                records=each.records,
            )
            for each in model.ledger
        ),
    )
    with replacing(place) as temporary:
        temporary.write_text(dump_toml(file), encoding="utf-8")
        if place.exists():
            shutil.copy2(place, place.with_suffix(".previous" + place.suffix))


def _entry(term: Term, parameters: list[Parameter]) -> EffectEntry:
    entries = []
    for index, parameter in enumerate(parameters):
        factor, sigma = shown_factor(parameter.unit), float(term.sigma[index])
        entries.append(
            ParameterEntry(
                element=parameter.element,
                name=parameter.name,
                value=float(term.values[index]) * factor,
                unit=shown_unit(parameter.unit),
                sigma=None if math.isnan(sigma) else sigma * factor,
                identifiable=bool(term.identifiable[index]),
                free=bool(term.free[index]),
            )
        )
    return EffectEntry(name=term.effect, parameter=tuple(entries))


def _term(model: Model, entry: EffectEntry, where: str) -> Term:
    try:
        info = effect_info(model.machine, max(len(model.mounts), 1), entry.name)
    except InputError as error:
        raise InputError(f"{where}.name: {error}") from None
    expected = [(element, each.name, each.unit) for element in info.elements for each in info.parameters]
    if len(entry.parameters) != len(expected):
        raise InputError(f"{where}.parameter: {len(entry.parameters)} entries (expected {len(expected)})")
    values, sigma = np.zeros(len(expected)), np.full(len(expected), np.nan)
    for index, (given, (element, name, unit)) in enumerate(zip(entry.parameters, expected, strict=True)):
        found = (given.element, given.name, given.unit)
        if found != (element, name, shown_unit(unit)):
            raise InputError(
                f"{where}.parameter[{index}]: {' '.join(found)} (expected {element} {name} {shown_unit(unit)})"
            )
        values[index] = given.value / shown_factor(unit)
        if given.sigma is not None:
            sigma[index] = given.sigma / shown_factor(unit)
    identifiable = np.array([given.identifiable for given in entry.parameters], dtype=bool)
    free = np.array([given.free for given in entry.parameters], dtype=bool)
    return Term(entry.name, free, values, sigma, identifiable)
