"""Two of several known effects exchanged at once for two others: alone, neither of these says enough.

Beside a spike after reversals two screws that warm were a gauge that drifts, and a screw between them, by their forms.
Each cause taken out in turn leaves the other, which stands in for what either of the true ones would say.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from itertools import combinations

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.search.needed import is_better
from hexdbb.evidence.search.screened import known_sets_beside
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.sure import is_for_sure
from hexdbb.evidence.verdict.exchange import is_admissible

LEAST_MEMBERS = 3
"""Causes from which two are exchanged beside a third: of two the pairs beside none were screened at first."""
PAIRS_FITTED = 2
"""Pairs fitted in full in place of each two: of four causes there are six twos, and each pair costs a fit. In the
record that asked for it, two screws beside a spike, the true pair was among them."""


def or_two_others(search: Search, node: Node) -> Node:
    """Return the best set of known effects with two others in place of two of its own, where it is better.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged if it has a function, fewer than three effects, or is for sure.
    """
    if not node.is_known or len(node.members) < LEAST_MEMBERS or is_for_sure(search, node):
        return node
    better = (each for each in _exchanged(search, node) if is_better(search, each, node))
    found = [each for each in better if is_admissible(search, each)]
    return max(found, key=lambda each: each.score, default=node)


def _exchanged(search: Search, node: Node) -> Iterator[Node]:
    for pair in combinations(node.members, 2):
        rest = tuple(each for each in node.members if each not in pair)
        base = search.node(rest, near=node)
        for together in known_sets_beside(search, base.trial, 2)[:PAIRS_FITTED]:
            others = [each.known for each in together.members if each.known not in node.hypotheses]
            if len(others) == len(pair):
                with suppress(RunError):
                    yield search.node((*rest, *map(Member, others)), near=base)
