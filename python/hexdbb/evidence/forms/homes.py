"""Where an effect of the catalogue lives: the learned hypotheses whose functions contain its form.

An effect's signature is regressed on the signature of every learned hypothesis, the model's own values taken out of
both (what geometry imitates is no form); where that explains all of it, the
effect is a function of that hypothesis' variable at that place. So it is known, of any effect and with no table, which
functions are its form gone wrong (model discrepancy; Kennedy and O'Hagan 2001), which learned hypotheses are the same
cause in other words, and how large the effect's push is in mm.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import DEFAULT, Criteria
from hexdbb.evidence.linear.readings import Linear
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.learned import ALL, Learned
from hexdbb.learned.places import EACH, members

Floats = NDArray[np.float64]

MOST_COLUMNS = 24
"""Splines of a discrepancy, at most, where the effect lives in such: a finer function would be another cause. A
function of time may be finer: a room's heating swings within minutes, and a drift with it is a drift."""


AT_ONCE = 32
"""Hypotheses from which what geometry imitates is taken together: one product of some hundred columns takes half the
time of many of ten, and its copies fill no more than a core's cache."""


ROUNDING = 1e-12
"""Part of a function's square below which what geometry does not imitate is rounding: thousands of sums' worth."""


@dataclass(frozen=True)
class Home:
    """A hypothesis that contains a signature, how much of it, and the RMS of the push (mm) per signature's unit.

    `is_of_forms` marks hypotheses that only describe how a form is wrong; they never take an effect's place.
    """

    hypothesis: Learned
    explained: float
    rms_mm: float
    is_of_forms: bool = False


class Homes:
    """Homes of signatures.

    Parameters
    ----------
    linear : Linear
    thinned : Thinned
    hypotheses : sequence of Learned
        All that are learned.
    criteria : Criteria
    of_forms : sequence of Learned
        Others, in which effects' forms may be wrong and nothing more.
    """

    def __init__(
        self,
        linear: Linear,
        thinned: Thinned,
        hypotheses: Sequence[Learned],
        criteria: Criteria = DEFAULT,
        of_forms: Sequence[Learned] = (),
    ) -> None:
        self.criteria = criteria
        self.rows = thinned.rows
        thin = thinned.linear(linear)
        values, vectors = np.linalg.eigh(thin.own.T @ thin.own)
        # Values that the readings do not see within their priors cannot imitate anything.
        seen = values * len(linear.residual) > len(self.rows)
        self._absorbed = thin.own @ (vectors[:, seen] / np.sqrt(values[seen]))
        self._spaces, kept_tables = [], []
        every = [*hypotheses, *of_forms]
        for first in range(0, len(every), AT_ONCE):
            spaces = [thinned.signature(each) for each in every[first : first + AT_ONCE]]
            ends = np.cumsum([space.table.shape[1] for space in spaces])
            tables = np.hstack([space.table for space in spaces]).astype(np.float64)
            imitated = np.split(self._absorbed.T @ tables, ends[:-1], axis=1)
            for space, table, own in zip(spaces, np.split(tables, ends[:-1], axis=1), imitated, strict=True):
                square = table.T @ table
                values, vectors = np.linalg.eigh(square - own.T @ own)
                kept = values > max(1e-9 * values[-1], ROUNDING * float(np.trace(square)))
                if kept.any():  # else the model's own values imitate it whole: it contains nothing
                    self._spaces.append((space, vectors[:, kept] / np.sqrt(values[kept])))
                    kept_tables.append(space.table)
        self._tables = np.hstack(kept_tables) if kept_tables else np.empty((len(self.rows), 0), np.float32)
        """Functions of all hypotheses side by side; shares of a signature are compared to a thousandth."""
        self._first = np.cumsum([0, *(len(half) for _, half in self._spaces)])[:-1]
        """First of each hypothesis' functions among those of all."""
        self._words = sum(space.hypothesis not in of_forms for space, _ in self._spaces)
        """How many are words for an effect: they stand before those of forms alone."""

    def of(self, signature: Floats) -> list[Home]:
        """Return the hypotheses that contain a signature, shape (n,), the simplest first."""
        return self.of_each(signature[:, None])[0]

    def of_each(self, signatures: Floats) -> list[list[Home]]:
        """Return the hypotheses that contain each of some signatures, shape (n, m)."""
        return self._near(signatures, self.criteria.same_form, self._words)

    def around_each(self, signatures: Floats) -> list[list[Home]]:
        """Return the hypotheses in whose functions effects' forms may be wrong: those that nearly contain them."""
        return self._near(signatures, self.criteria.form_home, len(self._spaces))

    def shared_by(self, signature: Floats, ports: Collection[str]) -> Learned | None:
        """Return the function at some ports that six elements share and that says a signature best, shape (n,).

        Whatever of it geometry imitates: of legs that grow alike nothing else is left. None where none says it.
        """
        whole = signature[self.rows]
        missed: dict[Learned, float] = {}
        for (space, _), first in zip(self._spaces, self._first, strict=True):
            hypothesis = space.hypothesis
            if is_shared(hypothesis) and hypothesis.port in ports and hypothesis.variable.columns > 1:
                table = self._tables[:, first : first + space.table.shape[1]].astype(np.float64)
                law, *_ = np.linalg.lstsq(table, whole, rcond=None)
                missed[hypothesis] = float(np.sum((whole - table @ law) ** 2))
        best = min(missed, key=lambda each: missed[each], default=None)
        most = (1.0 - self.criteria.form_own) * float(whole @ whole)
        return best if best is not None and missed[best] <= most else None

    def _near(self, signatures: Floats, least: float, count: int) -> list[list[Home]]:
        """Return the nearest of the first so many hypotheses."""
        explained, along = self._explained(signatures)
        return [
            self._nearest(shares[:count], [each[:, place] for each in along], least)
            for place, shares in enumerate(explained.T)
        ]

    def _explained(self, signatures: Floats) -> tuple[Floats, list[Floats]]:
        """Return how much of each signature every hypothesis contains, (hypotheses, m), and its part along its axes."""
        if not self._spaces:
            return np.zeros((0, signatures.shape[1])), []
        whole = signatures[self.rows]
        own = self._visible(whole)
        total = np.sum(own**2, axis=0)
        shown = total > 1e-9 * np.sum(whole**2, axis=0)
        # W'(I - A A')s is what a space and a signature have in common beside what geometry imitates of either.
        unit = np.sqrt(np.where(total > 0.0, total, 1.0))
        cross = (self._tables.T @ (own / unit).astype(np.float32)).astype(np.float64) * unit
        parts = np.split(cross, self._first[1:])
        along = [half.T @ part for (_, half), part in zip(self._spaces, parts, strict=True)]
        squares = np.array([np.sum(each**2, axis=0) for each in along])
        return np.divide(squares, total, out=np.zeros_like(squares), where=shown), along

    def _visible(self, signature: Floats) -> Floats:
        left: Floats = signature - self._absorbed @ (self._absorbed.T @ signature)
        return left

    def _nearest(self, explained: Floats, along: Sequence[Floats], same: float) -> list[Home]:
        best = float(explained[: self._words].max(initial=0.0))
        least = max(min(same, best - (1.0 - same)), self.criteria.near_form)
        there = np.flatnonzero(explained >= least).tolist()
        near = [self._home(place, float(explained[place]), along[place]) for place in there]
        # What is constant is a function of time too, and its form does not go wrong in time.
        constant = {each.hypothesis.place for each in near if each.hypothesis.variable.is_constant}
        near = [each for each in near if not (each.hypothesis.is_of_time and each.hypothesis.place in constant)]
        return sorted(near, key=lambda each: (each.hypothesis.variable.columns, -each.explained))

    def _home(self, place: int, explained: float, along: Floats) -> Home:
        space, half = self._spaces[place]
        return Home(space.hypothesis, explained, space.rms_mm(half @ along), place >= self._words)


