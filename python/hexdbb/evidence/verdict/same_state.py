"""A function that leaves more than the noise, with the same state at the element's other places.

A listed function that explains nearly all ends the search before every state at every place is looked at. What it
leaves may be what the place says: the joint of a slider that is lifted with its velocity lengthens the leg, but for the
angle at which that stands. Functions of one state at the places of one element are few, and are compared tuned.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Scored
from hexdbb.evidence.linear.signatures import varying
from hexdbb.evidence.search.last_resort import axes_along, state_of
from hexdbb.evidence.search.refine import finely_tuned
from hexdbb.evidence.search.settling import explains_nearly, predicts
from hexdbb.learned import Learned, has_chosen_number, number_of
from hexdbb.learned.places import OF_GUIDEWAY
from hexdbb.learned.variable import NUMBERED

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

FINE = "fine_"
"""How names of variables begin that have more splines than another of the same column: one state."""
TRIED = 3
"""Places tuned by several full fits each: a leg's joints at the slider and the platform say nearly the same."""


def or_at_another_place(search: Search, node: Node) -> Node:
    """Return the set with the same state at another place of the element.

    It is that along fewer axes, or if it leaves far less, or has more evidence and errs no more.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged if it is not one function, alone or beside known effects, or leaves no more than the noise
        along one axis with as many splines as are listed.
    """
    functions = [each for each in node.members if isinstance(each.hypothesis, Learned)]
    if len(functions) != 1 or not search.learns:
        return node
    learned = functions[0].hypothesis
    assert isinstance(learned, Learned)
    is_fine = learned.variable.count > Learned.parse(learned.name).variable.count
    if node.trial.left < search.criteria.refined_to and axes_along(node) == 1 and not is_fine:
        return node
    others = node.without(functions[0])
    base = search.node(others, near=node) if others else search.root
    screen = search.screen(base)
    same = varying(_elsewhere(search, learned), search.engine.readings)
    of_each: dict[tuple[str, int], Scored] = {}
    for each in sorted((screen.scored(each) for each in same), key=lambda each: -each.log_evidence):
        assert isinstance(each.hypothesis, Learned)
        of_each.setdefault((each.hypothesis.place, each.hypothesis.element), each)
    tried = search.tried(base, [*of_each.values()][:TRIED])
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


def _elsewhere(search: Search, learned: Learned) -> list[Learned]:
    """Return the functions of the same state at the element's other places, with the same number in their names."""
    learnable = search.learnable
    every = [*learnable.further.values(), *learnable.crossed.values(), *learnable.by_name.values()]
    same = [each for each in every if _variable_of(each) == _variable_of(learned) and _is_elsewhere(each, learned)]
    if has_chosen_number(learned.variable):
        number = number_of(learned.variable)
        same = [each.with_number(number) if has_chosen_number(each.variable) else each for each in same]
    return [*{each.name: each for each in same}.values()]


def _variable_of(learned: Learned) -> str:
    """Return the name of the variable, whatever number it has, and whoever's it is."""
    variable = state_of(learned)[1].removeprefix(FINE)
    name = variable.partition(NUMBERED)[0] if has_chosen_number(learned.variable) else variable
    return name.removeprefix(f"slider_{learned.variable.of_element}_")


def _whose(learned: Learned) -> int:
    """Return the element whose variable it is: what couples into the gauge's cable is another's."""
    return learned.variable.of_element or learned.element


def _is_elsewhere(one: Learned, other: Learned) -> bool:
    """Check for another place of the same elements: a guideway and a leg of one number have nothing in common."""
    if (one.place in OF_GUIDEWAY) != (other.place in OF_GUIDEWAY):
        return False
    return (one.place, one.element) != (other.place, other.element) and _whose(one) == _whose(other)


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
    square, that is no reason for it. Nor is what neither determines, by what it expects of itself.
    """
    if node.score < before.score - search.criteria.margin_nats or node.trial.refused:
        return False
    most = search.criteria.extrapolates
    return axes_along(node) < axes_along(before) and _errs_as_little(search, node, before, determined_to=most)


def _is_there(search: Search, node: Node, before: Node) -> bool:
    """Check that a set predicts, has more evidence than another, and fewer axes, leaves far less, or errs no more.

    What a cable does that is wound up, turn by turn, is few values where it pulls along one direction, and many where
    that goes round with the angle. Of sixty functions of one axis that were true, tuned, none had less evidence than
    the same state along several without erring more: what has more evidence, and errs no more, is no freer guess.
    """
    if node.score - before.score <= search.criteria.margin_nats or node.trial.refused:
        return False
    left, excess = node.trial.left - 1.0, before.trial.left - 1.0
    is_less = excess > search.criteria.leaves_more - 1.0 and left < search.criteria.far_better * excess
    if not predicts(search, node):
        return False
    if is_less or axes_along(node) < axes_along(before):
        return True
    return _errs_as_little(search, node, before)


def _errs_as_little(search: Search, node: Node, before: Node, determined_to: float = math.inf) -> bool:
    """Check that a set errs no more than another on all that the other determines, but for such errors' scatter."""
    own, others = search.checked(node).heldout, search.checked(before).heldout
    most = 1.0 + (2.0 * len(search.engine.readings)) ** -0.5
    determined = {key: held for key, held in others.items() if held.expected <= determined_to}
    return all(grouping in own and own[grouping].after <= most * held.after for grouping, held in determined.items())
