"""A function that leaves more than the noise, with the same state at the element's other places.

A listed function that explains nearly all ends the search before every state at every place is looked at. What it
leaves may be what the place says: the joint of a slider that is lifted with its velocity lengthens the leg, but for the
angle at which that stands. Functions of one state at the places of one element are few, and are compared tuned.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from hexdbb.evidence.last_resort import axes_along, state_of
from hexdbb.evidence.node import Node
from hexdbb.evidence.refine import finely_tuned
from hexdbb.evidence.settling import explains_nearly, predicts
from hexdbb.learned import Learned

if TYPE_CHECKING:
    from hexdbb.evidence.search import Search

TRIED = 3
"""Places tuned by several full fits each: a leg's joints at the slider and the platform say nearly the same."""


def or_at_another_place(search: Search, node: Node) -> Node:
    """Return the set with the same state at another place of the element, along fewer axes or if it leaves far less.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged if it is not one function, alone or beside known effects, or leaves no more than the noise
        along one axis.
    """
    functions = [each for each in node.members if isinstance(each.hypothesis, Learned)]
    if len(functions) != 1 or not search.learns:
        return node
    if node.trial.left < search.criteria.refined_to and axes_along(node) == 1:
        return node
    others = node.without(functions[0])
    base = search.node(others, near=node) if others else search.root
    learned = functions[0].hypothesis
    assert isinstance(learned, Learned)
    learnable = search.learnable
    every = [*learnable.further.values(), *learnable.crossed.values(), *learnable.by_name.values()]
    same = {each.name: each for each in every if state_of(each) == state_of(learned) and each.place != learned.place}
    screen = search.screen(base)
    scored = sorted((screen.scored(each) for each in same.values()), key=lambda each: -each.log_evidence)
    tried = search.tried(base, scored[:TRIED])
    if not tried:
        return node
    before = finely_tuned(search, node)
    tuned = [
        each
        for each in (finely_tuned(search, one) for one in tried)
        if _is_there(search, each, before) or _says_as_much(search, each, before)
    ]
    best = max(tuned, key=lambda each: each.score, default=node)
    search.nodes += [each for each in tried if not any(each is other for other in search.nodes)]
    return best


def or_at_the_rails(search: Search, node: Node) -> Node:
    """Return the set in which what legs do by their sliders' positions is what the rails under these do.

    No leg knows where its slider stands. A dent that one slider alone passes lengthens its leg: the two read alike, and
    the leg has less to say, by some tens of nats, where the rail leads the other slider too.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged if no function of it goes by the rail, or no rail explains nearly as much and predicts.
    """
    for member in node.members:
        if not isinstance(member.hypothesis, Learned) or not member.hypothesis.goes_by_the_rail:
            continue
        base = search.node(node.without(member), near=node)
        screen = search.screen(base)
        rails = [each for each in search.learnable.by_name.values() if each.is_at_the_rail_of(member.hypothesis)]
        tried = search.tried(base, screen.learned(rails)[:TRIED])
        search.nodes += [each for each in tried if not any(each is other for other in search.nodes)]
        alike = (each for each in tried if explains_nearly(search, each.trial.left, node.trial.left))
        good = [each for each in alike if not each.trial.refused and predicts(search, each)]
        node = max(good, key=lambda each: each.score, default=node)
    return node


def _says_as_much(search: Search, node: Node, before: Node) -> bool:
    """Check that a set along fewer axes has as much evidence as another, and errs no more on anything left out.

    What is freer expects to err more, and so is refused less: where it errs as much, but for the scatter of such a mean
    square, that is no reason for it.
    """
    if node.score < before.score or node.trial.refused or axes_along(node) >= axes_along(before):
        return False
    own, others = search.checked(node).heldout, search.checked(before).heldout
    most = 1.0 + (2.0 * len(search.engine.readings)) ** -0.5
    return all(grouping in own and own[grouping].after <= most * held.after for grouping, held in others.items())


def _is_there(search: Search, node: Node, before: Node) -> bool:
    """Check that a set predicts, has more evidence than another, and fewer axes, or leaves far less."""
    if node.score - before.score <= search.criteria.margin_nats or node.trial.refused:
        return False
    is_less = node.trial.left - 1.0 < search.criteria.far_better * (before.trial.left - 1.0)
    return (is_less or axes_along(node) < axes_along(before)) and predicts(search, node)