def discrepancy(
    homes: Sequence[Home], criteria: Criteria = DEFAULT, *, is_set_up: bool = False
) -> list[tuple[Learned, ...]]:
    """Return the functions in which an effect's form may be wrong: of its own variables, and element by element.

    What changes sign with the direction of travel may be larger in one direction than in the other. What changes at
    ball or cup with time may seat itself after each fixing. What lags may do so by a series in the motion's
    derivatives.
    What belongs to the set-up, as a gauge that is read late, is one thing that the elements share, form and all.
    Functions of forms alone are shared too: legs that each follow the warmth in their own manner are like any screw
    that grows.

    Returns
    -------
    list of tuple of Learned
        One variable each, the nearest to the effect first.
    """
    ranked = [each.hypothesis for each in sorted(homes, key=lambda each: -each.explained)]
    there = {(each.place, each.element) for each in ranked[:1]}
    near = [each for each in ranked if each.variable.columns > 1 and (each.place, each.element) in there]
    # An effect as narrow as a dent lives in fine functions alone: the nearest of them then stands for its form.
    useful = [each for each in near if each.variable.columns <= MOST_COLUMNS or each.is_of_time] or near[:1]
    own = {each.hypothesis for each in homes if each.explained >= criteria.form_own and not each.is_of_forms}
    beside = (other for each in useful for other in each.of_its_form)
    every = dict.fromkeys((*useful, *beside))
    return [_by_element(each) if each in own and not is_set_up else (each,) for each in every]


def _by_element(each: Learned) -> tuple[Learned, ...]:
    return (each, *at_each(each)) if is_shared(each) else (each,)


def is_shared(function: Learned) -> bool:
    """Check for a function that six elements share, each of which may have one of its own."""
    return function.element == ALL and function.place in ("slider", "leg")


def at_each(function: Learned) -> list[Learned]:
    """Return a function at each of six elements."""
    return [replace(function, element=element) for element in members(EACH)]
