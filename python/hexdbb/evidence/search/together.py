"""Sets of known effects, screened together: what each explains alone does not tell what they explain side by side.

A known effect has few values, so that the evidence of thousands of sets costs small matrices only, all cut from one
table of sums: every pair is scored, and the best sets of each size are widened by every effect in turn. To first order
and with the tempered noise of `screen.py`, as for single hypotheses; the search then fits the best sets in full.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.linear.screen import Known, Screen

Floats = NDArray[np.float64]
Whose = Sequence[tuple[str, str, str, float]]

OF_ONE_SIGN = 3
"""Elements of one effect of one sign in a set of three and more: at four and more it is one cause at all of them."""


@dataclass(frozen=True)
class Signed:
    """A known effect's element with the columns of its signature; one of several shapes is a `Signed` of its own."""

    known: Known
    columns: tuple[int, ...]


@dataclass(frozen=True)
class Together:
    """A set of known effects: log evidence over the base (tempered, without the prior of the choice)."""

    members: tuple[Signed, ...]
    log_evidence: float

    @property
    def effects(self) -> frozenset[Known]:
        """The effects, in no order, whatever their shapes."""
        return frozenset(each.known for each in self.members)


class KnownSets:
    """Scores sets of known effects on one linearisation.

    Parameters
    ----------
    screen : Screen
        Of the linearisation.
    signatures : sequence of ndarray, shape (n, k)
        Of all known effects; one table for each start of their shapes.
    whose : sequence of sequences of (effect, element, parameter, prior standard deviation)
        Of the columns of each.
    kinds : set of str
        Effects that have one element only.
    criteria : Criteria
    one_sided : set of (effect, parameter)
        Values of one sign by their nature.
    """

    def __init__(
        self,
        screen: Screen,
        signatures: Sequence[Floats],
        whose: Sequence[Whose],
        kinds: set[str],
        criteria: Criteria,
        one_sided: Collection[tuple[str, str]] = (),
    ) -> None:
        self.criteria, self._one_sided = criteria, {effect for effect, _ in one_sided}
        projected = screen.whole.project(screen.sums.joined(list(signatures)))
        self._information, self._gradient = projected.information / screen.temper, projected.gradient / screen.temper
        self._is_signed = np.array([(effect, name) in one_sided for names in whose for effect, _, name, _ in names])
        columns: dict[tuple[int, str, str], list[int]] = defaultdict(list)
        for place, (table, (effect, element, _, _)) in enumerate(
            (table, each) for table, names in enumerate(whose) for each in names
        ):
            columns[table, effect, element].append(place)
        self.every = [
            Signed(Known(effect, (element,), effect in kinds), tuple(places))
            for (_, effect, element), places in columns.items()
        ]

    def best(self, most: int, per_effects: int) -> list[Together]:
        """Return the best sets of two to `most` effects that explain more than any with fewer.

        Parameters
        ----------
        most : int
            Effects in a set.
        per_effects : int
            Elements of one effect in a pair, and sets of the same effects at different elements. Larger sets have one
            element of each effect: screws that warm, each in its own way, imitate whatever changes with time. Those of
            one sign cannot, and stand at up to `OF_ONE_SIGN` elements: play of three drives beside legs that sag.
        """
        chosen: list[Together] = []
        sets = self._scored([(each,) for each in self.every])
        choice = self.criteria.detect_nats + float(np.log(max(len(self.every), 1)))
        best = max((each.log_evidence for each in sets), default=0.0)
        for size in range(2, most + 1):
            followed = sets if size == 2 else sets[: self.criteria.known_sets_followed]
            most_of = {each: OF_ONE_SIGN for each in self._one_sided if size > 2}
            of_others = per_effects if size == 2 else 1
            sets = self._scored(_widened((each.members for each in followed), self.every, most_of, of_others))
            worth = (each for each in sets if each.log_evidence > best + choice)
            found = _of_different_effects(filter(self._is_physical, worth), self.criteria.known_sets, per_effects)
            chosen += found
            best = max([best, *(each.log_evidence for each in found)])
        return chosen

    def _is_physical(self, together: Together) -> bool:
        """Check that values of one sign have it: a drive that leads imitates much."""
        columns = [place for each in together.members for place in each.columns]
        precision = np.eye(len(columns)) + self._information[np.ix_(columns, columns)]
        values = np.linalg.solve(precision, self._gradient[columns])
        return bool(np.all(values[self._is_signed[columns]] > 0.0))

    def _scored(self, sets: Sequence[tuple[Signed, ...]]) -> list[Together]:
        """Score sets, the largest evidence first, each with the best of its members' shapes."""
        by_size: dict[int, list[tuple[Signed, ...]]] = defaultdict(list)
        for each in sets:
            by_size[sum(len(one.columns) for one in each)].append(each)
        best: dict[frozenset[Known], Together] = {}
        for group in by_size.values():
            columns = np.array([[c for one in each for c in one.columns] for each in group])
            for members, evidence in zip(group, self._evidence(columns), strict=True):
                scored = Together(members, float(evidence))
                if scored.effects not in best or best[scored.effects].log_evidence < evidence:
                    best[scored.effects] = scored
        return sorted(best.values(), key=lambda each: -each.log_evidence)

    def _evidence(self, columns: NDArray[np.intp]) -> Floats:
        """Return the log evidence of sets of as many columns, averaged over scales of their priors: shape (sets,)."""
        information = self._information[columns[:, :, None], columns[:, None, :]]
        gradient = self._gradient[columns]
        found = []
        for scale in self.criteria.catalogue_scale:
            inner = np.eye(columns.shape[1]) + scale**2 * information
            explained = np.linalg.solve(inner, gradient[:, :, None])[:, :, 0]
            found.append(
                0.5 * scale**2 * np.sum(gradient * explained, axis=1) - 0.5 * np.linalg.slogdet(inner).logabsdet
            )
        averaged: Floats = np.logaddexp.reduce(found, axis=0) - np.log(len(found))
        return averaged


def _widened(
    sets: Iterable[tuple[Signed, ...]], every: Sequence[Signed], most_of: Mapping[str, int], of_others: int
) -> list[tuple[Signed, ...]]:
    """Return every set with every effect beside it, each combination once, with so many elements of each effect."""
    found: dict[frozenset[Signed], tuple[Signed, ...]] = {}
    for each in sets:
        there = {one.known for one in each}
        for other in every:
            wider = [one.effect for one in (*there, other.known)]
            if other.known not in there and all(wider.count(e) <= most_of.get(e, of_others) for e in {*wider}):
                found.setdefault(frozenset((*each, other)), (*each, other))
    return list(found.values())


def _of_different_effects(sets: Iterable[Together], count: int, of_the_same: int) -> list[Together]:
    """Return the first sets, few of them the same effects at other elements."""
    found: list[Together] = []
    same: dict[tuple[str, ...], int] = defaultdict(int)
    for each in sets:
        effects = tuple(sorted(one.effect for one in each.effects))
        if same[effects] < of_the_same:
            same[effects] += 1
            found.append(each)
        if len(found) == count:
            break
    return found
