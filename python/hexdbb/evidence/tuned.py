"""Learned functions tuned about the fit of their set: how smooth, how many splines, which period.

A hypothesis is chosen while all that is unexplained counts in part as noise (`Criteria.temper`), so that the most of it
is sought first. Once a set explains it, what is left is less by far, and asks for less smooth functions, more splines,
and a period that is right to a thousandth of a turn over all readings.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hexdbb.errors import RunError
from hexdbb.evidence.readings import Linear
from hexdbb.evidence.screen import Scored, Screen
from hexdbb.evidence.search import Node, Search
from hexdbb.evidence.signatures import signature_of, varying
from hexdbb.evidence.sums import Sums
from hexdbb.evidence.trial import Member
from hexdbb.learned import Learned, with_period

TURN_STEP = 0.02
"""Change of a period, in turns at the readings' ends, over which a function's change is taken: small against a turn,
large against the rounding of single precision."""
MOST_STEPS = 12.0
"""Such changes that a period may move by: a quarter of a turn, beyond which a line is no approximation of a wave."""


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


def with_tuned_periods(search: Search, node: Node) -> Node:
    """Return a set whose periodic functions have the periods that fit best; the same set where none gains."""
    for place, member in enumerate(node.members):
        if not isinstance(member.hypothesis, Learned) or not member.hypothesis.variable.has_chosen_period:
            continue
        tuned = _tuned(search, node, member, member.hypothesis)
        try:
            trial = search.trials.of((*node.members[:place], tuned, *node.members[place + 1 :]))
        except RunError:
            continue
        gain = trial.log_evidence - node.trial.log_evidence
        if gain > 0.0 and not trial.refused:
            node = Node(trial, node.score + gain)
            search.nodes.append(node)
    return node


def _tuned(search: Search, node: Node, member: Member, learned: Learned) -> Member:
    """Return a periodic member with its period moved by one step of Gauss and Newton."""
    assert member.factor is not None
    readings, model, period = search.engine.readings, node.trial.model, learned.variable.period
    step = TURN_STEP * period / max(float(np.ptp(readings.state[learned.variable.column])), period)
    mine = np.array([each.effect == learned.name for each in model.parameters()])
    coefficients = member.factor @ model.values[mine]
    ahead, behind = (
        signature_of(_with_period(learned, period * part), readings).table @ coefficients
        for part in (1.0 + step, 1.0 - step)
    )
    linear = search.trials.linear(node.trial)
    column = 0.5 * (ahead - behind)
    wider = replace(linear, own=np.column_stack([linear.own, column]), standing=np.append(linear.standing, 0.0))
    moved = float(Sums(wider, readings, ()).whole.own_values()[-1])
    found = _with_period(learned, period * (1.0 + step * float(np.clip(moved, -MOST_STEPS, MOST_STEPS))))
    search.count_as(found, learned)
    return replace(member, hypothesis=found)


def _with_period(learned: Learned, period: float) -> Learned:
    return replace(learned, variable=with_period(learned.variable, period))
