"""A function of a position that repeats, in place of a free one: it says more, and holds where no reading was."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.proposals.periods import periods
from hexdbb.evidence.search.number import with_best_number
from hexdbb.evidence.search.settling import predicts
from hexdbb.evidence.search.tuned import around
from hexdbb.learned import Learned

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

COLUMN = "sliders_mm"


def with_periods(search: Search, node: Node) -> Node:
    """Return a set with functions that repeat in place of free ones of a position, where that has more evidence.

    Beside what else is missing, the strongest period of the readings is seldom that of a waving guideway, and splines
    were found for it: they fit as well, with ten times the values, and say nothing of positions that were not driven.

    Parameters
    ----------
    search : Search
    node : Node
    """
    for member in node.members:
        if _is_free(member.hypothesis):
            node = max(_instead(search, node, member), key=lambda each: each.score, default=node)
    return node


def _is_free(hypothesis: object) -> bool:
    """Check for a function of a slider's position alone that does not repeat."""
    if not isinstance(hypothesis, Learned):
        return False
    variable = hypothesis.variable
    return variable.column == COLUMN and variable.is_smooth and not (variable.times or variable.period)


def _instead(search: Search, node: Node, member: Member) -> Iterator[Node]:
    """Yield the sets in which a function with one of the strongest periods replaces a member, if they are better."""
    free = member.hypothesis
    assert isinstance(free, Learned)
    linear = around(search, node, member)
    found = periods(
        linear,
        search.engine.readings,
        search.criteria,
        lambda each: (each.place, each.element, each.variable.column) == (free.place, free.element, COLUMN),
        aslant=True,
    )
    proposed = list(found)
    search.learnable.propose(proposed)
    screen = search.screen(search.node(node.without(member), near=node))
    for each in proposed:
        repeated = search.member(screen.scored(each.hypothesis))
        try:
            members = [repeated if one is member else one for one in node.members]
            trial = with_best_number(search, search.trials.of(members, near=node.trial), each.hypothesis)
        except RunError:
            continue
        prior = search.log_prior(each.hypothesis) - search.log_prior(free)
        gain = trial.log_evidence - node.trial.log_evidence + prior
        better = Node(trial, node.score + gain)
        if gain > search.criteria.detect_nats and not trial.refused and predicts(search, better):
            search.nodes.append(better)
            yield better
