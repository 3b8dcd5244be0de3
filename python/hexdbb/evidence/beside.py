"""What causes leave where they explain nearly all: a known effect, far smaller, is no form or shape of theirs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hexdbb.evidence.needed import best_of, needs
from hexdbb.evidence.no_form import is_no_form
from hexdbb.evidence.node import Node
from hexdbb.evidence.settling import leaves_room, predicts
from hexdbb.evidence.several import beside

if TYPE_CHECKING:
    from hexdbb.evidence.search import Search


def with_known_beside(search: Search, best: Node) -> Node:
    """Add to known effects those that explain the little which they leave, where that is more than forms hide."""
    while best.members and best.is_known and len(best.members) < search.criteria.max_effects:
        if not leaves_room(search, best):
            break
        tried = search.tried(best, beside(search, best))
        search.nodes += tried
        wider = best_of(search, best, (each for each in tried if _is_more(search, each)))
        if wider is best:
            break
        best = wider
    return best


def with_known_left(search: Search, node: Node) -> Node:
    """Add to tuned functions the known effect that explains nearly all that they leave, where that is much.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged if it has no function, or leaves hardly more than the noise.
    """
    if node.is_known or node.trial.left < search.criteria.leaves_more:
        return node
    if len(node.members) >= search.criteria.max_effects:
        return node
    tried = [each for each in search.tried(node, beside(search, node)) if _explains_the_rest(search, node, each)]
    search.nodes += tried
    return best_of(search, node, tried)


def _explains_the_rest(search: Search, functions: Node, node: Node) -> bool:
    """Check that a set's last effect is needed, and explains what functions leave, a part of it by its formula.

    What a function leaves of its own shape is like no effect's formula: few values explain little of it.
    """
    if node.trial.refused or not predicts(search, node) or not needs(search, node, node.members[-1]):
        return False
    before, form = functions.trial.left, node.trial.forms[-1]
    left = node.trial.left if form is None else search.left_by_formula(node.trial, form)
    explains = before - node.trial.left
    by_formula = before - left
    is_all = explains >= search.criteria.explained_min * (before - 1.0)
    return is_all and by_formula >= search.criteria.formula_names * explains


def _is_more(search: Search, node: Node) -> bool:
    """Check that a set predicts, and that its last effect is needed and no form of the others."""
    last = node.members[-1]
    return (
        not node.trial.refused
        and predicts(search, node)
        and needs(search, node, last)
        and is_no_form(search, node, last)
    )
