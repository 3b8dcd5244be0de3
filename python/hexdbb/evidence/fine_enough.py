"""One learned function, fine enough, in place of others or of several causes.

A search ranks functions, and adds causes, with the splines and the turning over that they are first tried with. What
the true one leaves at tens of times the noise, since it bends or turns over within less, others describe as well: that
of the other leg of a pair, or friction there beside it. The few that explain most alone are therefore tuned, each by
itself, and one of them is named where it then has more evidence than what was found.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from hexdbb.evidence.node import Node
from hexdbb.evidence.refine import with_best_splines
from hexdbb.evidence.search import Search
from hexdbb.evidence.settling import leaves_no_structure, predicts
from hexdbb.evidence.tuned import with_tuned_numbers
from hexdbb.evidence.turning import with_turning
from hexdbb.learned import Learned

TRIED = 3
"""Functions that are tuned alone: each takes some full fits, and of those that look alike two are of one pair."""


def or_one_fine_enough(search: Search, node: Node) -> Node:
    """Return a learned function alone, tuned, where it has more evidence than a set and predicts; else the set.

    Parameters
    ----------
    search : Search
    node : Node
        Returned as it is where it is one function that leaves no structure, or of known effects alone.
    """
    if node.is_known or (len(node.members) == 1 and leaves_no_structure(search, node)):
        return node
    return max((node, *(each for each in _tuned(search) if predicts(search, each))), key=lambda each: each.score)


def _tuned(search: Search) -> Iterator[Node]:
    """Yield the functions that explain most of what is missing, tuned."""
    excess = search.root.trial.left - 1.0
    alone = [each for each in search.nodes if len(each.members) == 1 and isinstance(each.hypotheses[0], Learned)]
    best: dict[str, Node] = {}
    for each in sorted(alone, key=lambda each: -each.score):
        if search.root.trial.left - each.trial.left >= search.criteria.explained_min * excess:
            best.setdefault(each.hypotheses[0].name, each)
    for each in islice(best.values(), TRIED):
        yield with_turning(search, with_tuned_numbers(search, with_best_splines(search, with_turning(search, each))))
