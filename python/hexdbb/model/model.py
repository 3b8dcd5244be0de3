"""A model is a machine plus a list of effects.

The values of all effects stand one after another in one vector, effect by effect, element by element, in the engine's
units; a `Parameter` names each place of it. What is known of the values (uncertainty, whether they are identifiable)
stands beside.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.files.frames import to_frame
from hexdbb.kinematics import engine_machine
from hexdbb.learned import Learned
from hexdbb.learned.places import is_learned
from hexdbb.machine import MachineFile
from hexdbb.model.catalogue import default_effects, effect_info, effect_infos, engine_effects
from hexdbb.model.choice import Choice
from hexdbb.model.ledger import LedgerStep, Snapshot
from hexdbb.model.own import OwnEffect, OwnEffects, Tabulate
from hexdbb.model.tables import value_columns, values_html
from hexdbb.model.terms import Bools, Floats, MountKey, Parameter, Term, extended, new_term, parameters_of, started_term

OF_EFFECTS = ("_infos", "needs", "_parameters", "prior_sigma", "start", "shaped")
"""What follows from machine, effects and number of mounts alone: models that differ in their values have it alike."""


@dataclass(frozen=True, repr=False)
class Model:
    """A machine, its effects, the mounts whose cups it knows, and the ledger of steps."""

    machine: MachineFile
    terms: tuple[Term, ...]
    mounts: tuple[MountKey, ...] = ()
    ledger: tuple[LedgerStep, ...] = field(default=())
    path: Path | None = field(default=None, compare=False)
    """The file it was read from."""
    own_effects: OwnEffects = field(default_factory=dict, compare=False)
    """Effects of the user's own that may stand in it, by name; the file does not keep what they do."""

    @property
    def name(self) -> str:
        """What errors call it: its file, where it has one."""
        return "the model" if self.path is None else str(self.path)

    def info(self, effect: str) -> _core.EffectInfo:
        """Return the description of one effect as it stands in this model."""
        if effect in self._infos:
            return self._infos[effect]
        own = self.own(effect)
        return effect_info(self.machine, max(len(self.mounts), 1), effect) if own is None else own.info()

    @cached_property
    def _infos(self) -> Mapping[str, _core.EffectInfo]:
        """Descriptions of those of its effects that are the engine's."""
        known = engine_effects()
        effects = tuple(term.effect for term in self.terms if term.effect in known and self._own(term) is None)
        return effect_infos(self.machine, max(len(self.mounts), 1), effects)

    def own(self, effect: str) -> OwnEffect | None:
        """Return an effect that is not the engine's, learned or the user's own; None for one of the engine's."""
        term = self.term(effect)
        return self.own_effects.get(effect) if term is None else self._own(term)

    def _own(self, term: Term) -> OwnEffect | None:
        return self.own_effects.get(term.effect) if term.learned is None else term.learned

    def needs_of(self, effect: str) -> frozenset[str]:
        """Return the columns of the samples' state on which an effect depends, in the model or not, learned or not.

        What a user's own effect asks samples for, nobody states; it counts as needing none.
        """
        if is_learned(effect):
            return Learned.parse(effect).variable.needs
        return frozenset(self.info(effect).needs)

    @cached_property
    def needs(self) -> frozenset[str]:
        """Columns of the samples' state on which its effects depend."""
        return frozenset(column for term in self.terms for column in self.info(term.effect).needs)

    @property
    def learned(self) -> tuple[Term, ...]:
        """Terms of learned effects."""
        return tuple(term for term in self.terms if term.learned is not None)

    def parameters(self) -> list[Parameter]:
        """Return name and nature of every value, in the order of `values`."""
        return list(self._parameters)

    @cached_property
    def _parameters(self) -> list[Parameter]:
        terms = self.terms
        return [each for term in terms for each in parameters_of(self.info(term.effect), self._own(term))]

    @property
    def snapshot(self) -> Snapshot:
        """Effects and mounts as they stand, for the ledger to keep."""
        return Snapshot(self.terms, self.mounts)

    @property
    def values(self) -> Floats:
        """All values, engine units, shape (size,)."""
        return np.concatenate([np.zeros(0), *(term.values for term in self.terms)])

    @property
    def sigma(self) -> Floats:
        """Standard deviations of the values, engine units, nan where not known."""
        return np.concatenate([np.zeros(0), *(term.sigma for term in self.terms)])

    @cached_property
    def prior_sigma(self) -> Floats:
        """Prior standard deviations (expected sizes) of the values, engine units, shape (size,)."""
        return _fixed([parameter.prior_sigma for parameter in self._parameters], np.float64)

    @cached_property
    def start(self) -> Floats:
        """Values before any fit, engine units, shape (size,): zero but for shape parameters of the user's effects."""
        return _fixed([parameter.start for parameter in self._parameters], np.float64)

    @cached_property
    def shaped(self) -> Bools:
        """Which values are shape parameters of the user's effects, shape (size,)."""
        return _fixed([parameter.shape is not None for parameter in self._parameters], np.bool_)

    @property
    def free(self) -> Bools:
        """Which values a diagnosis may change, shape (size,)."""
        return np.concatenate([np.zeros(0, bool), *(term.free for term in self.terms)])

    @property
    def identifiable(self) -> Bools:
        """Which values the readings determined on their own when they were fitted, shape (size,)."""
        return np.concatenate([np.zeros(0, bool), *(term.identifiable for term in self.terms)])

    def chosen(self, choices: str, option: str) -> Bools:
        """Return which values a text chooses: ``leg_length,guideway_translation:3``.

        Parameters
        ----------
        choices : str
            Separated by commas (`Choice`).
        option : str
            Where the text comes from, for errors (``--free``).

        Returns
        -------
        ndarray of bool, shape (size,)

        Raises
        ------
        InputError
            Naming an effect the model does not have, or an element the effect does not have.
        """
        chosen = np.zeros(len(self.values), dtype=bool)
        for text in filter(None, (part.strip() for part in choices.split(","))):
            choice = Choice.parse(text)
            if self.term(choice.effect) is None:
                present = ", ".join(term.effect for term in self.terms)
                raise InputError(f'{option}: "{choice.effect}" is not in the model (expected one of {present})')
            try:
                chosen |= self.values_of(choice)
            except InputError as error:
                raise InputError(f"{option}: {error}") from None
        if not chosen.any():
            raise InputError(
                f'{option}: "{choices}" chooses nothing (expected effects, as in leg_length,guideway_translation:3)'
            )
        return chosen

    def values_of(self, choice: Choice) -> Bools:
        """Return which values belong to an effect's elements, shape (size,); `InputError` as `Choice.of_effect`."""
        masks = [
            choice.of_effect(self.info(term.effect))
            if term.effect == choice.effect
            else np.zeros(len(term.values), bool)
            for term in self.terms
        ]
        return np.concatenate([np.zeros(0, bool), *masks])

    def term(self, effect: str) -> Term | None:
        """Return the effect of that name, None where the model does not have it."""
        return next((term for term in self.terms if term.effect == effect), None)

    def with_free(self, free: Bools) -> Model:
        """Return the same model with another choice of free values, shape (size,)."""
        return self._with_columns(free=free)

    def with_values(self, values: Floats, sigma: Floats | None = None, identifiable: Bools | None = None) -> Model:
        """Return the same model with other values; what is known of them is kept where it is not given."""
        known = {"sigma": sigma, "identifiable": identifiable}
        return self._with_columns(values=values, **{name: each for name, each in known.items() if each is not None})

    def with_effect(self, choice: Choice) -> Model:
        """Return a model with an effect too: new values are zero, those of the elements chosen free, others held.

        Where the model has the effect, the elements chosen become free.

        Raises
        ------
        InputError
            An effect or element that is not known, or that the model has free already.
        """
        chosen = choice.of_effect(self.info(choice.effect))
        present = self.term(choice.effect)
        if present is None:
            info, own = self.info(choice.effect), self.own(choice.effect)
            return replace(self, terms=(*self.terms, replace(started_term(choice.effect, own, info), free=chosen)))
        if present.free[chosen].all():
            raise InputError(f"{choice}: {self.name} has it already, free to be fitted (expected what it has not)")
        return self._with_term(replace(present, free=present.free | chosen))

    def without_effect(self, choice: Choice) -> Model:
        """Return a model without an effect, or with some elements of it held at zero; the last one removes the effect.

        Raises
        ------
        InputError
            An effect or element that is not known, or that the model does not have.
        """
        chosen = choice.of_effect(self.info(choice.effect))
        term = self.term(choice.effect)
        start = np.array([each.start for each in parameters_of(self.info(choice.effect), self.own(choice.effect))])
        if term is None or not (term.free[chosen] | (term.values[chosen] != start[chosen])).any():
            free = ", ".join(each.effect for each in self.terms if each.free.any())
            raise InputError(f"{choice}: not in {self.name} (expected one of {free})")
        left = replace(
            term,
            free=term.free & ~chosen,
            values=np.where(chosen, start, term.values),
            sigma=np.where(chosen, np.nan, term.sigma),
            identifiable=term.identifiable & ~chosen,
        )
        if left.free.any() or (left.values != start).any():
            return self._with_term(left)
        return replace(self, terms=tuple(each for each in self.terms if each.effect != choice.effect))

    def with_mounts(self, keys: Sequence[MountKey]) -> Model:
        """Return the same model knowing these mounts too; their cups stand where planned until they are fitted."""
        new = [key for key in keys if key not in self.mounts]
        if not new:
            return self
        wider = replace(self, mounts=(*self.mounts, *new))
        terms = tuple(extended(term, wider.info(term.effect).size) for term in self.terms)
        return wider._known_to(replace(wider, terms=terms))

    def knowing_effects(self, effects: Iterable[OwnEffect]) -> Model:
        """Return the same model, in which effects of the user's own may stand too."""
        return replace(self, own_effects={**self.own_effects, **{each.name: each for each in effects}})

    def engine(self, tabulate: Tabulate | None = None) -> _core.Model:
        """Return the engine's form of the model.

        Parameters
        ----------
        tabulate : callable, optional
            Evaluates effects of the user's own for the samples that are to be predicted
            (`hexdbb.samples.Samples.engine`); a model that has such predicts these samples and parts of them only.

        Raises
        ------
        InputError
            An effect of the user's own without samples, or one that fails, with its file and line.
        """
        engine = _core.Model(engine_machine(self.machine))
        for term in self.terms:
            own = self._own(term)
            if own is None:
                engine.add(term.effect, max(len(self.mounts), 1))
            elif tabulate is None:
                kind = "a learned effect" if term.learned is not None else "an effect of your own"
                raise InputError(f"{term.effect}: {kind} is known in measured samples only, not here")
            else:
                tabulate(own, term.values).add_to(engine)
        # A user's effect is tabulated at its shapes: to the engine they are differences from there.
        engine.values = np.where(self.shaped, 0.0, self.values)
        return engine

    def columns(self) -> dict[str, NDArray[Any]]:
        """Return every value with name, uncertainty and unit, one array a column (`hexdbb.model.tables`)."""
        return value_columns(self.parameters(), self.values, self.sigma, self.identifiable, self.free)

    def to_frame(self) -> Any:
        """Return `columns` as a ``pandas.DataFrame``; `InputError` where pandas is not installed."""
        return to_frame(self.columns())

    def __repr__(self) -> str:
        effects = ", ".join(term.effect for term in self.terms) or "no effects"
        counts = f"{len(self.values)} values ({int(self.free.sum())} free), {len(self.mounts)} mounts"
        return f"<Model of {self.machine.name}: {counts}, {len(self.ledger)} steps; {effects}>"

    def _repr_html_(self) -> str:
        return values_html(self.columns())

    def _with_columns(self, **columns: NDArray[Any]) -> Model:
        """Replace columns of shape (size,), each cut into the terms' parts."""
        for name, column in columns.items():
            if len(column) != len(self.values):
                raise ValueError(f"{name}: {len(column)} values for a model of {len(self.values)}")
        terms, at = [], 0
        for term in self.terms:
            span = slice(at, at + len(term.values))
            terms.append(Term(**vars(term) | {name: column[span] for name, column in columns.items()}))
            at = span.stop
        return self._known_to(replace(self, terms=tuple(terms)))

    def _known_to(self, other: Model) -> Model:
        """Return another model of the same effects, to which what follows from them is handed over."""
        vars(other).update({name: found for name in OF_EFFECTS if (found := vars(self).get(name)) is not None})
        return other

    def _with_term(self, term: Term) -> Model:
        return replace(self, terms=tuple(term if each.effect == term.effect else each for each in self.terms))


def new_model(machine: MachineFile, effects: Sequence[str] | None = None) -> Model:
    """Make a model with all values zero: the nominal machine.

    Parameters
    ----------
    machine : MachineFile
    effects : sequence of str, optional
        Names of the effects, all free; `default_effects` where not given, none at all where empty.

    Raises
    ------
    InputError
        Where an effect is not known or named twice.
    """
    chosen = default_effects(machine) if effects is None else dict.fromkeys(effects, True)
    if effects is not None and len(chosen) != len(effects):
        twice = next(name for name in effects if list(effects).count(name) > 1)
        raise InputError(f"effect {twice}: named twice (expected each effect once)")
    return Model(
        machine,
        tuple(new_term(name, effect_info(machine, 1, name).size, free=free) for name, free in chosen.items()),
    )


def _fixed(values: list[Any], kind: type[np.generic]) -> NDArray[Any]:
    """Return values as an array that several models can share."""
    array = np.array(values, dtype=kind)
    array.setflags(write=False)
    return array
