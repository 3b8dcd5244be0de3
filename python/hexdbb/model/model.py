"""A model is a machine plus a list of effects.

The values of all effects stand one after another in one vector, effect by effect, element by element, in the engine's
units; a `Parameter` names each place of it. What is known of the values (uncertainty, whether they can be told at all)
stands beside.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.kinematics import engine_machine
from hexdbb.machine import MachineFile
from hexdbb.model.ledger import LedgerStep, State
from hexdbb.model.own import OwnEffect, OwnEffects, Tabulate
from hexdbb.model.terms import Floats, MountKey, Parameter, Term, new_term


@dataclass(frozen=True)
class Model:
    """A machine, its effects, the mounts whose cups it knows, and the ledger of steps."""

    machine: MachineFile
    terms: tuple[Term, ...]
    mounts: tuple[MountKey, ...] = ()
    ledger: tuple[LedgerStep, ...] = field(default=())
    path: Path | None = field(default=None, compare=False)
    """The file it was read from."""
    own_effects: OwnEffects = field(default_factory=dict, compare=False, repr=False)
    """Effects of the user's own that may stand in it, by name; the file does not keep what they do."""

    @property
    def name(self) -> str:
        """How errors name it: by its file, where it has one."""
        return "the model" if self.path is None else str(self.path)

    def info(self, effect: str) -> _core.EffectInfo:
        """Describe one effect as it stands in this model."""
        return effect_info(self.machine, max(len(self.mounts), 1), effect, self.own_effects)

    def parameters(self) -> list[Parameter]:
        """Name every value, in the order of `values`."""
        return [parameter for term in self.terms for parameter in _parameters(self.info(term.effect))]

    @property
    def state(self) -> State:
        """Effects and mounts as they stand, for the ledger to keep."""
        return State(self.terms, self.mounts)

    @property
    def values(self) -> Floats:
        """All values, engine units, shape (size,)."""
        return np.concatenate([np.zeros(0), *(term.values for term in self.terms)])

    @property
    def sigma(self) -> Floats:
        """Standard deviations of the values, engine units, nan where not known."""
        return np.concatenate([np.zeros(0), *(term.sigma for term in self.terms)])

    @property
    def free(self) -> NDArray[np.bool_]:
        """Which values a diagnosis may change."""
        return np.concatenate([np.zeros(0, bool), *(term.free for term in self.terms)])

    def with_free(self, free: NDArray[np.bool_]) -> Model:
        """Give the same model with another choice of free values, shape (size,)."""
        terms, at = [], 0
        for term in self.terms:
            terms.append(replace(term, free=free[at : at + len(term.values)]))
            at += len(term.values)
        return replace(self, terms=tuple(terms))

    def with_values(self, values: Floats, sigma: Floats, identifiable: NDArray[np.bool_]) -> Model:
        """Give the same model with other values."""
        terms, at = [], 0
        for term in self.terms:
            span = slice(at, at + len(term.values))
            terms.append(replace(term, values=values[span], sigma=sigma[span], identifiable=identifiable[span]))
            at = span.stop
        return replace(self, terms=tuple(terms))

    def with_mounts(self, keys: Sequence[MountKey]) -> Model:
        """Give the same model knowing these mounts too; their cups stand where planned until they are fitted."""
        new = [key for key in keys if key not in self.mounts]
        wider = replace(self, mounts=(*self.mounts, *new))
        return replace(wider, terms=tuple(_extended(term, wider.info(term.effect).size) for term in self.terms))

    def knowing_effects(self, effects: Iterable[OwnEffect]) -> Model:
        """Give the same model, in which effects of the user's own may stand too."""
        return replace(self, own_effects={**self.own_effects, **{each.name: each for each in effects}})

    def engine(self, samples: _core.Samples | Tabulate | None = None) -> _core.Model:
        """Give the engine's form of the model.

        Parameters
        ----------
        samples : Samples, optional
            What it is to predict; a model with an effect of the user's own predicts these and parts of them only.

        Raises
        ------
        InputError
            An effect of the user's own without samples, or one that fails, with its file and line.
        """
        engine = _core.Model(engine_machine(self.machine))
        for term in self.terms:
            own = self.own_effects.get(term.effect)
            if own is None:
                engine.add(term.effect, max(len(self.mounts), 1))
            elif samples is None:
                raise InputError(f"{term.effect}: an effect of your own is known in measured samples only, not here")
            elif isinstance(samples, _core.Samples):
                own.add_to(engine, samples, self.machine)
            else:
                samples(own).add_to(engine)
        engine.values = self.values
        return engine


def effect_info(machine: MachineFile, mounts: int, effect: str, own: OwnEffects | None = None) -> _core.EffectInfo:
    """Describe an effect; `own` are the user's.

    Raises
    ------
    InputError
        Where no effect has that name, with the names there are.
    """
    if own and effect in own:
        return own[effect].info()
    try:
        return _core.effect_info(engine_machine(machine), mounts, effect)
    except ValueError as error:
        raise InputError(str(error)) from None


def default_effects(machine: MachineFile) -> dict[str, bool]:
    """Give the effects of a new model and whether each is free.

    The thesis' 33 geometric errors, cup position and ball offset are free: nobody knows where the cup and the ball sit
    to a micrometre. The bar's length is calibrated and fixed. Effects of the catalogue are added when something asks
    for them.
    """
    names = [*_core.effect_names("geometry"), *_core.effect_names("set-up")]
    return {name: name != "bar_length" for name in names}


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
    terms = []
    for name, free in chosen.items():
        size = effect_info(machine, 1, name).size
        terms.append(new_term(name, size, free=free))
    return Model(machine, tuple(terms))


def _parameters(info: _core.EffectInfo) -> list[Parameter]:
    return [
        Parameter(info.name, element, each.name, each.unit, each.prior_sigma, each.limit, info.is_set_up, each.is_shape)
        for element in info.elements
        for each in info.parameters
    ]


def _extended(term: Term, size: int) -> Term:
    more = size - len(term.values)
    if more <= 0:
        return term
    return replace(
        term,
        free=np.append(term.free, np.full(more, bool(term.free.any()) or not len(term.free))),
        values=np.append(term.values, np.zeros(more)),
        sigma=np.append(term.sigma, np.full(more, np.nan)),
        identifiable=np.append(term.identifiable, np.zeros(more, bool)),
    )
