"""Sets that lack a cause of the chosen one: among them are other explanations of what it explains."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.search.last_resort import state_of
from hexdbb.evidence.search.place import kin_of
from hexdbb.evidence.search.search import Search
from hexdbb.learned import ALL, Learned, part_of
from hexdbb.learned.places import EACH, members


def sets_without(search: Search, node: Node, cause: Hypothesis) -> Iterator[tuple[Node, float]]:
    """Yield the sets without a cause, the best first, and how far the chosen one leads."""
    for other in sorted(search.nodes, key=lambda each: -each.score):
        if not other.trial.refused and not has_kind(search, other, cause):
            yield other, (node.score - other.score) / max(node.trial.left, 1.0)


def has_effect(other: Node, cause: Hypothesis) -> bool:
    """Check for a known cause's effect in a set, at whatever element."""
    return isinstance(cause, Known) and any(isinstance(e, Known) and e.effect == cause.effect for e in other.hypotheses)


def has_kind(search: Search, other: Node, cause: Hypothesis) -> bool:
    """Check for a cause in a set, in the words of two sliders together and one of them alone, or of all six, too.

    That six sliders lag, each in its own way, says of one of them that it does.
    """
    learned = [each for each in other.hypotheses if isinstance(each, Learned)]
    both = (pair.other_of_pair(one) for pair in learned for one in learned)
    if any(search.same_kind(each, cause) for each in (*other.hypotheses, *filter(None, both))):
        return True
    return any(_is_one_of(home, six) for six in learned if six.element == EACH for home in kin_of(search, cause))


def _is_one_of(one: Learned, six: Learned) -> bool:
    """Check for the function of one of six elements, its change of sign gradual or not."""
    is_there = one.place == six.place and one.element in members(EACH)
    return is_there and state_of(one) == state_of(replace(six, element=one.element))


def acts_where_they_do(search: Search, other: Node, node: Node) -> bool:
    """Check for a function all of whose elements are those of causes of a set, at their own place."""
    (one,) = other.hypotheses
    if not isinstance(one, Learned):
        return False
    homes = [home for cause in node.hypotheses for home in kin_of(search, cause) if home.element != ALL]
    places = {(part_of(home), element) for home in homes for element in members(home.element)}
    return {(part_of(one), element) for element in members(one.element)} <= places
