"""Smooth the change of sign of learned functions that depend on a direction of motion.

Friction does not change its sign from one reading to the next: it is a continuous function of a rate near zero
(regularised Coulomb friction). An abrupt function times a direction leaves a residual near each reversal, of a
different size at each, which no added function of the travel since the reversal describes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Screen
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.search.number import with_best_number
from hexdbb.evidence.search.settling import leaves_no_structure
from hexdbb.evidence.search.tuned import around
from hexdbb.learned import Learned, turning, turns_with

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

PARTS = (0.01, 0.03, 0.1, 0.3)
"""Initial transition rates, as parts of the rate's root mean square. Below the first, few readings of a circle lie in
the transition; above the last, the function is nearly proportional to the rate. Tuning changes a rate by a factor of
nearly two per step (`number.py`), so that values a factor of three apart reach any rate between."""


def with_turning(search: Search, node: Node, *, until_no_structure: bool = True) -> Node:
    """Return a set with smoothed changes of sign, if that increases the evidence; the same set otherwise.

    Parameters
    ----------
    search : Search
    node : Node
    until_no_structure : bool, optional
        Whether to stop where no structure is left: not where sets are compared, for one would be tuned further.
    """
    for hypothesis in node.hypotheses:
        if not isinstance(hypothesis, Learned) or turns_with(hypothesis.variable) is None:
            continue
        if until_no_structure and leaves_no_structure(search, node):
            break
        node = _turned(search, node, node.member(hypothesis))
    return node


def _turned(search: Search, node: Node, member: Member) -> Node:
    assert isinstance(member.hypothesis, Learned)
    gained, gradual = max(_scored(search, node, member, member.hypothesis), key=lambda each: each[0])
    if gained < search.criteria.detect_nats or gradual.name in node.trial.names:
        return node
    turned = replace(member, hypothesis=gradual)
    try:
        members = [turned if each is member else each for each in node.members]
        trial = search.trials.of(members, near=node.trial)
    except RunError:
        return node
    search.count_as(gradual, member.hypothesis)
    trial = with_best_number(search, trial, gradual)
    gain = trial.log_evidence - node.trial.log_evidence
    if gain < search.criteria.detect_nats or trial.refused:
        return node
    better = Node(trial, node.score + gain)
    search.nodes.append(better)
    return better


def _scored(search: Search, node: Node, member: Member, hypothesis: Learned) -> Iterator[tuple[float, Learned]]:
    """Yield a member's function with several transition rates, and the evidence gained by each."""
    readings, rate = search.engine.readings, turns_with(hypothesis.variable)
    assert rate is not None
    sums = Sums(around(search, node, member), readings, ("circle",))
    screen = Screen(sums, search.criteria, search.thinned, search.criteria.tuned_penalties, node.trial.left - 1.0)
    sharp = screen.scored(hypothesis).log_evidence
    rms = float(np.sqrt(np.mean(np.square(readings.state[rate]))))
    for part in PARTS:
        gradual = replace(hypothesis, variable=turning(hypothesis.variable, part * rms))
        yield screen.scored(gradual).log_evidence - sharp, gradual
