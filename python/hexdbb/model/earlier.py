"""Earlier states of a model in its file: what each step of the ledger found, kept to be given back."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.model.entries import EarlierEffectEntry, EarlierEntry
from hexdbb.model.gained import with_gained_shape
from hexdbb.model.learned import LearnedEffect
from hexdbb.model.learned_entry import learned_effect, learned_entry
from hexdbb.model.ledger import Snapshot
from hexdbb.model.shown import engine_values, shown_values, units_of
from hexdbb.model.terms import MountKey, Term

Describe = Callable[[int, str, LearnedEffect | None], _core.EffectInfo]
"""Describes an effect, given the number of mounts, its name and, where it is learned, what it is."""


def earlier_entry(step: int, snapshot: Snapshot, describe: Describe) -> EarlierEntry:
    """Return the model before a step in the form of the file."""
    mounts = len(snapshot.mounts)
    effects = tuple(_entry(term, units_of(describe(mounts, term.effect, term.learned))) for term in snapshot.terms)
    return EarlierEntry(before_step=step, mounts=mounts, effect=effects)


def earlier_snapshot(entry: EarlierEntry, mounts: Sequence[MountKey], describe: Describe, where: str) -> Snapshot:
    """Return the model before a step, as a file has it.

    Raises
    ------
    InputError
        More mounts than the file has, an effect that is not known, or values that are not as many as it has.
    """
    if entry.mounts > len(mounts):
        raise InputError(f"{where}.mounts: {entry.mounts} (expected at most {len(mounts)}, as many as the file has)")
    terms = []
    for index, effect in enumerate(entry.effects):
        place = f"{where}.effect[{index}]"
        try:
            learned = None if effect.learned is None else learned_effect(effect.name, effect.learned)
            info = describe(entry.mounts, effect.name, learned)
        except InputError as error:
            raise InputError(f"{place}.name: {error}") from None
        terms.append(replace(_term(_of_now(effect, info), units_of(info), place), learned=learned))
    return Snapshot(tuple(terms), tuple(mounts[: entry.mounts]))


def _entry(term: Term, units: Sequence[str]) -> EarlierEffectEntry:
    unknown = bool(np.isnan(term.sigma).all())
    return EarlierEffectEntry(
        name=term.effect,
        values=shown_values(term.values, units),
        sigma=None if unknown else shown_values(term.sigma, units),
        identifiable=_flags(term.identifiable) if term.identifiable.any() else None,
        free=None if term.free.all() else _flags(term.free),
        learned=None if term.learned is None else learned_entry(term.learned),
    )


def _of_now(entry: EarlierEffectEntry, info: _core.EffectInfo) -> EarlierEffectEntry:
    """Return what a file has of an effect with the shape that the effect has gained since."""
    starts: dict[str, Callable[[str, Any], Any]] = {
        "values": lambda _, last: 0.0,
        "sigma": lambda _, last: math.nan,
        "identifiable": lambda _, last: False,
        "free": lambda _, last: last,
    }
    given = {key: getattr(entry, key) for key in starts}
    changed = {
        key: tuple(with_gained_shape(values, info, starts[key])) for key, values in given.items() if values is not None
    }
    return entry.model_copy(update=changed)


def _term(entry: EarlierEffectEntry, units: Sequence[str], where: str) -> Term:
    size = len(units)
    for key in ("values", "sigma", "identifiable", "free"):
        given = getattr(entry, key)
        if given is not None and len(given) != size:
            raise InputError(f"{where}.{key}: {len(given)} values (expected {size}, as {entry.name} has)")
    sigma = np.full(size, np.nan) if entry.sigma is None else engine_values(entry.sigma, units)
    return Term(
        effect=entry.name,
        free=_array(entry.free, size, left_out=True),
        values=engine_values(entry.values, units),
        sigma=sigma,
        identifiable=_array(entry.identifiable, size, left_out=False),
    )


def _flags(values: NDArray[np.bool_]) -> tuple[bool, ...]:
    return tuple(bool(each) for each in values)


def _array(flags: tuple[bool, ...] | None, size: int, *, left_out: bool) -> NDArray[np.bool_]:
    return np.full(size, left_out) if flags is None else np.array(flags, dtype=bool)
