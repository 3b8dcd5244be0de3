"""What stands in a model: effects with their values, the names of the values, the mounts whose cups are known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class MountKey:
    """One fixing of the cup: every record's mounts count as fixings of their own."""

    record_hash: str
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

    @property
    def label(self) -> str:
        """Name for people: effect, element, parameter."""
        return f"{self.effect}:{self.element} {self.name}"


@dataclass(frozen=True)
class Term:
    """One effect of a model with its values; `sigma` is nan where a value is not known on its own."""

    effect: str
    free: NDArray[np.bool_]
    """Which values a diagnosis may change."""
    values: Floats
    sigma: Floats
    identifiable: NDArray[np.bool_]


def new_term(effect: str, size: int, *, free: bool = True) -> Term:
    """Make a term with all values zero and nothing known of them."""
    return Term(effect, np.full(size, free), np.zeros(size), np.full(size, np.nan), np.zeros(size, bool))
