"""A trial: a set of hypotheses as the engine has fitted it, and what is told of the fit (`trials.py` makes them)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.linear.screen import Known
from hexdbb.learned import Learned
from hexdbb.model import Model

Floats = NDArray[np.float64]
NOTHING_LEFT = 0.03
"""Mean square beyond the noise, in noise variances, that is none: a standard deviation of the mean square of 2,000
independent readings, of 10,000 where noise lasts for five."""


@dataclass(frozen=True)
class Member:
    """A hypothesis of a trial; a learned one with its prior's factor and size."""

    hypothesis: Known | Learned
    factor: Floats | None = None
    size_mm: float = 0.0

    @property
    def axes(self) -> int:
        """Number of values that a learned function has in a fit."""
        return 0 if self.factor is None else self.factor.shape[1]


@dataclass(frozen=True)
class Trial:
    """Hypotheses fitted.

    Attributes
    ----------
    members : tuple of Member
    model : Model
        Fitted.
    log_evidence : float
    forms : tuple of Form or None
        One a member.
    refused : tuple of str
        Why a member is not admissible, one sentence each.
    left : float
        Mean square of the residual in noise variances, discrepancies explained.
    """

    members: tuple[Member, ...]
    model: Model
    log_evidence: float
    forms: tuple[Form | None, ...]
    refused: tuple[str, ...]
    left: float
    present: tuple[tuple[str, Form], ...] = ()
    """Effects that the model had before, each with its form."""

    @property
    def is_free_in_time(self) -> bool:
        """Whether a free function of time is among the members."""
        return any(isinstance(each.hypothesis, Learned) and each.hypothesis.is_of_time for each in self.members)

    @property
    def is_of_time(self) -> bool:
        """Whether all members are free functions of time: they claim nothing but what lies between."""
        return all(isinstance(each.hypothesis, Learned) and each.hypothesis.is_of_time for each in self.members)

    def columns_of_forms(self) -> Iterator[tuple[Form, slice]]:
        """Yield the forms that have functions beside them, with their columns of the linearisation."""
        for form in (*(form for _, form in self.present), *self.forms):
            if form is not None and form.columns:
                yield form, slice(form.first, form.first + form.columns)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the members."""
        return tuple(each.hypothesis.name for each in self.members)
