"""Which hypotheses of a set are one cause: a function and an effect at one place, of which one is the other's form."""

from __future__ import annotations

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.search.place import at_its_place
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import explains_nearly
from hexdbb.learned import Learned


def is_refined(search: Search, node: Node, cause: Hypothesis, learned: Learned) -> bool:
    """Check that a cause alone explains nearly as much as the learned function at its place alone, beside the others.

    A function that explains more by far is the cause, and the effect a part of its form. Of two learned functions at
    one place the lesser is the form of the other, however much less, unless it changes with time and the other does
    not. One function that pushes across a guideway in both of its directions is two learned ones. The bar's two balls
    are two causes.
    """
    if isinstance(cause, Learned) and cause.ball and learned.ball and cause.ball != learned.ball:
        return False
    if isinstance(cause, Learned) and (
        cause in learned.parts or cause.variable == learned.variable or cause.is_of_time == learned.is_of_time
    ):
        return True
    return explains_nearly(search, left_without(search, node, learned), left_without(search, node, cause))


def without_borrowed_forms(search: Search, node: Node) -> Node:
    """Exchange known effects for learned functions where they are a part of the form of another at their place.

    Such an effect explains too little alone to be a cause, less than the function does. The cause is that function, and
    one of another variable describes its form as well: a spike of a form of its own is no play.
    """
    for known in [each for each in node.hypotheses if isinstance(each, Known)]:
        lent = (each for each in node.hypotheses if isinstance(each, Learned) and _borrows(search, node, known, each))
        node = next((_exchanged(search, node, known, each) for each in lent), node)
    return node


def _borrows(search: Search, node: Node, known: Known, learned: Learned) -> bool:
    """Check that a function at an effect's place explains more than the effect, which explains too little alone."""
    if not at_its_place(search, known, learned):
        return False
    one, other = left_without(search, node, learned), left_without(search, node, known)
    return other < one and one - node.trial.left > (1.0 - search.criteria.explained_min) * _excess(search)


def _exchanged(search: Search, node: Node, known: Known, cause: Learned) -> Node:
    """Return the best set that has, in a known effect's stead, another function at the cause's place; else the same."""
    most = node.trial.left + search.criteria.same_kind_share * _excess(search)
    rest = {each for each in node.hypotheses if each != known}
    found = []
    for other in search.nodes:
        instead = [each for each in other.hypotheses if each not in rest]
        if len(other.members) != len(node.members) or len(instead) != 1 or not isinstance(instead[0], Learned):
            continue
        if at_its_place(search, cause, instead[0]) and other.trial.left < most and not other.trial.refused:
            found.append(other)
    found.sort(key=lambda each: -each.score)
    return next((each for each in found if not search.checked(each).reasons), node)


def left_without(search: Search, node: Node, hypothesis: Hypothesis) -> float:
    """Return what a set leaves without one of its hypotheses; infinity where that cannot be fitted."""
    try:
        return search.trials.of(tuple(each for each in node.members if each.hypothesis != hypothesis)).left
    except RunError:
        return float("inf")


def _excess(search: Search) -> float:
    return search.root.trial.left - 1.0
