"""A predictor of a residual: a variable, the share it explains, and where, how often and how strongly it acts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hexdbb.predictors.places import Place
from hexdbb.predictors.variable import FloatArray

LEAST_SHARE = 0.02
"""Explained share below which a variable is not called a predictor: what explains less is of no consequence.
White noise stays far below (0 in each of eight draws of 7000 readings)."""
COST = 0.015
"""Share that each doubling of the number of values must add: 252 values (angle on each of seven circles) must explain
4 % more than 36 (angle), or the coarser description is preferred."""


@dataclass(frozen=True)
class Profile:
    """Means over the bins of a variable, for drawing: one line for each number of `Variable.apart`.

    Attributes
    ----------
    name : str
    centre : (m,) array
        In the variable's unit.
    mean_um : (m,) array
        Mean residual; where the cause acts elsewhere, root mean square of the push's response in the reading, with the
        push's sign.
    """

    name: str
    centre: FloatArray
    mean_um: FloatArray


@dataclass(frozen=True)
class Predictor:
    """A variable and what it explains of a residual.

    Attributes
    ----------
    subject, variable, unit, pushes, classes
        As `subject`, `name`, `unit`, `pushes` and `classes` of `Variable`.
    share : float
        Explained share of the mean square residual, cross-validated, 0 to 1.
    values : int
        Number of values that the description needs.
    period : float or None
        In `unit`, where it repeats.
    place : Place or None
        Where it is confined to one place.
    size_um : float or None
        Amplitude of the sine, or the largest push at the place.
    sampled_hz : float or None
        Samples a second, for a period in time: faster ones alias.
    profiles : tuple of Profile
    is_bystander : bool
        Whether it only goes with the likely cause of the residual, at another element.
    """

    subject: str
    variable: str
    unit: str
    pushes: str
    share: float
    values: int
    period: float | None = None
    place: Place | None = None
    size_um: float | None = None
    sampled_hz: float | None = None
    profiles: tuple[Profile, ...] = ()
    classes: tuple[tuple[float, str], ...] = ()
    is_bystander: bool = False

    @property
    def worth(self) -> float:
        """Share less the cost of the number of values."""
        return self.share - COST * float(np.log2(max(self.values, 1)))
