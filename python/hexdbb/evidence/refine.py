"""Refinement: how a machine's form differs from the learned functions that were found.

A cause is named by its main function; what that leaves is no other cause. The function gets more splines where the
readings ask for them, and functions of the other variables at its place stand beside it, chosen one by one to first
order, as long as what is left out is predicted better; all together are then fitted in full.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from hexdbb.errors import RunError
from hexdbb.evidence.proposals import proposals
from hexdbb.evidence.readings import Linear
from hexdbb.evidence.screen import Hypothesis, Scored, Screen
from hexdbb.evidence.search import Node, Search
from hexdbb.evidence.signatures import signature_of, varying
from hexdbb.evidence.sums import Sums
from hexdbb.evidence.trial import Member
from hexdbb.learned import ALL, FINER, Learned


def refined(search: Search, node: Node) -> Node:
    """Return a set whose learned functions are fine enough, with others at their places beside them.

    Parameters
    ----------
    search : Search
    node : Node
        Of the verdict.
    """
    if not any(isinstance(each, Learned) for each in node.hypotheses) or _is_fine(search, node):
        return node
    return _widened(search, _finer(search, node))


def _is_fine(search: Search, node: Node) -> bool:
    return node.trial.left < search.criteria.refined_to


def _finer(search: Search, node: Node) -> Node:
    """Return a set whose learned functions have more splines, where that gains and predicts."""
    for place, member in enumerate(node.members):
        for each in _with_more_splines(search, member.hypothesis):
            others = [*node.members[:place], *node.members[place + 1 :]]
            screen = _screen(search, search.trials.linear(search.trials.of(others)))
            fine = search.member(screen.scored(each))
            found = _tried(search, (*node.members[:place], fine, *node.members[place + 1 :]), node)
            node = found or node
    return node


def _with_more_splines(search: Search, hypothesis: Hypothesis) -> Iterator[Learned]:
    if isinstance(hypothesis, Learned) and hypothesis.variable.is_smooth:
        yield from varying((hypothesis.finer(times) for times in FINER), search.engine.readings)


def _widened(search: Search, node: Node) -> Node:
    chosen = [] if _is_fine(search, node) else _chosen(search, node)
    while chosen:
        found = _tried(search, (*node.members, *chosen), node)
        if found is not None:
            return found
        chosen = chosen[: len(chosen) // 2]
    return node


def _tried(search: Search, members: tuple[Member, ...], node: Node) -> Node | None:
    """Return the node of a set where it gains and predicts better than another."""
    try:
        trial = search.trials.of(members)
    except RunError:
        return None
    gain = trial.log_evidence - node.trial.log_evidence
    found = Node(trial, node.score + gain)
    is_better = gain > search.criteria.detect_nats and not trial.refused and _predicts_better(search, found, node)
    return found if is_better else None


def _predicts_better(search: Search, one: Node, other: Node) -> bool:
    """Check that left-out groups are predicted better, each grouping that the functions claim to predict."""
    first, second = search.checked(one), search.checked(other)
    claimed = [name for name in first.heldout if name in first.claimed]
    return all(first.heldout[name].after < second.heldout[name].after for name in claimed[:1])


def _chosen(search: Search, node: Node) -> list[Member]:
    """Choose functions one by one on the linearisation of a set."""
    linear = search.trials.linear(node.trial)
    chosen: list[Member] = []
    while len(chosen) < search.criteria.most_refinements:
        if np.mean(linear.residual**2) < search.criteria.refined_to:
            break
        screen = _screen(search, linear)
        candidates = _at_the_places(search, node, [each.hypothesis for each in chosen], linear)
        worth = [each for each in screen.learned(candidates) if _is_asked_for(search, each)]
        if not worth:
            break
        best = max(worth, key=lambda each: (each.heldout_share, each.log_evidence))
        member = search.member(best)
        chosen.append(member)
        linear = _with(search, linear, member)
    return chosen


def _screen(search: Search, linear: Linear) -> Screen:
    return Screen(Sums(linear, search.engine.readings, ("circle",)), search.criteria, search.thinned)


def _is_asked_for(search: Search, scored: Scored) -> bool:
    assert isinstance(scored.hypothesis, Learned)
    gain = scored.log_evidence + search.log_prior(scored.hypothesis)
    return gain > search.criteria.detect_nats and (scored.heldout_share > 0.0 or scored.hypothesis.is_of_time)


def _with(search: Search, linear: Linear, member: Member) -> Linear:
    """Add a function to a linearisation's own values and take the step that it asks for."""
    assert isinstance(member.hypothesis, Learned) and member.factor is not None
    table = signature_of(member.hypothesis, search.engine.readings).table
    columns = table @ (member.factor * member.size_mm)
    wider = replace(
        linear,
        own=np.hstack([linear.own, columns]),
        standing=np.concatenate([linear.standing, np.zeros(columns.shape[1])]),
    )
    change = Sums(wider, search.engine.readings, ()).whole.own_values()
    return replace(wider, residual=wider.residual - wider.own @ change, standing=wider.standing + change)


def _at_the_places(search: Search, node: Node, chosen: Sequence[Hypothesis], linear: Linear) -> list[Learned]:
    """Return the functions at the places of the learned causes, those of single elements where a cause has all.

    What changes with time is no form of what does not.
    """
    causes = [each for each in node.hypotheses if isinstance(each, Learned)]
    places = {(each.place, each.element) for each in causes}
    known = {each.name for each in (*causes, *chosen)}
    proposed = proposals(linear, search.engine.readings, search.thinned, search.criteria)
    search.propose(proposed)
    every = dict.fromkeys((*search.hypotheses, *(one.hypothesis for one in proposed)))
    return [
        each
        for each in every
        if ((each.place, each.element) in places or (each.place, ALL) in places)
        and each.name not in known
        and (node.trial.is_free_in_time or not each.is_of_time)
    ]
