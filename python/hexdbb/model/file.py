"""The model file: machine, effects with values, uncertainties and units, ledger of steps, hashes of the records."""

from __future__ import annotations

import math
import shutil
from collections.abc import Iterable
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import replacing
from hexdbb.files.validation import dump_toml, load_toml
from hexdbb.machine import MachineFile
from hexdbb.model.catalogue import effect_info
from hexdbb.model.earlier import Describe, earlier_entry, earlier_snapshot
from hexdbb.model.entries import EffectEntry, ModelFile, MountEntry, ParameterEntry, SizeEntry, StepEntry
from hexdbb.model.gained import with_gained_shape
from hexdbb.model.learned import LearnedEffect
from hexdbb.model.learned_entry import learned_effect, learned_entry
from hexdbb.model.ledger import LedgerStep, Size
from hexdbb.model.model import Model
from hexdbb.model.own import OwnEffect, OwnEffects
from hexdbb.model.shown import shown_value
from hexdbb.model.terms import MountKey, Parameter, Term
from hexdbb.units import shown_factor, shown_unit


def load_model(path: Path | str, effects: Iterable[OwnEffect] = ()) -> Model:
    """Read a model file; `effects` are those of the user's own that may stand in it.

    Raises
    ------
    InputError
        One line naming file, key, value and what was expected.
    """
    file = load_toml(path, ModelFile)
    mounts = tuple(MountKey(entry.record_sha256, entry.id) for entry in file.mounts)
    model = Model(file.machine, (), mounts).knowing_effects(effects)
    terms = tuple(_term(model, entry, f"{path}: effect[{index}]") for index, entry in enumerate(file.effects))
    names = [term.effect for term in terms]
    if len(set(names)) != len(names):
        raise InputError(f"{path}: effect: {', '.join(names)} (expected each effect once)")
    return replace(model, terms=terms, ledger=_ledger(file, mounts, model.own_effects, str(path)), path=Path(path))


def save_model(model: Model, path: Path | str) -> None:
    """Write a model file, whole or not at all; what stood there is kept as `NAME.previous.toml`.

    Raises
    ------
    RunError
        Where the file cannot be written.
    """
    place = Path(path)
    parameters = iter(model.parameters())
    describe = _describe(model.machine, model.own_effects)
    file = ModelFile(
        machine=model.machine,
        effect=tuple(_entry(term, [next(parameters) for _ in term.values]) for term in model.terms),
        mount=tuple(MountEntry(record_sha256=key.record_hash, id=key.mount_id) for key in model.mounts),
        step=tuple(_step_entry(step) for step in model.ledger),
        earlier=tuple(
            earlier_entry(step.step, step.before, describe) for step in model.ledger if step.before is not None
        ),
    )
    with replacing(place) as temporary:
        temporary.write_text(dump_toml(file), encoding="utf-8")
        if place.exists():
            shutil.copy2(place, place.with_suffix(".previous" + place.suffix))


def _describe(machine: MachineFile, own: OwnEffects) -> Describe:
    return lambda mounts, effect, learned: (
        effect_info(machine, max(mounts, 1), effect, own) if learned is None else learned.info()
    )


def _ledger(file: ModelFile, mounts: tuple[MountKey, ...], own: OwnEffects, path: str) -> tuple[LedgerStep, ...]:
    describe = _describe(file.machine, own)
    snapshots = {
        entry.before_step: earlier_snapshot(entry, mounts, describe, f"{path}: earlier[{index}]")
        for index, entry in enumerate(file.earlier)
    }
    return tuple(replace(_step(entry), before=snapshots.get(entry.step)) for entry in file.steps)


def _step(entry: StepEntry) -> LedgerStep:
    fields = {name: getattr(entry, name) for name in StepEntry.model_fields if name != "sizes"}
    return LedgerStep(**fields, sizes=tuple(Size(**size.model_dump()) for size in entry.sizes))


def _step_entry(step: LedgerStep) -> StepEntry:
    fields = {name: getattr(step, name) for name in StepEntry.model_fields if name != "sizes"}
    return StepEntry(**fields, size=tuple(SizeEntry(**asdict(size)) for size in step.sizes))


def _entry(term: Term, parameters: list[Parameter]) -> EffectEntry:
    entries = []
    for index, parameter in enumerate(parameters):
        sigma = float(term.sigma[index])
        entries.append(
            ParameterEntry(
                element=parameter.element,
                name=parameter.name,
                value=shown_value(float(term.values[index]), parameter.unit),
                unit=shown_unit(parameter.unit),
                sigma=None if math.isnan(sigma) else shown_value(sigma, parameter.unit),
                identifiable=bool(term.identifiable[index]),
                free=bool(term.free[index]),
            )
        )
    learned = None if term.learned is None else learned_entry(term.learned)
    return EffectEntry(name=term.effect, learned=learned, parameter=tuple(entries))


def _term(model: Model, entry: EffectEntry, where: str) -> Term:
    learned, info = _described(model, entry, where)
    expected = [(element, each.name, each.unit) for element in info.elements for each in info.parameters]
    entries = with_gained_shape(entry.parameters, info, lambda element, last: _start(info, element, last))
    if len(entries) != len(expected):
        raise InputError(f"{where}.parameter: {len(entry.parameters)} entries (expected {len(expected)})")
    values, sigma = np.zeros(len(expected)), np.full(len(expected), np.nan)
    for index, (given, (element, name, unit)) in enumerate(zip(entries, expected, strict=True)):
        found = (given.element, given.name, given.unit)
        if found != (element, name, shown_unit(unit)):
            raise InputError(
                f"{where}.parameter[{index}]: {' '.join(found)} (expected {element} {name} {shown_unit(unit)})"
            )
        values[index] = given.value / shown_factor(unit)
        if given.sigma is not None:
            sigma[index] = given.sigma / shown_factor(unit)
    identifiable = np.array([given.identifiable for given in entries], dtype=bool)
    free = np.array([given.free for given in entries], dtype=bool)
    return Term(entry.name, free, values, sigma, identifiable, learned)


def _start(info: _core.EffectInfo, element: str, last: ParameterEntry) -> ParameterEntry:
    """Return the entry of a shape that an effect has gained, free where the value written before it is."""
    shape = info.parameters[-1]
    return ParameterEntry(element=element, name=shape.name, value=0.0, unit=shown_unit(shape.unit), free=last.free)


def _described(model: Model, entry: EffectEntry, where: str) -> tuple[LearnedEffect | None, _core.EffectInfo]:
    """Return what an effect of the file is: learned, as the file itself says, or known by name."""
    if entry.learned is not None:
        try:
            learned = learned_effect(entry.name, entry.learned)
        except InputError as error:
            raise InputError(f"{where}.learned: {error}") from None
        return learned, learned.info()
    try:
        return None, model.info(entry.name)
    except InputError as error:
        raise InputError(f"{where}.name: {error}; an effect of your own: --effects FILE.py declares it") from None
