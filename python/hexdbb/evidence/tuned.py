"""Learned functions tuned about the fit of their set: how smooth, how many splines, which period or time constant.

A hypothesis is chosen while all that is unexplained counts in part as noise (`Criteria.temper`), so that the most of it
is sought first. Once a set explains it, what is left is less by far, and asks for less smooth functions and more
splines, and for periods and time constants (`number.py`) that are right beside all else that was found.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hexdbb.evidence.node import Node
from hexdbb.evidence.number import with_best_number
from hexdbb.evidence.readings import Linear
from hexdbb.evidence.screen import Scored, Screen
from hexdbb.evidence.search import Search
from hexdbb.evidence.signatures import varying
from hexdbb.evidence.sums import Sums
from hexdbb.evidence.trial import Member
from hexdbb.learned import Learned


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
    """Yield a member's function with other smoothness and splines, the one that predicts best first.

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
    scored = with_other_splines(search, around(search, node, member), hypothesis, node.trial.left)
    # A free function of time predicts no other circle.
    by_share = not node.trial.is_free_in_time
    scored.sort(key=lambda each: each.heldout_share if by_share else each.log_evidence, reverse=True)
    yield from map(search.member, scored)


def with_other_splines(search: Search, linear: Linear, hypothesis: Learned, left: float) -> list[Scored]:
    """Score a hypothesis with every set of splines that a full fit can hold, over all penalties.

    Parameters
    ----------
    search : Search
    linear : Linear
        Without it.
    hypothesis : Learned
    left : float
        Mean square (noise variances) that is left with it, about.
    """
    criteria, readings = search.criteria, search.engine.readings
    sums = Sums(linear, readings, ("circle",))
    screen = Screen(sums, criteria, search.thinned, criteria.tuned_penalties, max(left - 1.0, 0.0))
    variants = [*varying(hypothesis.variants(), readings)] or [hypothesis]
    held = [each for each in variants if each.components * each.variable.columns <= criteria.most_seen]
    return [screen.scored(each) for each in held or variants[:1]]


def with_tuned_numbers(search: Search, node: Node) -> Node:
    """Return a set whose functions have the periods and time constants that fit best; the same set where none gains."""
    for place in range(len(node.members)):
        trial = with_best_number(search, node.trial, place)
        if trial is not node.trial:
            node = Node(trial, node.score + trial.log_evidence - node.trial.log_evidence)
            search.nodes.append(node)
    return node
