"""What known effects leave where they explain nearly all: another effect, far smaller, is no form of theirs."""

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


def _is_more(search: Search, node: Node) -> bool:
    """Check that a set predicts, and that its last effect is needed and no form of the others."""
    last = node.members[-1]
    return (
        not node.trial.refused
        and predicts(search, node)
        and needs(search, node, last)
        and is_no_form(search, node, last)
    )
