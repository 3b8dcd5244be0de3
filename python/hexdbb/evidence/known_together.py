"""Known effects chosen together, where one free function would explain a little of each of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hexdbb.errors import RunError
from hexdbb.evidence.needed import best_of, needs_all
from hexdbb.evidence.node import Node
from hexdbb.evidence.screened import known_sets
from hexdbb.evidence.settling import explains_all_alone, is_doubtful, leaves_nothing, leaves_room, predicts
from hexdbb.evidence.trial import Member

if TYPE_CHECKING:
    from hexdbb.evidence.search import Search
    from hexdbb.evidence.together import Together


def or_known_together(search: Search, best: Node) -> Node:
    """Return the best set of known effects, chosen together, where it is better than what explains most alone.

    Of three faults none explains much alone, and a free function that explains all three a little stands first.
    """
    found = [best]
    alone = {each.hypotheses[0]: each for each in search.nodes if explains_all_alone(search, each)}
    predicts_alone = any(not search.checked(each).excused for each in alone.values())
    for together in known_sets(search, 2 if predicts_alone else search.criteria.max_effects):
        # Nothing is left for one more where fewer explain all, and predict it as well as they explain it.
        if any(len(each.members) < len(together.members) and leaves_nothing(search, each) for each in found[1:]):
            break
        # What explains all alone may be of an odd form because of another: only where the two predict.
        in_form = [alone[each] for each in together.effects if each in alone]
        if not all(leaves_room(search, each) or search.checked(each).excused for each in in_form):
            continue
        node = _fitted(search, together)
        # What does not predict is told by one pass over the readings, what is needed by fits of every smaller set.
        if node is None or node.score <= best.score or node.trial.refused or not predicts(search, node):
            continue
        if not (in_form and is_doubtful(search, node)) and needs_all(search, node):
            found.append(node)
    return best_of(search, best, found[1:])


def _fitted(search: Search, together: Together) -> Node | None:
    """Fit a screened set in full; None where the engine cannot."""
    members = tuple(Member(each.known) for each in together.members)
    try:
        trial = search.trials.of(members)
    except RunError:
        return None
    node = next((each for each in search.nodes if each.trial is trial), None)
    if node is None:
        node = Node(trial, trial.log_evidence + sum(search.log_prior(each.hypothesis) for each in members))
        search.nodes.append(node)
    return node
