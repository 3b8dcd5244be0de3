"""What was found second, alone: it may say all, and the first have stood in for a part of it.

A ball that sinks as the platform leans was a joint off its place first; beside that a function said what it is. Known
effects at the root settle what is missing before further functions are looked at, and so that one was never alone.
"""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.search.refine import finely_tuned
from hexdbb.evidence.search.settling import is_complete, predicts
from hexdbb.evidence.search.sure import is_for_sure

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

TRIED = 2
"""Larger sets whose last is looked at alone: one state at two places may have come second."""


def or_the_second_alone(search: Search, node: Node) -> Node:
    """Return what was found beside a set, alone, where it explains more than the set does; else the set.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged if it is known effects for sure.
    """
    if not (search.learns and node.members) or (node.is_known and is_for_sure(search, node)):
        return node
    found = [each for each in _alone(search, node) if _stands_before(search, each, node)]
    return max(found, key=lambda each: each.score, default=node)


def _alone(search: Search, node: Node) -> list[Node]:
    """Return, tuned, what the best sets have that hold this one and one more."""
    wider = [e for e in search.nodes if {*node.hypotheses} < {*e.hypotheses} and e.score > node.score]
    wider = [each for each in wider if len(each.members) == len(node.members) + 1 and not each.trial.refused]
    best: dict[str, Node] = {}
    for each in sorted(wider, key=lambda each: -each.score):
        best.setdefault(each.members[-1].hypothesis.name, each)
    found = []
    for each in islice(best.values(), TRIED):
        last = next(one for one in each.members if one.hypothesis not in node.hypotheses)
        try:
            found.append(finely_tuned(search, search.node((last,), near=each)))
        except RunError:
            continue
    return found


def _stands_before(search: Search, alone: Node, node: Node) -> bool:
    """Check that one cause is no free function of time, explains all, predicts, and has more evidence than a set."""
    if alone.trial.is_of_time or alone.trial.refused:
        return False
    is_more = alone.score - node.score > search.criteria.margin_nats and alone.trial.left < node.trial.left
    return is_more and is_complete(search, alone) and predicts(search, alone)
