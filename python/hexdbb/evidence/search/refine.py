"""Refinement: how a machine's form differs from the learned functions that were found.

A cause is named by its main function; what that leaves is no other cause. The function gets more splines where the
readings ask for them, and functions of the other variables at its place stand beside it, one by one, each fitted in
full, as long as what is left out is predicted better.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import islice
from typing import TYPE_CHECKING

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.linear.readings import Linear
from hexdbb.evidence.linear.screen import Known, Scored
from hexdbb.evidence.search.place import Places, functions_at
from hexdbb.evidence.search.tuned import axes_of, more_splines, retunings, with_other_splines, with_tuned_numbers
from hexdbb.evidence.search.turning import with_turning
from hexdbb.learned import Learned, part_of
from hexdbb.learned.directed import is_directed

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

TRIED = 2
"""Tunings of a function that get a full fit: what has the most evidence to first order may not predict."""
ENOUGH = 0.8
"""Part of what a further function must explain that it must explain to first order to be fitted in full: about a fit,
first order is off by less than a fifth."""


def refined(search: Search, node: Node) -> Node:
    """Return a set whose functions are fine enough, with others at the places of its causes beside them.

    Parameters
    ----------
    search : Search
    node : Node
        Of the verdict; returned as it is where the search looks at no learned functions.
    """
    if not search.learns:
        return node
    for _ in range(search.criteria.refinement_rounds):
        before = node
        if not _is_fine(search, node):
            node = _widened(search, with_tuned_numbers(search, with_best_splines(search, node)))
        if node is before:
            break
    return node


def refined_forms(search: Search) -> Node:
    """Return the functions that describe the forms of the effects of the model, where no other cause is missing."""
    if not search.learns:
        return search.root
    homes = [each for homes in search.present.values() for each in homes]
    return _widened(search, search.root, {(part_of(each), each.element) for each in homes})


def _is_fine(search: Search, node: Node) -> bool:
    """Check what is left and what is predicted; beside known effects alone a form of theirs stands already."""
    if all(isinstance(each, Known) for each in node.hypotheses):
        return node.trial.left < search.criteria.leaves_structure
    return node.trial.left < search.criteria.refined_to and not _error(search, node) > search.criteria.predicted_to


def _error(search: Search, node: Node) -> float:
    """Return the error of the first grouping that the functions claim to predict; nan where they claim none."""
    return search.first_error(node.trial)


def with_best_splines(search: Search, node: Node) -> Node:
    """Return a set whose learned functions have other splines or smoothness, where that gains and predicts well."""
    for hypothesis in node.hypotheses:
        member = node.member(hypothesis)
        for tuned in islice(retunings(search, node, member), TRIED):
            members = tuple(tuned if each is member else each for each in node.members)
            fitted = partial(search.trials.of, members, node.trial)
            found = _if_better(search, fitted, node, worth=0.0, enough=search.criteria.predicted_to)
            if found is not None:
                node = found
                break
    return node


def finely_tuned(search: Search, node: Node) -> Node:
    """Return a set whose learned functions turn over as gradually, and have the splines and numbers, that fit best."""
    node = with_best_splines(search, with_turning(search, node, until_no_structure=False))
    node = _with_finer_along(search, with_tuned_numbers(search, node))
    return with_turning(search, node, until_no_structure=False)


def _with_finer_along(search: Search, node: Node) -> Node:
    """Return a set whose function along a direction has more splines, and the direction that these ask for.

    A step is no sharper along a direction that is a few degrees off, and with few splines a direction beside the true
    one fits best: neither says that the other should change.
    """
    for member in node.members:
        function = member.hypothesis
        is_along = isinstance(function, Learned) and is_directed(function.variable) and not function.variable.is_coarse
        if not is_along or node.trial.left < search.criteria.refined_to:
            continue
        for finer in more_splines(search, node, member):
            members = tuple(finer if each is member else each for each in node.members)
            try:
                along = with_tuned_numbers(search, search.node(members, near=node))
            except RunError:
                continue
            if _better(search, along.trial, node, worth=0.0, enough=search.criteria.predicted_to) is not None:
                return along
    return node


def _widened(search: Search, node: Node, places: Places | None = None) -> Node:
    """Return a set with further functions at some places, added one by one, each fitted in full.

    The places are those of its causes where none are given.
    """
    for _ in range(search.criteria.most_refinements):
        is_enough = _is_fine(search, node) or axes_of(node) >= search.criteria.most_tuned
        wider = None if is_enough else _with_one_more(search, node, places)
        if wider is None:
            break
        node = wider
    return node


def _with_one_more(search: Search, node: Node, places: Places | None) -> Node | None:
    """Return a set with the function that explains most of what is left, if that is much; None where none does."""
    linear = search.trials.linear(node.trial)
    screen = search.screen(node)
    worth = [
        each for each in screen.learned(functions_at(search, node.trial, linear, places)) if _is_asked_for(search, each)
    ]
    variables = {each.variable.name for each in node.hypotheses if isinstance(each, Learned)}
    share = _least_share(search, node)
    most = 1.0 + (1.0 - share) * (node.trial.left - 1.0)
    by_evidence = sorted(worth, key=lambda each: -each.log_evidence)
    # Elements that differ in what all have alike are the simplest form, though others may seem to explain more; then
    # what is no product of two states.
    of_elements = [each for each in by_evidence if _variable(each) in variables]
    simple = [each for each in by_evidence if each.hypothesis in search.learnable.simple]
    done: set[Scored] = set()
    for tried in (of_elements[:1], _best_two(simple), _best_two(by_evidence)):
        sets = [_with(search, node, linear, each, share) for each in tried if each not in done]
        done.update(tried)
        fits = search.trials.each_of(filter(None, sets), node.trial)
        found = (_if_better(search, each, node, worth=search.criteria.detect_nats) for each in fits)
        good = [each for each in found if each is not None and each.trial.left < most]
        if good:
            return max(good, key=lambda each: each.score)
    return None


def _least_share(search: Search, node: Node) -> float:
    """Return the part of what is left beyond the noise that a further function must explain.

    As much as leaves no structure with twice as many such functions as a set may have: what explains less where much is
    left describes another cause than the one that was found, and takes most of a search's time.
    """
    criteria = search.criteria
    nothing = criteria.leaves_structure - 1.0
    kept: float = (nothing / max(node.trial.left - 1.0, nothing)) ** (0.5 / criteria.most_refinements)
    return max(criteria.refined_by, 1.0 - kept)


def _best_two(by_evidence: list[Scored]) -> list[Scored]:
    """Return what has the most evidence and what predicts best, of several in the order of their evidence."""
    by_share = sorted(by_evidence, key=lambda each: -each.heldout_share)
    return list(dict.fromkeys((*by_evidence[:1], *by_share[:1])))


def _variable(scored: Scored) -> str:
    assert isinstance(scored.hypothesis, Learned)
    return scored.hypothesis.variable.name


def _with(search: Search, node: Node, linear: Linear, scored: Scored, share: float) -> tuple[Member, ...] | None:
    """Return a set with a function of the best splines; None where it explains far less to first order than it must."""
    assert isinstance(scored.hypothesis, Learned)
    variants = with_other_splines(search, linear, scored.hypothesis, node.trial.left, search.criteria.most_seen)
    best = max(variants, key=lambda each: each.log_evidence)
    if best.share < ENOUGH * share:
        return None
    return (*node.members, search.member(best))


def _if_better(
    search: Search, fitted: Callable[[], Trial], node: Node, worth: float, enough: float = 0.0
) -> Node | None:
    """Return the node of a set that gains as much as it must, and predicts better than another, or well enough."""
    try:
        trial = fitted()
    except RunError:
        return None
    return _better(search, trial, node, worth, enough)


def _better(search: Search, trial: Trial, node: Node, worth: float, enough: float) -> Node | None:
    """Return the node of a trial, where it gains and predicts so."""
    gain = trial.log_evidence - node.trial.log_evidence
    found = Node(trial, node.score + gain)
    is_better = gain > worth and not trial.refused and _errs_no_more(search, found, node, enough)
    return found if is_better and _predicts_as_well(search, trial, node.trial) else None


def _errs_no_more(search: Search, found: Node, node: Node, enough: float) -> bool:
    """Check that a set errs less than another on the first grouping that it claims, or little enough.

    A grouping that only this one determines was not what the other claimed: it is better there where it errs less, and
    then the groupings that both determine are asked.
    """
    if not _error(search, found) >= max(_error(search, node), enough):
        return True
    own, others = search.checked_trial(found.trial).heldout, search.checked_trial(node.trial).heldout
    most, shared = search.criteria.extrapolates, [each for each in own if each in others]
    determined = [each for each in shared if own[each].expected <= most]
    new = [each for each in determined if others[each].expected > most]
    asked = [*new, *(each for each in determined if each not in new)][: len(new) + 1]
    return bool(new) and all(own[each].after < max(others[each].after, enough) for each in asked)


def _predicts_as_well(search: Search, trial: Trial, before: Trial) -> bool:
    """Check that groupings which others determine still are, or err no more, and are predicted about as well as before.

    Fine functions may follow one lap and say little of others. The first grouping is compared closely by whoever asks;
    here an error as many times larger (`Criteria.heldout_ratio`) counts. Free functions of time predict none.
    """
    if trial.is_free_in_time:
        return True
    criteria, held = search.criteria, search.checked_trial(trial).heldout
    return all(
        (held[grouping].expected <= criteria.extrapolates or held[grouping].after <= was.after)
        and held[grouping].after <= max(criteria.heldout_ratio * was.after, criteria.predicted_to)
        for grouping, was in search.checked_trial(before).heldout.items()
        if grouping in held and was.expected <= criteria.extrapolates
    )


def _is_asked_for(search: Search, scored: Scored) -> bool:
    assert isinstance(scored.hypothesis, Learned)
    gain = scored.log_evidence + search.log_prior(scored.hypothesis)
    least = search.criteria.refined_heldout_min
    return gain > search.criteria.detect_nats and (scored.heldout_share > least or scored.hypothesis.is_of_time)
