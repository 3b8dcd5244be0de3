"""Known effects chosen together, where one free function would explain a little of each of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.search.last_resort import as_much_as
from hexdbb.evidence.search.needed import best_of, by_formulas_instead, needs, needs_all
from hexdbb.evidence.search.screened import known_sets
from hexdbb.evidence.search.settling import (
    explains_all_alone,
    is_doubtful,
    leaves_nothing,
    leaves_room,
    missed,
    predicts,
    rests_on_form,
)

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

LEAST = 0.6
"""Part of what the best's explained squares are worth as evidence that a set must have to first order to be fitted:
sets that were better than it had 0.7 and more, those of one fault that none of them is 0.02 to 0.5."""


def or_known_together(search: Search, best: Node) -> Node:
    """Return the best set of known effects, chosen together, where it is better than what explains most alone.

    Of three faults none explains much alone, and a free function that explains all three a little stands first.
    """
    found = [best]
    alone = {each.hypotheses[0]: each for each in search.nodes if explains_all_alone(search, each)}
    predicts_alone = not all(_stands_by_form(search, each) for each in alone.values())
    least = as_much_as(search, best, part=LEAST)
    for together in known_sets(search, 2 if predicts_alone else search.criteria.max_effects):
        if together.log_evidence < least:
            continue
        # Nothing is left for one more where fewer explain all, and predict it as well as they explain it.
        if any(len(each.members) < len(together.members) and leaves_nothing(search, each) for each in found[1:]):
            break
        # What explains all alone may be of an odd form because of another: only where the two predict.
        in_form = [alone[each] for each in together.effects if each in alone]
        if not all(leaves_room(search, each) or _stands_by_form(search, each) for each in in_form):
            continue
        node = _fitted(search, tuple(Member(each.known) for each in together.members))
        # What does not predict is told by one pass over the readings, what is needed by fits of every smaller set.
        if node is None or not _stands(search, node, best, in_form):
            continue
        node = _of_all_needed(search, node)
        if _stands(search, node, best, in_form) and needs_all(search, node):
            found.append(node)
    return best_of(search, best, found[1:])


def _stands_by_form(search: Search, alone: Node) -> bool:
    """Check for an effect that only its form excuses from predicting, or that explains much by its form only."""
    return search.checked(alone).excused or rests_on_form(search, alone.trial)


def _stands(search: Search, node: Node, best: Node, alone: Sequence[Node]) -> bool:
    """Check that a set has more evidence than the best, and predicts; all of it where one explains all in its form.

    Or far better than each that only its form excuses, or by formula where each is by its form: those who do not know
    which it is are told of both.
    """
    if node.score <= best.score or node.trial.refused or not predicts(search, node):
        return False
    if not (alone and is_doubtful(search, node)):
        return True
    if all(by_formulas_instead(search, node, each.trial) for each in alone):
        return True
    error, far_better = missed(search, node), search.criteria.far_better
    return not search.checked(node).excused and all(
        search.checked(each).excused and error < far_better * missed(search, each) for each in alone
    )


def _of_all_needed(search: Search, node: Node) -> Node:
    """Leave out of a set what it does not need, the least first: with one too many, two may stand among the first."""
    while len(node.members) > 2:
        spare = [each for each in node.members if not needs(search, node, each)]
        others = (_fitted(search, tuple(one for one in node.members if one is not each)) for each in spare)
        fewer = max((each for each in others if each is not None), key=lambda each: each.score, default=None)
        if fewer is None:
            break
        node = fewer
    return node


def _fitted(search: Search, members: tuple[Member, ...]) -> Node | None:
    """Fit a set in full; None where the engine cannot."""
    try:
        trial = search.trials.of(members)
    except RunError:
        return None
    node = next((each for each in search.nodes if each.trial is trial), None)
    if node is None:
        node = Node(trial, trial.log_evidence + sum(search.log_prior(each.hypothesis) for each in members))
        search.nodes.append(node)
    return node
