"""Effects that a model does not have: what they would do to the readings, to first order, and where they push."""

from __future__ import annotations

import weakref
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.model import Model, Term
from hexdbb.model.terms import started_term
from hexdbb.samples import effect_pushes

if TYPE_CHECKING:
    from hexdbb.evidence.linear.engine import Engine

Floats = NDArray[np.float64]
Signatures = tuple[Floats, list[tuple[str, str, str, float]]]
"""A column each, and whose it is: effect, element, parameter, prior standard deviation."""

FEW_ROWS = 100
"""Rows that tell where an effect pushes: several in every reversal and on every circle of a plan."""
KEPT = 4
"""Tables of signatures kept, some megabytes each: those about one model, at each start of a shape, are asked for where
effects are screened one by one and again in sets."""


class Absent:
    """Effects that an engine's models do not have.

    Parameters
    ----------
    engine : Engine
    """

    def __init__(self, engine: Engine) -> None:
        # Weakly, since the engine has this: a search's arrays, hundreds of megabytes, go as soon as nobody uses them.
        self._engine: Engine = weakref.proxy(engine)
        self._ports: dict[str, frozenset[str]] = {}
        self._signatures: OrderedDict[tuple[int, tuple[str, ...], float], tuple[Model, Signatures]] = OrderedDict()

    def has_shape(self, effect: str) -> bool:
        """Check whether an effect has a shape parameter of the engine's (a time constant)."""
        base = self._engine.base
        return base.own(effect) is None and any(each.is_shape for each in base.info(effect).parameters)

    def ports(self, effect: str) -> frozenset[str]:
        """Return the engine's ports at which an effect pushes; those of each effect are looked for once."""
        if effect not in self._ports:
            self._ports[effect] = self._found_ports(effect)
        return self._ports[effect]

    def _found_ports(self, effect: str) -> frozenset[str]:
        part, base = self._engine.part, self._engine.base
        few = part.part(np.unique(np.linspace(0, len(part) - 1, FEW_ROWS).astype(np.intp)))
        alone = replace(base, terms=(held(base, effect),))
        return frozenset(port for port, pushes in effect_pushes(few, alone).items() if np.any(pushes != 0.0))

    def signatures(self, model: Model, effects: Sequence[str], shape: float = 0.0) -> Signatures:
        """Return first-order signatures of absent effects, per prior standard deviation; the last few are kept.

        Parameters
        ----------
        model : Model
        effects : sequence of str
        shape : float
            Value of shape parameters, in prior standard deviations.

        Returns
        -------
        signatures : ndarray, shape (n, k)
        whose : list of (effect, element, parameter, prior standard deviation)
        """
        key = (id(model), tuple(effects), shape)
        if key not in self._signatures:
            # The model is kept with them: meanwhile no other has its identity.
            self._signatures[key] = model, self._made_signatures(model, effects, shape)
            if len(self._signatures) > KEPT:
                self._signatures.popitem(last=False)
        return self._signatures[key][1]

    def signatures_about_start(self, effect: str, shaped: Model) -> Signatures:
        """Return the signatures of an effect's absent elements about the start of fits, its shape as in another model.

        Learned functions have theirs there too. About a fit, geometry bent, what is left of an effect that geometry
        imitates nearly whole is nothing that they contain.
        """
        full = self._engine.start
        if effect not in {term.effect for term in full.terms}:
            full = replace(full, terms=(*full.terms, held(full, effect)))
        values = {
            (each.element, each.name): value
            for each, value in zip(shaped.parameters(), shaped.values, strict=True)
            if each.effect == effect and each.is_shape
        }
        asked = [(each.effect == effect, (each.element, each.name)) for each in full.parameters()]
        same = [values.get(key, old) if is_its else old for (is_its, key), old in zip(asked, full.values, strict=True)]
        return self._signatures_of(full.with_values(np.array(same)), (effect,))

    def _made_signatures(self, model: Model, effects: Sequence[str], shape: float) -> Signatures:
        present = {term.effect for term in model.terms}
        terms = [held(model, name) for name in effects if name not in present]
        full = replace(model, terms=(*model.terms, *terms))
        if shape:
            absent = np.array([each.is_shape and each.effect not in present for each in full.parameters()])
            full = full.with_values(np.where(absent, shape * full.prior_sigma, full.values))
        return self._signatures_of(full, effects)

    def _signatures_of(self, full: Model, effects: Sequence[str]) -> Signatures:
        """Return the signatures of effects that a model holds."""
        full = self._engine.without_learned(full)
        jacobian = _core.predict(*self._engine.plain(full), want_jacobian=True).jacobian
        wanted = [
            (index, each)
            for index, each in enumerate(full.parameters())
            if each.effect in effects and not full.free[index] and not each.is_shape
        ]
        columns = [index for index, _ in wanted]
        sigmas = np.array([each.prior_sigma for _, each in wanted])
        table: Floats = jacobian[:, columns] * sigmas / self._engine.row_noise_mm[:, None]
        return table, [(each.effect, each.element, each.name, each.prior_sigma) for _, each in wanted]


def held(model: Model, effect: str) -> Term:
    """Return a term of an effect that a model lacks, at its start, held."""
    info = model.info(effect)
    return replace(started_term(effect, model.own(effect), info), free=np.zeros(info.size, bool))
