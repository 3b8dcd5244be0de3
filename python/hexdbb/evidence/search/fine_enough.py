"""Compare the best learned functions after tuning, and prefer one of them to what the search found.

A search ranks functions, and adds causes, with an initial number of splines and with abrupt changes of sign. At tens of
times the noise, what the true function then fails to describe is larger than the difference between it and a wrong one
(for example the other leg of a pair), or is attributed to a second cause. The best few functions are therefore tuned,
each on its own, and one replaces the set if it has more evidence and predicts the held-out groups.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import TYPE_CHECKING

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.search.by_formulas import are_no_form_of
from hexdbb.evidence.search.last_resort import axes_along, stands_before
from hexdbb.evidence.search.refine import finely_tuned, refined
from hexdbb.evidence.search.settling import (
    explained_by_formulas,
    explains_nearly,
    is_complete,
    leaves_no_structure,
    must_explain,
    predicts,
)
from hexdbb.evidence.search.sure import is_for_sure
from hexdbb.learned import Learned
from hexdbb.learned.following import TURNING

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

TRIED = 3
"""Functions that are tuned, each with several full fits: enough for both legs of a pair and one other place."""


def or_one_fine_enough(search: Search, node: Node) -> Node:
    """Return a single tuned function if it has more evidence than a set and predicts held-out groups; else the set.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged if it is one cause without remaining structure, or known effects for sure.
    """
    if leaves_no_structure(search, node) and len(node.members) == 1:
        return node
    if node.members and node.is_known and is_for_sure(search, node):
        return node
    every = (each for each in _tuned(search, search.criteria.explained_min) if stands_before(search, each, node))
    tuned = [each for each in every if predicts(search, each)]
    best = max((node, *tuned), key=lambda each: each.score)
    if best is node or not search.learnable.is_further(best.hypotheses[0]):
        return best
    # A scale that bends is no scale that bends a few milliseconds late, though that fits a little better. A function of
    # time is not simpler: it describes whatever changes.
    listed = (each for each in tuned if not search.learnable.is_further(each.hypotheses[0]))
    simple = (each for each in listed if best.trial.is_of_time or not each.trial.is_of_time)
    as_good = (each for each in simple if explains_nearly(search, each.trial.left, best.trial.left))
    return max((each for each in as_good if leaves_no_structure(search, each)), key=lambda e: e.score, default=best)


def or_another_beside(search: Search, node: Node) -> Node:
    """Return the same known effects with another function beside them, tuned, where that has more evidence.

    Where what they leave differs by less than the forms of the known effects may hide, the function with the fewest
    axes: that of several is the freer.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged if it is not one function beside known effects, or leaves no more than the noise.
    """
    known = _known(node)
    if len(known) != len(node.members) - 1 or not known or node.trial.left < search.criteria.refined_to:
        return node
    without = tuple(each for each in node.members if each.hypothesis in known)
    left = search.trials.of_fewer(without, node.trial).left
    every = _tuned(search, search.criteria.explained_min, known, left)
    tuned = [node, *(each for each in every if predicts(search, each))]
    best = max(tuned, key=lambda each: each.score)
    hidden = must_explain(search, best.trial)
    alike = [each for each in tuned if each.trial.left < best.trial.left + hidden]
    return min(alike, key=lambda each: (axes_along(each), -each.score))


def _known(node: Node) -> frozenset[Hypothesis]:
    return frozenset(each for each in node.hypotheses if not isinstance(each, Learned))


def or_one_place(search: Search, node: Node, wider: Node) -> tuple[Node, Node]:
    """Return one tuned function, alone and with others of its place, where these say more than several causes.

    Several causes that are not for sure describe what one does whose law no function has: so does the function that
    comes nearest to it, with others of its place beside it, and it is one cause. Known effects that explain all do not
    give way to one that explains less: a pull on the platform that turns with the bar, refined, followed a bow and a
    lead, each 17 % off.

    Parameters
    ----------
    search : Search
    node, wider : Node
        Causes, alone and refined; returned as they are where they are one, or for sure.
    """
    if len(node.members) < 2 or is_for_sure(search, node):
        return node, wider
    if (sure := _one_for_sure(search, node)) is not None:
        return sure, refined(search, sure)
    for alone in islice((each for each in _tuned(search, search.criteria.far_better) if not each.trial.is_of_time), 1):
        if node.is_known and is_complete(search, node) and not _says_nearly_as_much(search, alone, node):
            continue  # known effects say all, and what one function leaves only more of its place would
        if predicts(search, alone) or _explains_far_more(search, alone, node):
            refined_alone = refined(search, alone)
            if refined_alone.score > wider.score:
                return alone, refined_alone
    return node, wider


def _says_nearly_as_much(search: Search, alone: Node, several: Node) -> bool:
    return explains_nearly(search, alone.trial.left, several.trial.left)


def _one_for_sure(search: Search, several: Node) -> Node | None:
    """Return the effect of one of several causes that is for sure alone, and explains nearly all by its formula.

    What it leaves is what its form leaves, or one more fault that nothing says for sure: a ball fixed off its place,
    whose seat rocks, was a ball and a bow, and for these no single function that explained less than the ball alone.
    """
    effects = {each.effect for each in several.hypotheses if isinstance(each, Known)}
    every = [
        each
        for each in search.nodes
        if len(each.members) == 1 and isinstance(each.hypotheses[0], Known) and each.hypotheses[0].effect in effects
    ]
    sure = (each for each in every if _is_sure_alone(search, each))
    found = (each for each in sure if not are_no_form_of(search, several, each.hypotheses[0]))
    return max(found, key=lambda each: each.score, default=None)


def _is_sure_alone(search: Search, each: Node) -> bool:
    is_main = explained_by_formulas(search, each) >= search.criteria.form_explains
    return is_main and not each.trial.refused and predicts(search, each) and is_for_sure(search, each)


def _explains_far_more(search: Search, alone: Node, several: Node) -> bool:
    """Check that causes explain too little to be named, and one function far more, whether it predicts or not."""
    first, left = search.root.trial.left - 1.0, several.trial.left - 1.0
    is_little = first - left < search.criteria.explained_min * first
    return is_little and alone.trial.left - 1.0 < search.criteria.far_better * left


def _tuned(
    search: Search, least: float, known: frozenset[Hypothesis] = frozenset(), left: float | None = None
) -> Iterator[Node]:
    """Yield the single functions with the most evidence beside known effects, or alone, tuned.

    Each explains such a part at least of what these leave. One whose sign change was smoothed is the same function.
    """
    left = search.root.trial.left if left is None else left
    alone = [each for each in search.nodes if len(each.members) == len(known) + 1 and _known(each) == known]
    best: dict[str, Node] = {}
    for each in sorted(alone, key=lambda each: -each.score):
        if left - each.trial.left >= least * (left - 1.0):
            name = next(one.name for one in each.hypotheses if isinstance(one, Learned))
            best.setdefault(name.partition(f"_{TURNING}@")[0], each)
    for each in islice(best.values(), TRIED):
        yield finely_tuned(search, each)
