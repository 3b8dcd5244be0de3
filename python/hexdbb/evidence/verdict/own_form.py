"""A function that is the form of a known effect: it describes what the effect's formula leaves, in the effect's place.

A lead error that bends is a lead error still. Where its formula explains most of what is missing, and the function in
which it lives nearly all, the function says how exact the formula is, not that there is another cause.
"""

from __future__ import annotations

from contextlib import suppress

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.by_formulas import explains_by_its_own
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import explained_by_formulas, explains_nearly, predicts
from hexdbb.evidence.verdict.known_words import acts_there, known_for
from hexdbb.learned import Learned


def with_known_of_form(search: Search, node: Node, wider: Node) -> tuple[Node, Node]:
    """Return the known effect of which the only function found is the form, with that function.

    Parameters
    ----------
    search : Search
    node, wider : Node
        Of the verdict, and refined; returned as they are where there is no such effect, or more than one function.
    """
    learned = [each for each in node.hypotheses if isinstance(each, Learned)]
    if len(learned) != 1 or node.trial.is_of_time:
        return node, wider
    member = node.member(learned[0])
    for each in sorted(_instead(search, node, member), key=lambda each: -each.score):
        if not _is_mostly_its_formula(search, each, node, learned[0]):
            continue
        both, refined = (_beside(search, each.members[-1], one) for one in (node, wider))
        if both is not None and refined is not None:
            return both, refined
    return node, wider


def _instead(search: Search, node: Node, function: Member) -> list[Node]:
    """Return sets with an effect that lives in a function in place of it, behind the others."""
    others, known = node.without(function), known_for(search, [function.hypothesis.name])
    if not others:
        return [each for each in search.nodes if each.hypotheses in {(one,) for one in known}]
    found = []
    for each in known:
        if each not in node.hypotheses:
            with suppress(RunError):
                found.append(search.node((*others, Member(each)), near=node))
    return found


def _is_mostly_its_formula(search: Search, known: Node, node: Node, learned: Learned) -> bool:
    """Check for an effect that pushes what a function pushes, and whose formula explains most of what is missing.

    Beside others, of what these leave.
    """
    effect, form = known.hypotheses[-1], known.trial.forms[-1]
    assert isinstance(effect, Known)
    most = search.criteria.formula_most
    return (
        not known.trial.refused
        and form is not None
        and not form.is_odd
        and acts_there(search, effect, learned)
        and explained_by_formulas(search, known) >= most
        and (len(known.members) == 1 or explains_by_its_own(search, known, known.members[-1], most))
        and explains_nearly(search, known.trial.left, node.trial.left)
    )


def _beside(search: Search, known: Member, node: Node) -> Node | None:
    """Return a set with an effect besides, where that predicts as well; None where it does not."""
    try:
        trial = search.trials.of((known, *node.members), near=node.trial)
    except RunError:
        return None
    found = Node(trial, node.score + trial.log_evidence - node.trial.log_evidence)
    most = max(search.first_error(node.trial), search.criteria.predicted_to)
    if trial.refused or not predicts(search, found) or search.first_error(trial) > most:
        return None
    search.nodes.append(found)
    return found
