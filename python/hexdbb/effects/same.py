"""Users' effects that are the same: no reading could tell which of two is the cause."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb.effects.tabulate import UserEffectError
from hexdbb.effects.user import UserEffect
from hexdbb.samples import Samples

SAME = 1.0 - 1e-12
"""Squared correlation of two tables of pushes from which they differ by rounding alone."""
ROWS = 2000
"""Rows compared at most: two functions that agree there agree."""


def same_effects(effects: Sequence[UserEffect], samples: Samples) -> dict[str, UserEffectError]:
    """Return an error for every effect that pushes what an earlier one pushes, but for its unit; by name."""
    few = samples.part(np.arange(0, len(samples), max(1, len(samples) // ROWS)))
    found: dict[str, UserEffectError] = {}
    seen: list[tuple[UserEffect, NDArray[np.float64]]] = []
    for effect in effects:
        table = effect.tabulated(few)
        flat = table.per_unit.ravel()
        for other, earlier in seen:
            alike = (effect.port, effect.elements, effect.parameters) == (other.port, other.elements, other.parameters)
            same_shapes = [shape for _, shape in effect.declared_shapes] == [
                shape for _, shape in other.declared_shapes
            ]
            if alike and same_shapes and (flat @ earlier) ** 2 >= SAME * (flat @ flat) * (earlier @ earlier):
                found[effect.name] = UserEffectError(
                    f"{effect.where}: the same as effect {other.name} of line {other.line} (expected another push)"
                )
        seen.append((effect, flat))
    return found
