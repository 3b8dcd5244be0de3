"""Refinement: how a machine's form differs from the learned functions that were found.

A cause is named by its main function; what that leaves is no other cause. The function gets more splines where the
readings ask for them, and functions of the other variables at its place stand beside it, chosen one by one to first
order, as long as what is left out is predicted better; all together are then fitted in full.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import islice

import numpy as np

from hexdbb.errors import RunError
from hexdbb.evidence.proposals import periods, proposals
from hexdbb.evidence.readings import Linear
from hexdbb.evidence.screen import Hypothesis, Known, Scored, Screen
from hexdbb.evidence.search import Node, Search
from hexdbb.evidence.signatures import all_varying, signature_of
from hexdbb.evidence.sums import Sums
from hexdbb.evidence.trial import Member
from hexdbb.evidence.tuned import retunings
from hexdbb.learned import ALL, Learned, part_of

TRIED = 2
"""Tunings of a function that get a full fit: what has the most evidence to first order may not predict."""


def refined(search: Search, node: Node) -> Node:
    """Return a set whose functions are fine enough, with others at the places of its causes beside them.

    Parameters
    ----------
    search : Search
    node : Node
        Of the verdict.
    """
    for _ in range(search.criteria.refinement_rounds):
        before = node
        if not _is_fine(search, node):
            node = _widened(search, _retuned(search, node))
        if node is before:
            break
    return node


def _is_fine(search: Search, node: Node) -> bool:
    """Check what is left and what is predicted; beside known effects alone a form of theirs stands already."""
    if all(isinstance(each, Known) for each in node.hypotheses):
        return node.trial.left < search.criteria.leaves_structure
    return node.trial.left < search.criteria.refined_to and not _error(search, node) > search.criteria.predicted_to


def _error(search: Search, node: Node) -> float:
    """Return the error of the first grouping that the functions claim to predict; nan where they claim none."""
    checked = search.checked(node)
    return next((held.after for name, held in checked.heldout.items() if name in checked.claimed), float("nan"))


def _retuned(search: Search, node: Node) -> Node:
    """Return a set whose learned functions have other splines or smoothness, where that gains and predicts well."""
    for place, member in enumerate(node.members):
        for tuned in islice(retunings(search, node, member), TRIED):
            members = (*node.members[:place], tuned, *node.members[place + 1 :])
            found = _tried(search, members, node, worth=0.0, enough=search.criteria.predicted_to)
            if found is not None:
                node = found
                break
    return node


def _widened(search: Search, node: Node) -> Node:
    chosen = [] if _is_fine(search, node) else _chosen(search, node)
    while chosen:
        found = _tried(search, (*node.members, *chosen), node, worth=search.criteria.detect_nats)
        if found is not None:
            return found
        chosen = chosen[: len(chosen) // 2]
    return node


def _tried(search: Search, members: tuple[Member, ...], node: Node, worth: float, enough: float = 0.0) -> Node | None:
    """Return the node of a set that gains as much as it must, and predicts better than another or well enough."""
    try:
        trial = search.trials.of(members)
    except RunError:
        return None
    gain = trial.log_evidence - node.trial.log_evidence
    found = Node(trial, node.score + gain)
    is_better = gain > worth and not trial.refused and not _error(search, found) >= max(_error(search, node), enough)
    return found if is_better else None


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
    """Return the functions at the places of the causes, those of single elements where a cause has all.

    What changes with time is no form of what does not.
    """
    places = {(part_of(each), each.element) for cause in node.hypotheses for each in _homes(search, cause)}
    known = {each.name for each in (*node.hypotheses, *chosen)}
    readings, criteria = search.engine.readings, search.criteria
    with_time = node.trial.is_free_in_time
    proposed = (
        proposals(linear, readings, search.thinned, criteria) if with_time else [*periods(linear, readings, criteria)]
    )
    search.propose(proposed)
    of_forms = all_varying(readings, of_forms=True)
    every = dict.fromkeys((*search.hypotheses, *of_forms, *(one.hypothesis for one in proposed)))
    return [
        each
        for each in every
        if ((part_of(each), each.element) in places or (part_of(each), ALL) in places)
        and each.name not in known
        and (with_time or not each.is_of_time)
    ]


def _homes(search: Search, cause: Hypothesis) -> list[Learned]:
    """Return the functions at whose places a cause acts."""
    if isinstance(cause, Learned):
        return [cause]
    by_name = search.by_name
    return [by_name[name] for name in search.kin.get(cause.name, set())]
