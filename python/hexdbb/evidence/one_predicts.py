"""Sets that fit better than one hypothesis but predict worse: the one is the cause, the set was put together."""

from __future__ import annotations

from hexdbb.evidence.node import Node
from hexdbb.evidence.readings import ARC
from hexdbb.evidence.search import Search
from hexdbb.evidence.sure import is_for_sure


def or_one_that_predicts(search: Search, node: Node) -> Node:
    """Return one hypothesis that predicts all that was left out better than a set which is not for sure; else the set.

    It must explain nearly all alone. What the set explains beyond that it explains only where fitted.
    """
    if len(node.members) < 2 or is_for_sure(search, node):
        return node
    most = search.root.trial.left - search.criteria.form_explains * (search.root.trial.left - 1.0)
    alone = [e for e in search.nodes if len(e.members) == 1 and not e.trial.refused and e.trial.left < most]
    alone.sort(key=lambda each: -each.score)
    return next((each for each in alone if _predicts_better(search, each, node)), node)


def _predicts_better(search: Search, one: Node, several: Node) -> bool:
    """Check that one hypothesis errs less than several in every grouping that they claim to predict."""
    checked, others = search.checked(one), search.checked(several).heldout
    claimed = [grouping for grouping in others if grouping != ARC]
    if checked.reasons or not claimed or any(grouping not in checked.heldout for grouping in claimed):
        return False
    return all(
        checked.heldout[grouping].as_fitted / checked.heldout[grouping].before
        < others[grouping].as_fitted / others[grouping].before
        for grouping in claimed
    )
