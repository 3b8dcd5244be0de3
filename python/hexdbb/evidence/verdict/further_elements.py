"""Further elements of the effects of a set: what they add is little where fitted, and much where left out."""

from __future__ import annotations

from collections.abc import Iterator

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import NOTHING_LEFT, Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.needed import is_form_alone
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import missed
from hexdbb.evidence.search.sure import is_for_sure

MOST_BEFORE = 2
"""Faults of a set, at most, to which an element is added: a guideway beside its neighbour, and one other cause. Three
that are not for sure stand in for something else: a hose that pulled at the platform was a sag, a gain and two joints,
of which the last explained a hundredth of the noise."""


def with_elements_that_predict(search: Search, node: Node) -> Node:
    """Add an element of an effect that a set has at others, where the set is not for sure without it, but with it.

    A guideway that is bowed less than its neighbour adds no more where fitted than a form may, which geometry takes;
    but geometry carries it to circles left out. What another effect beside the set says as well is none, nor what the
    functions of its form alone say.
    """
    if not node.is_known or not node.members or is_for_sure(search, node):
        return node
    own = [each for each in _wider(search, node) if _is_needed(search, node, each)]
    beside = (each for each in search.nodes if each.is_known and {*node.hypotheses} < {*each.hypotheses})
    every = dict.fromkeys((*own, *(each for each in beside if not each.trial.refused)))
    best_first = sorted(every, key=lambda each: -each.score)
    first = next((each for each in best_first if _predicts_so(search, node, each)), node)
    return first if first in own else node


def _wider(search: Search, node: Node) -> Iterator[Node]:
    """Yield the sets with one more element of an effect of a set."""
    if node.faults > MOST_BEFORE:
        return
    known = [each for each in node.hypotheses if isinstance(each, Known)]
    there = dict.fromkeys((each.effect, element) for each in known for element in each.elements)
    for effect in dict.fromkeys(effect for effect, _ in there):
        for element in search.engine.base.info(effect).elements:
            if (effect, element) in there:
                continue
            try:
                yield search.node((*node.members, Member(Known(effect, (element,)))), near=node)
            except RunError:
                continue


def _is_needed(search: Search, node: Node, wider: Node) -> bool:
    gain = wider.trial.log_evidence - node.trial.log_evidence + search.log_prior(wider.members[-1].hypothesis)
    is_seen = node.trial.left - wider.trial.left >= NOTHING_LEFT
    is_cause = not wider.trial.refused and gain >= search.criteria.detect_nats
    return is_seen and is_cause and not is_form_alone(search, wider, wider.members[-1], node.trial)


def _predicts_so(search: Search, node: Node, wider: Node) -> bool:
    """Check that a further element makes a set predict."""
    errs_less = missed(search, wider) < search.criteria.far_better * missed(search, node)
    return errs_less and not search.checked(wider).reasons and is_for_sure(search, wider)
