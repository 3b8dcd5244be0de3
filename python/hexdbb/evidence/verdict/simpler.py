"""Names for products of two states: the product is named by one state where that state alone explains nearly as much.

A lag depends on the velocity even if it varies along the guideway. The product is then kept as the form of the simple
function, as `refine.py` does for known effects.
"""

from __future__ import annotations

from collections.abc import Iterator

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import explains_nearly, misses_most
from hexdbb.learned import Learned


def in_simple_words(search: Search, node: Node) -> Node:
    """Add the function of one state to each product that it nearly explains; the product becomes its form."""
    for member in node.members:
        simple = max(_instead(search, node, member), key=lambda each: each.score, default=None)
        if simple is None:
            continue
        try:
            both = search.node((*simple.members, member), near=node)
        except RunError:
            continue
        if not both.trial.refused:
            node = both
    return node


def _instead(search: Search, node: Node, member: Member) -> Iterator[Node]:
    """Yield sets in which a function of one state replaces a product, if they explain nearly as much and predict."""
    product = member.hypothesis
    if not isinstance(product, Learned):
        return
    learnable = search.learnable
    last = learnable.crossed.values() if learnable.is_crossed(product) else ()
    varying = {*learnable.simple, *learnable.further.values(), *last}
    parts = [each for each in product.parts if each in varying and each not in node.hypotheses]
    if not parts:
        return
    base = search.node(node.without(member), near=node)
    screen = search.screen(base)
    for each in search.tried(base, [screen.scored(part) for part in parts]):
        nearly = explains_nearly(search, each.trial.left, node.trial.left) and not each.trial.refused
        if nearly and not search.checked(each).reasons and not misses_most(search, each):
            yield each
