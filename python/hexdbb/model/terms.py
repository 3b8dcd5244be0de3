"""What stands in a model: effects with their values, the names of the values, the mounts whose cups are known."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.model.learned import LearnedEffect
from hexdbb.model.own import OwnEffect, Shape, shapes_of

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class MountKey:
    """One fixing of the cup: a record's mounts count as fixings of its own, unless they have the name of one."""

    record_hash: str
    """Content hash of the record, or ``fixing NAME`` where several records share the fixing."""
    mount_id: int


@dataclass(frozen=True)
class Parameter:
    """Name and nature of one value of a model."""

    effect: str
    element: str
    name: str
    unit: str
    """Engine unit."""
    prior_sigma: float
    limit: float
    is_set_up: bool
    is_shape: bool = False
    """Pushes nothing by itself: it shapes what the effect's other values push."""
    is_coefficient: bool = False
    """A coefficient of a learned function: the function is judged, not its coefficients one by one."""
    shape: Shape | None = None
    """Start and domain of a shape parameter of the user's; its value is what it is, not a difference from the start."""

    @property
    def label(self) -> str:
        """Name for people: effect, element, parameter."""
        return f"{self.effect}:{self.element} {self.name}"

    @property
    def start(self) -> float:
        """Value before any fit, and mean of the prior."""
        return 0.0 if self.shape is None else self.shape.start


@dataclass(frozen=True)
class Term:
    """One effect of a model with its values; `sigma` is nan where a value is not known on its own."""

    effect: str
    free: Bools
    """Which values a diagnosis may change."""
    values: Floats
    sigma: Floats
    identifiable: Bools
    learned: LearnedEffect | None = None
    """What a learned effect is; None for effects of the engine and of the user's own."""


def new_term(effect: str, size: int, *, free: bool = True) -> Term:
    """Make a term with all values zero and nothing known of them."""
    return Term(effect, np.full(size, free), np.zeros(size), np.full(size, np.nan), np.zeros(size, bool))


def extended(term: Term, size: int) -> Term:
    """Return the term with further elements, values zero, so that it has `size` values; free where the others are."""
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


def started_term(effect: str, own: OwnEffect | None, info: _core.EffectInfo) -> Term:
    """Make the term of an effect that joins a model, values at their start."""
    learned = own if isinstance(own, LearnedEffect) else None
    starts = np.array([each.start for each in parameters_of(info, own)])
    return replace(new_term(effect, info.size), values=starts, learned=learned)


def parameters_of(info: _core.EffectInfo, own: OwnEffect | None = None) -> list[Parameter]:
    """Return name and nature of every value of an effect, element by element; `own` where it is not the engine's."""
    shapes = shapes_of(own)
    is_coefficient = isinstance(own, LearnedEffect)
    found = _described(info)
    if not shapes and not is_coefficient:
        return list(found)
    return [
        replace(
            each,
            is_shape=each.is_shape or each.name in shapes,
            is_coefficient=is_coefficient,
            shape=shapes.get(each.name),
        )
        for each in found
    ]


@lru_cache(maxsize=256)
def _described(info: _core.EffectInfo) -> tuple[Parameter, ...]:
    """Return the values that a description names; every model of a machine asks for those of the same descriptions."""
    return tuple(
        Parameter(info.name, element, each.name, each.unit, each.prior_sigma, each.limit, info.is_set_up, each.is_shape)
        for element in info.elements
        for each in info.parameters
    )
