"""Learned functions tuned about the fit of their set: how smooth, how many splines, which period or time constant.

A hypothesis is chosen while all that is unexplained counts in part as noise (`Criteria.temper`), so that the most of it
is sought first. Once a set explains it, what is left is less by far, and asks for less smooth functions and more
splines, and for periods and time constants (`number.py`) that are right beside all else that was found.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.readings import Linear
from hexdbb.evidence.linear.screen import Scored, Screen
from hexdbb.evidence.linear.signatures import varying
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.search.number import with_best_number
from hexdbb.learned import Learned, has_chosen_number, number_of
from hexdbb.learned.places import EACH
from hexdbb.learned.variable import NUMBERED

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search


def around(search: Search, node: Node, member: Member) -> Linear:
    """Return the linearisation of a set without one of its functions, about the fit with it."""
    linear, model = search.trials.linear(node.trial), node.trial.model
    free = [each for each, is_free in zip(model.parameters(), model.free, strict=True) if is_free]
    mine = np.zeros(linear.own.shape[1], bool)
    mine[: len(free)] = [each.effect == member.hypothesis.name for each in free]
    return Linear(
        residual=linear.residual + linear.own[:, mine] @ linear.standing[mine],
        own=linear.own[:, ~mine],
        standing=linear.standing[~mine],
    )


def retunings(search: Search, node: Node, member: Member) -> Iterator[Member]:
    """Yield a member's function with other smoothness and splines: of those that predict best, the likeliest first.

    Parameters
    ----------
    search : Search
    node : Node
        Set that the member belongs to.
    member : Member
    """
    hypothesis = member.hypothesis
    if not isinstance(hypothesis, Learned) or not hypothesis.variable.is_smooth:
        return
    of_one = search.criteria.most_of_each if hypothesis.element == EACH else search.criteria.most_tuned
    most = max(of_one - axes_of(node) + member.axes, search.criteria.most_seen)
    scored = with_other_splines(search, around(search, node, member), hypothesis, node.trial.left, most)
    scored.sort(key=lambda each: each.log_evidence, reverse=True)
    # A free function of time predicts no other circle.
    if not node.trial.is_free_in_time:
        alike = search.criteria.predicts_alike * min(each.heldout_left for each in scored)
        scored.sort(key=lambda each: max(each.heldout_left, alike))
    yield from (search.member(each, most) for each in scored)


def more_splines(search: Search, node: Node, member: Member) -> Iterator[Member]:
    """Yield a member's function with the multiples of its splines that are looked at at once, whatever each gains."""
    function, criteria, readings = member.hypothesis, search.criteria, search.engine.readings
    assert isinstance(function, Learned)
    sums = Sums(around(search, node, member), readings, ("circle",))
    screen = Screen(sums, criteria, search.thinned, criteria.tuned_penalties, max(node.trial.left - 1.0, 0.0))
    for finer in varying([function.finer(times) for times in criteria.finer_at_once], readings):
        if finer.size <= criteria.most_tuned:
            yield search.member(screen.scored(finer), criteria.most_tuned)


def axes_of(node: Node) -> int:
    """Return the number of values that the learned functions of a set have in its fit."""
    return sum(each.axes for each in node.members)


def with_other_splines(
    search: Search, linear: Linear, hypothesis: Learned, left: float, most: int | None = None
) -> list[Scored]:
    """Score a hypothesis with every set of splines that a full fit can hold, over all penalties.

    Parameters
    ----------
    search : Search
    linear : Linear
        Without it.
    hypothesis : Learned
    left : float
        Mean square (noise variances) that is left with it, about.
    most : int, optional
        Splines that the fit can hold; `Criteria.most_tuned` where not given.
    """
    criteria, readings = search.criteria, search.engine.readings
    sums = Sums(linear, readings, ("circle",))
    screen = Screen(sums, criteria, search.thinned, criteria.tuned_penalties, max(left - 1.0, 0.0))
    variants = [*varying(hypothesis.variants(), readings)] or [hypothesis]
    held = [each for each in variants if each.size <= (most or criteria.most_tuned)]
    found: list[Scored] = []
    for each in held or variants[:1]:
        if not (_is_too_fine(found) and each.variable.count > variants[0].variable.count):
            found.append(screen.scored(each))
    return found


def _is_too_fine(found: list[Scored]) -> bool:
    """Check whether the last doubling of splines lost evidence: a further one would lose more, and takes long."""
    return len(found) > 1 and found[-1].log_evidence < found[-2].log_evidence


def with_numbers_of(search: Search, node: Node, wider: Node) -> Node:
    """Return a set with the periods and time constants that its functions have in a refined one: one name for each."""
    for hypothesis in node.hypotheses:
        if not isinstance(hypothesis, Learned) or hypothesis.name in wider.trial.names:
            continue
        others = (each.hypothesis for each in wider.members if each.hypothesis.name not in node.trial.names)
        same = (each for each in others if isinstance(each, Learned) and _is_renumbered(hypothesis, each))
        if (tuned := next(same, None)) is not None:
            moved = hypothesis.with_number(number_of(tuned.variable))
            search.count_as(moved, hypothesis)
            members = [replace(e, hypothesis=moved) if e.hypothesis == hypothesis else e for e in node.members]
            with suppress(RunError):
                node = search.node(members, near=node)
    return node


def _is_renumbered(one: Learned, other: Learned) -> bool:
    """Check for the same function by another number."""
    return has_chosen_number(one.variable) and one.name.partition(NUMBERED)[0] == other.name.partition(NUMBERED)[0]


def with_tuned_numbers(search: Search, node: Node) -> Node:
    """Return a set whose functions have the periods and time constants that fit best; the same set where none gains."""
    for hypothesis in node.hypotheses:
        trial = with_best_number(search, node.trial, hypothesis)
        if trial is not node.trial:
            node = Node(trial, node.score + trial.log_evidence - node.trial.log_evidence)
            search.nodes.append(node)
    return node
