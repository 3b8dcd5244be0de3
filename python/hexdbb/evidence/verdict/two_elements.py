"""Two elements that depend on one state, each in its own way: two screws that whip, two scales with a bad joint.

Of such a pair either alone explains half, and some function of another state may explain more: the pair is then never
looked at. Here all pairs of elements are compared at once, to first order, for every state that elements of one place
have each for themselves; the best few are fitted in full. The bar's two balls are such a pair: by the direction of the
bar each goes round, in the base the one and in the platform the other.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.marginal import log_evidences
from hexdbb.evidence.linear.screen import may_be_finer_at_once
from hexdbb.evidence.linear.signatures import varying
from hexdbb.evidence.search.last_resort import as_much_as, axes_along, needs_no_other
from hexdbb.evidence.search.needed import needs_all
from hexdbb.evidence.search.refine import finely_tuned
from hexdbb.evidence.search.settling import predicts
from hexdbb.evidence.search.several import is_of_several
from hexdbb.evidence.search.tuned import axes_of
from hexdbb.learned import ALL, Learned, Variable
from hexdbb.learned.places import KINDS, PAIRS

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

Floats = NDArray[np.float64]

FITTED = 3
"""Pairs that are fitted in full: the other leg of a pair, or a guideway's other axis, may rank before the true one."""
NEAR = 0.97
"""Part of the best pair's evidence to first order that another must have: of four true pairs each was the best, and
what imitates them at another place had 0.99 of its evidence, or 0.94 and less."""
FINER = 6
"""Pairs that are compared with finer functions besides, each of another state: of four true pairs each state was among
the first three with the splines that it has at first."""


class Pair(NamedTuple):
    """Functions of two elements, and their log evidence together over the model without them."""

    log_evidence: float
    functions: tuple[Learned, Learned]


def or_at_two_elements(search: Search, node: Node) -> Node:
    """Return two elements with functions of one state, where they have more evidence than a set and leave far less.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged where it explains and predicts all but the noise, or nothing is learned; unless it is one
        effect at all elements, which two of them may imitate: what drives have in common, geometry and delay nearly do.
        Or a free function of time along several axes: it also describes two couplings that slip, each at its own time.
    """
    if not search.learns or (needs_no_other(search, node) and not (_is_at_more_elements(node) or _is_any_drift(node))):
        return node
    pairs = best_pairs(search)
    least = max(NEAR * pairs[0].log_evidence, as_much_as(search, node, len(search.thinned.rows)))
    worth = [each for each in pairs[:FITTED] if each.log_evidence >= least]
    found = (_fitted(search, each) for each in worth)
    better = [each for each in found if each is not None and _stands_before(search, each, node)]
    search.nodes += better
    return max(better, key=lambda each: each.score, default=node)


def _stands_before(search: Search, pair: Node, node: Node) -> bool:
    """Check that a pair predicts, needs both, has more evidence, and leaves less; far less along more axes."""
    if pair.score - node.score <= search.criteria.margin_nats:
        return False
    replaced = max(len(node.members), axes_along(node))
    is_as_free = axes_of(pair) <= axes_of(node) or len(pair.members) <= replaced
    if pair.trial.is_free_in_time and not (node.trial.is_free_in_time and is_as_free):
        return False  # two functions of time, with more values than the one that they replace, describe whatever drifts
    is_freer = len(node.members) < len(pair.members) and axes_along(node) < axes_along(pair)
    least = search.criteria.far_better if is_freer else 1.0
    is_less = _is_at_more_elements(node) or pair.trial.left - 1.0 < least * (node.trial.left - 1.0)
    return is_less and predicts(search, pair) and needs_all(search, pair)


def _is_at_more_elements(node: Node) -> bool:
    """Check for one known effect at all elements, which are more than two."""
    return len(node.members) == 1 and is_of_several(node.hypotheses[0])


def _is_any_drift(node: Node) -> bool:
    """Check for one free function of time along several axes."""
    return len(node.members) == 1 and node.trial.is_free_in_time and axes_along(node) > 1


def _fitted(search: Search, pair: Pair) -> Node | None:
    """Return a pair fitted in full and tuned, the second function beside the first."""
    node = search.root
    for each in pair.functions:
        tried = search.tried(node, [search.screen(node).scored(each)])
        if not tried:
            return None
        node = tried[0]
    return finely_tuned(search, node)


def best_pairs(search: Search) -> list[Pair]:
    """Return the best pair of elements of every state, by evidence to first order on few rows, the best first.

    Parameters
    ----------
    search : Search
        Beside nothing: whatever it has found.
    """
    pairs = _Pairs(search)
    coarse = sorted((pairs.best_of(each) for each in _families(search)), key=lambda each: -each.log_evidence)
    readings, times = search.engine.readings, search.criteria.finer_at_once
    found = list(coarse)
    for each in coarse[:FINER]:
        for finer in times if all(map(may_be_finer_at_once, each.functions)) else ():
            both = list(varying([one.finer(finer) for one in each.functions], readings))
            if len(both) == len(each.functions) and sum(one.size for one in both) <= search.criteria.most_tuned:
                found.append(pairs.best_of(both))
    best: dict[tuple[str, ...], Pair] = {}
    for each in sorted(found, key=lambda each: -each.log_evidence):
        best.setdefault(tuple(one.name for one in each.functions), each)
    return [*best.values()]


def _families(search: Search) -> Iterable[list[Learned]]:
    """Return the functions of one state, each of another element of places alike, that push along one axis.

    A guideway that is bent has it in either direction. A variable that was tuned has splines of its own number.
    """
    found: dict[tuple[str, Variable], list[Learned]] = defaultdict(list)
    balls: dict[int, list[Learned]] = defaultdict(list)
    for each in (*search.learnable.simple, *search.learnable.further.values()):
        is_one = each.element != ALL and each.element not in PAIRS.values() and each.components == 1
        if is_one and each.place in KINDS and not each.variable.of_element:
            found[KINDS[each.place], each.variable].append(each)
        elif each.ball:
            balls[each.size].append(each)
    return (each for each in (*found.values(), *balls.values()) if len({*map(_whose, each)}) > 1)


def _whose(function: Learned) -> int | str:
    """Return what tells one element's function from another's."""
    return function.ball or function.element


class _Pairs:
    """Compares pairs about the model as it is, on the rows on which hypotheses are ranked."""

    def __init__(self, search: Search) -> None:
        screen, self._thinned = search.screen(search.root), search.thinned
        self._right = self._thinned.without_own(screen.sums.linear)
        self._sizes_mm, self._temper = screen.sizes_mm, screen.temper

    def best_of(self, functions: Sequence[Learned]) -> Pair:
        """Return the best pair of some functions of as many splines each."""
        tables = [self._thinned.scaled(each) for each in functions]
        together = np.hstack(tables)
        cross = together.T @ self._right
        half = cross[:, :-1]
        information, width = together.T @ together - half @ half.T, tables[0].shape[1]
        every = combinations(range(len(functions)), 2)
        # The two directions of one guideway are one element.
        pairs = [(a, b) for a, b in every if _whose(functions[a]) != _whose(functions[b])]
        at = np.array([[*range(a * width, (a + 1) * width), *range(b * width, (b + 1) * width)] for a, b in pairs])
        squares = information[at[:, :, None], at[:, None, :]]
        evidence = log_evidences(squares, cross[at, -1], self._sizes_mm, self._temper)
        best = int(np.argmax(evidence))
        first, second = (functions[each] for each in pairs[best])
        return Pair(float(evidence[best]), (first, second))
