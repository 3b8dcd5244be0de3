"""A function of one state with known effects beside it, in place of one function of two that is free enough for all.

Lobes of a ball, by where the bar points, beside play of three sliders were lobes that differ by the way round: play
turns over with the direction, and so does a function that may.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.search.by_formulas import explains_by_its_own
from hexdbb.evidence.search.needed import is_better
from hexdbb.evidence.search.screened import known_sets_beside
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import predicts
from hexdbb.learned import Learned

SETS_FITTED = 3
"""Sets of known effects fitted in full beside the simple function, those of most evidence to first order: each costs a
fit. In the record that asked for it, play of three sliders beside lobes, the true set was the first of six."""


def or_a_simple_one_beside(search: Search, node: Node) -> Node:
    """Return the best set of a simple function with known effects, where it is better than a product alone.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged if it is not one product of states, or leaves hardly more than the noise.
    """
    if len(node.members) != 1 or node.trial.left < search.criteria.leaves_more:
        return node
    product = node.hypotheses[0]
    if not isinstance(product, Learned) or node.trial.is_of_time:
        return node
    found = [each for part in product.parts for each in _beside(search, node, part) if _stands(search, each, node)]
    return max(found, key=lambda each: each.score, default=node)


def _beside(search: Search, node: Node, part: Learned) -> Iterator[Node]:
    alone = search.screen(search.root).scored(part)
    for base in search.tried(search.root, [alone]):
        sets = known_sets_beside(search, base.trial, search.criteria.max_effects - 1)
        for together in sorted(sets, key=lambda each: -each.log_evidence)[:SETS_FITTED]:
            with suppress(RunError):
                yield search.node((*base.members, *(Member(each.known) for each in together.members)), near=node)


def _stands(search: Search, node: Node, before: Node) -> bool:
    """Check that a set is better and predicts, each effect of it nearly all that the others leave, by its own formula.

    What the shape of the simple function leaves is like no effect's formula.
    """
    if node.trial.refused or not is_better(search, node, before) or not predicts(search, node):
        return False
    known = (each for each in node.members if not isinstance(each.hypothesis, Learned))
    return all(explains_by_its_own(search, node, each, search.criteria.own_formula) for each in known)
