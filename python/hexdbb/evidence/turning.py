"""Functions that turn over with a direction of motion, but gradually: within how fast a motion is told by the readings.

Friction is not the same on both sides of a reversal from one reading to the next: grease shears, what is pressed turns
round first. A function times a direction then leaves most where its own motion is slow, at every reversal by another
amount, which no function of the way since the reversal describes beside it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hexdbb.errors import RunError
from hexdbb.evidence.node import Node
from hexdbb.evidence.number import with_best_number
from hexdbb.evidence.screen import Screen
from hexdbb.evidence.search import Search
from hexdbb.evidence.settling import leaves_no_structure
from hexdbb.evidence.sums import Sums
from hexdbb.evidence.trial import Member
from hexdbb.evidence.tuned import around
from hexdbb.learned import Learned, turning, turns_with

PARTS = (0.01, 0.03, 0.1, 0.3)
"""Rates within which a function may turn over, at first, in parts of the rate's root
mean square: below the first, hardly a reading of a circle's thousand is taken meanwhile; above the last it is a
function of the rate. They are a factor of three apart, of which tuning passes the half (`number.py`)."""


def with_turning(search: Search, node: Node) -> Node:
    """Return a set whose functions turn over as gradually as the readings ask for; the same set where they ask not.

    Parameters
    ----------
    search : Search
    node : Node
    """
    for place, member in enumerate(node.members):
        if not isinstance(member.hypothesis, Learned) or turns_with(member.hypothesis.variable) is None:
            continue
        if leaves_no_structure(search, node):
            break
        node = _turned(search, node, place, member)
    return node


def _turned(search: Search, node: Node, place: int, member: Member) -> Node:
    assert isinstance(member.hypothesis, Learned)
    gained, gradual = max(_scored(search, node, member, member.hypothesis), key=lambda each: each[0])
    if gained < search.criteria.detect_nats:
        return node
    turned = replace(member, hypothesis=gradual)
    try:
        trial = search.trials.of((*node.members[:place], turned, *node.members[place + 1 :]))
    except RunError:
        return node
    search.count_as(gradual, member.hypothesis)
    trial = with_best_number(search, trial, place)
    gain = trial.log_evidence - node.trial.log_evidence
    if gain < search.criteria.detect_nats or trial.refused:
        return node
    better = Node(trial, node.score + gain)
    search.nodes.append(better)
    return better


def _scored(search: Search, node: Node, member: Member, hypothesis: Learned) -> Iterator[tuple[float, Learned]]:
    """Yield a member's function as it turns over within some rates, with what it gains about the fit of the set."""
    readings, rate = search.engine.readings, turns_with(hypothesis.variable)
    assert rate is not None
    sums = Sums(around(search, node, member), readings, ("circle",))
    screen = Screen(sums, search.criteria, search.thinned, search.criteria.tuned_penalties, node.trial.left - 1.0)
    sharp = screen.scored(hypothesis).log_evidence
    rms = float(np.sqrt(np.mean(np.square(readings.state[rate]))))
    for part in PARTS:
        gradual = replace(hypothesis, variable=turning(hypothesis.variable, part * rms))
        yield screen.scored(gradual).log_evidence - sharp, gradual
