"""Products of two states called by one of them, where that alone explains nearly as much.

A lag is of the velocity, though it may not be the same along the guideway; warmth grows with time, though not alike in
all directions. The product then describes the form of the simple function, as functions at the place of a known effect
describe its own (`refine.py`).
"""

from __future__ import annotations

from collections.abc import Iterator

from hexdbb.errors import RunError
from hexdbb.evidence.node import Node
from hexdbb.evidence.one_cause import explains_nearly
from hexdbb.evidence.search import Search
from hexdbb.evidence.settling import misses_most
from hexdbb.evidence.trial import Member
from hexdbb.learned import Learned


def in_simple_words(search: Search, node: Node) -> Node:
    """Put functions of one state beside products that they explain nearly all of; the product becomes their form."""
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
    """Yield the sets with a function of one state in a product's stead that explain nearly as much and predict."""
    product = member.hypothesis
    if not isinstance(product, Learned):
        return
    varying = {*search.learnable.simple, *search.learnable.further.values()}
    parts = [each for each in product.parts if each in varying and each not in node.hypotheses]
    if not parts:
        return
    base = search.node(node.without(member), near=node)
    screen = search.screen(base)
    for each in search.tried(base, [screen.scored(part) for part in parts]):
        nearly = explains_nearly(search, each.trial.left, node.trial.left) and not each.trial.refused
        if nearly and not search.checked(each).reasons and not misses_most(search, each):
            yield each
