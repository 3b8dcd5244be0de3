"""How large an effect may be: a normal prior near what is expected, with tails for faults that are far larger."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Set as AbstractSet

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.model import Model

Floats = NDArray[np.float64]

LEAST_SCALE = 1.5
"""Factor on a prior standard deviation from which it counts: an effect of one value has it at 2.7 standard deviations,
below which a normal prior costs it less than four nats."""


def prior_scale(
    model: Model, effects: AbstractSet[str], there: AbstractSet[tuple[str, str]], criteria: Criteria
) -> Floats:
    """Return factors on the prior standard deviations of a model's values, shape (size,).

    The prior of what an effect's element pushes is Student's t: near zero the normal one of its description, far from
    it with tails in which a large fault costs its logarithm, not its square. About a value it is the normal prior of a
    standard deviation that follows the value (West 1987, On scale mixtures of normal distributions). Several effects
    keep their normal priors: two that are both far too large mostly undo each other.

    Parameters
    ----------
    model : Model
    effects : set of str
        That could be missing: geometry keeps its priors.
    there : set of (effect, element)
        That the model had before.
    criteria : Criteria
    """
    tail = criteria.prior_tail
    moved = (model.values - model.start) / model.prior_sigma
    places: dict[tuple[str, str], list[int]] = defaultdict(list)
    for place, (each, is_free) in enumerate(zip(model.parameters(), model.free, strict=True)):
        of = (each.effect, each.element)
        if is_free and each.effect in effects and of not in there and not (each.is_shape or each.shape):
            places[of].append(place)
    found = np.ones(len(moved))
    for at in places.values() if len(places) == 1 else ():
        scale = np.sqrt((tail + np.sum(moved[at] ** 2)) / (tail + len(at)))
        found[at] = scale if scale > LEAST_SCALE else 1.0
    return found
