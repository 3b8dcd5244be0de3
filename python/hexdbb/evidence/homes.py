"""Where an effect of the catalogue lives: the learned hypotheses whose functions contain its form.

An effect's signature is regressed on the signature of every learned hypothesis, the model's own values taken out of
both (what geometry imitates is no form); where that explains all of it, the
effect is a function of that hypothesis' variable at that place. So it is known, of any effect and with no table, which
functions are its form gone wrong (model discrepancy; Kennedy and O'Hagan 2001), which learned hypotheses are the same
cause in other words, and how large the effect's push is in mm.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.families import ALL, Learned, Space
from hexdbb.evidence.readings import Linear

Floats = NDArray[np.float64]

THINNED_ROWS = 1200
"""Rows of the regression: a signature has some tens of degrees of freedom."""
SAME_FORM = 0.97
"""Explained part of a signature from which a hypothesis is said to contain it."""
NEAR_FORM = 0.8
"""Where none contains it, the hypotheses nearest to it from this part on stand for its discrepancy."""
MOST_HOMES = 3
"""Functions of so many variables stand for the discrepancy; more add columns and no freedom."""


@dataclass(frozen=True)
class Home:
    """A hypothesis that contains a signature, how much of it, and the RMS of the push (mm) per signature's unit."""

    hypothesis: Learned
    explained: float
    rms_mm: float


class Homes:
    """Homes of signatures.

    Parameters
    ----------
    linear : Linear
    spaces : sequence of Space
        Of all learned hypotheses, in this linearisation.
    """

    def __init__(self, linear: Linear, spaces: Sequence[Space]) -> None:
        rows = len(linear.residual)
        self.rows = np.unique(np.linspace(0, rows - 1, min(rows, THINNED_ROWS)).astype(np.intp))
        own = linear.own[self.rows] * np.sqrt(rows / len(self.rows))
        values, vectors = np.linalg.eigh(own.T @ own)
        # Values that the readings do not see within their priors cannot imitate anything.
        seen = values > 1.0
        self._absorbed = own @ (vectors[:, seen] / np.sqrt(values[seen]))
        self._spaces = []
        for space in spaces:
            thin = self._visible(space.signature[self.rows])
            values, vectors = np.linalg.eigh(thin.T @ thin)
            kept = values > 1e-9 * values[-1]
            half = vectors[:, kept] / np.sqrt(values[kept])
            self._spaces.append((space, thin @ half, half))

    def of(self, signature: Floats) -> list[Home]:
        """Return the hypotheses that contain a signature, shape (n,), the simplest first."""
        own = self._visible(signature[self.rows])
        total = float(own @ own)
        if total <= 1e-9 * float(signature[self.rows] @ signature[self.rows]):
            return []
        found = []
        for space, basis, half in self._spaces:
            along = own @ basis
            explained = float(along @ along) / total
            if explained >= NEAR_FORM:
                found.append(Home(space.hypothesis, explained, space.rms_mm(half @ along)))
        best = max((each.explained for each in found), default=0.0)
        near = [each for each in found if each.explained >= min(SAME_FORM, best - (1.0 - SAME_FORM))]
        return sorted(near, key=lambda each: (each.hypothesis.variable.columns, -each.explained))

    def _visible(self, signature: Floats) -> Floats:
        left: Floats = signature - self._absorbed @ (self._absorbed.T @ signature)
        return left


def discrepancy(homes: Sequence[Home]) -> list[Learned]:
    """Return the functions in which an effect's form may be wrong: of its own variables, and element by element."""
    chosen: list[Learned] = []
    ranked = sorted(homes, key=lambda each: -each.explained)
    useful = [each.hypothesis for each in ranked if 1 < each.hypothesis.variable.columns <= 24][:MOST_HOMES]
    for each in useful:
        chosen.append(each)
        if each.element == ALL and each.place in ("slider", "leg"):
            chosen += [replace(each, element=element) for element in range(1, 7)]
    return chosen
