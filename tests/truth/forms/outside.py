"""Faults outside the catalogue: what a machine has that no effect describes, with its true place and variable.

A second file of the same kind may stand beside this one and join its table to `OUTSIDE`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from tests.truth.forms.family import Draw, slider
from tests.truth.forms.labels import Equivalent
from tests.truth.forms.ports import Action, Scene

from hexdbb.rig.geometry import Array


@dataclass(frozen=True, eq=False)
class Fault:
    """A fault as drawn."""

    action: Action
    equivalents: tuple[Equivalent, ...] = ()


@dataclass(frozen=True, eq=False)
class Outside:
    """A kind of fault.

    Attributes
    ----------
    unit : str
        Of size.
    start, limit : float
        Where the search for a size begins; largest size of a machine in use.
    variables : tuple of str
        What it depends on; see `labels`.
    drawn : callable
        Draws it.
    plan : str
        The plan that can see it.
    """

    unit: str
    start: float
    limit: float
    variables: tuple[str, ...]
    drawn: Callable[[Draw], Fault]
    plan: str = "standard"


def _dent(draw: Draw) -> Fault:
    """A guideway has a dip at one place."""
    k, place, width = slider(draw), float(draw.uniform(-0.6, 0.6)), float(draw.uniform(3.0, 15.0))
    guideway = k // 2

    def values(scene: Scene, size: float) -> Array:
        drive = scene.history.drive_mm[scene.history.samples, k]
        at_mm = 0.5 * (drive.max() + drive.min()) + 0.5 * place * (drive.max() - drive.min())
        both = np.zeros((len(scene.rows), 4))
        for j in range(2):
            off = (scene.drive_mm(2 * guideway + j) - at_mm) / width
            both[:, 2 * j + 1] = -1e-3 * size * np.exp(-0.5 * off**2)
        return both

    return Fault(Action("guideway", (guideway,), values))


OUTSIDE: dict[str, Outside] = {
    "dent": Outside("um", 20.0, 2000.0, ("position",), _dent),
}
"""Kinds by name."""
