"""What causes leave where they explain nearly all: a known effect, far smaller, is no form or shape of theirs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.search.needed import best_of, needs
from hexdbb.evidence.search.no_form import is_near, is_no_form
from hexdbb.evidence.search.settling import leaves_room, predicts
from hexdbb.evidence.search.several import beside
from hexdbb.learned import Learned

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search


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
    tried = search.tried(node, beside(search, node))
    elsewhere = [each for each in tried if _is_elsewhere(search, node, each)]
    left = elsewhere or [each for each in tried if _explains_the_rest(search, node, each)]
    search.nodes += left
    # What a function explains, however much, hides nothing elsewhere: the likeliest of these counts.
    return max(elsewhere, key=lambda each: each.score) if elsewhere else best_of(search, node, left)


def _is_elsewhere(search: Search, functions: Node, node: Node) -> bool:
    """Check that a set's last effect acts where no function of it does, and its formula explains much of the rest.

    Where functions explain thousands of times the noise, what their shapes leave may be more than such an effect does.
    """
    if not _is_allowed(search, node):
        return False
    last = node.members[-1].hypothesis
    learned = (each for each in functions.hypotheses if isinstance(each, Learned))
    if any(is_near(search, last, each) for each in learned):
        return False
    by_formula = functions.trial.left - _left_by_formula(search, node)
    is_much = by_formula >= search.criteria.formula_beside * (functions.trial.left - 1.0)
    return is_much and by_formula >= search.criteria.formula_most * (functions.trial.left - node.trial.left)


def _explains_the_rest(search: Search, functions: Node, node: Node) -> bool:
    """Check that a set's last effect is needed, and explains what functions leave, a part of it by its formula.

    What a function leaves of its own shape is like no effect's formula: few values explain little of it.
    """
    if not _is_allowed(search, node) or not needs(search, node, node.members[-1]):
        return False
    before = functions.trial.left
    explains, by_formula = before - node.trial.left, before - _left_by_formula(search, node)
    is_all = explains >= search.criteria.explained_min * (before - 1.0)
    return is_all and by_formula >= search.criteria.formula_names * explains


def _is_allowed(search: Search, node: Node) -> bool:
    return not node.trial.refused and predicts(search, node)


def _left_by_formula(search: Search, node: Node) -> float:
    """Return what a set leaves where its last effect has no functions of its form."""
    form = node.trial.forms[-1]
    return node.trial.left if form is None else search.left_by_formula(node.trial, form)


def _is_more(search: Search, node: Node) -> bool:
    """Check that a set predicts, and that its last effect is needed and no form of the others."""
    last = node.members[-1]
    return (
        not node.trial.refused
        and predicts(search, node)
        and needs(search, node, last)
        and is_no_form(search, node, last)
    )
