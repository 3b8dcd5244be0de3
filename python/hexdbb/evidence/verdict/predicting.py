"""Sets that predict what was left out, in place of those that only fit."""

from __future__ import annotations

from collections.abc import Mapping

from hexdbb.evidence.fit.admissible import missed_of
from hexdbb.evidence.fit.heldout import HeldOut
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.linear.readings import ARC
from hexdbb.evidence.search.needed import has_form_alone
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import explained_by_formulas, is_complete, is_doubtful, leaves_no_structure
from hexdbb.evidence.search.sure import is_for_sure


def or_another_that_predicts(search: Search, node: Node) -> Node:
    """Prefer another set that explains nearly all and predicts to one that does not.

    A single cause gives way to one of another kind; of several, some may be right. One that is for sure although it
    errs where geometry leads away gives way to nothing that fits worse: what is freer only expects to err more. Known
    effects that explain nearly all by their formulas do not give way to others that explain less by theirs. Nothing
    gives way to what errs more on the readings left out for which it is doubted: that claims less, and is no better. A
    function that leaves no structure gives way to nothing that leaves some: what errs is geometry.
    """
    if not is_doubtful(search, node):
        return node
    is_sure = is_for_sure(search, node)
    is_one = len(node.members) == 1
    doubted = _doubted(search, node)
    others = [
        each
        for each in search.nodes
        if len(each.members) <= len(node.members)
        and not each.trial.refused
        and not (is_one and any(search.same_kind(one, other) for one in each.hypotheses for other in node.hypotheses))
        and not (is_sure and each.score < node.score - search.criteria.margin_nats)
        and not _explains_less_by_formulas(search, each, node)
        and not _leaves_structure_where(search, each, node)
    ]
    # The best first: what lies behind it need not be held out.
    others.sort(key=lambda each: -each.score)
    found = (e for e in others if _explains_and_predicts(search, e) and _errs_no_more(search, e, doubted))
    return next((each for each in found if not has_form_alone(search, each)), node)


def or_a_state_that_predicts(search: Search, node: Node) -> Node:
    """Return a function of a state that explains nearly all and predicts, in place of one free function of time.

    What drifts in hundreds of splines has more evidence than any law that is not quite right, and claims nothing: what
    else was left out and is predicted all the same, other feeds among it, is no chance.
    """
    if len(node.members) != 1 or not node.trial.is_free_in_time:
        return node
    others = [each for each in search.nodes if len(each.members) == 1 and not (each.is_known or each.trial.refused)]
    others.sort(key=lambda each: -each.score)
    return next((each for each in others if is_complete(search, each) and _explains_and_predicts(search, each)), node)


def _doubted(search: Search, node: Node) -> dict[str, HeldOut]:
    """Return how a set predicts the groupings in which it misses about as much as all that it explains."""
    base, criteria = search.root.trial, search.criteria
    return {
        grouping: held
        for grouping, held in search.checked(node).heldout.items()
        if grouping != ARC and missed_of(held, held.after, node.trial, base, criteria) > criteria.missed_most
    }


def _errs_no_more(search: Search, other: Node, doubted: Mapping[str, HeldOut]) -> bool:
    """Check that a set errs no more than another in some groupings; what it does not claim it leaves as it was."""
    own = search.checked(other).heldout
    return all(
        (own[grouping].after if grouping in own else held.before) <= held.after for grouping, held in doubted.items()
    )


def _leaves_structure_where(search: Search, other: Node, node: Node) -> bool:
    """Check for a set that leaves structure, where another, of one learned function, leaves none."""
    is_function = len(node.members) == 1 and not node.is_known
    return is_function and leaves_no_structure(search, node) and not leaves_no_structure(search, other)


def _explains_less_by_formulas(search: Search, other: Node, node: Node) -> bool:
    """Check for known effects whose formulas explain less than those of several that explain nearly all by theirs."""
    if len(node.members) < 2 or not (node.is_known and other.is_known):
        return False
    if explained_by_formulas(search, node) < search.criteria.form_explains:
        return False
    return search.left_by_formulas(other.trial) > search.left_by_formulas(node.trial)


def _explains_and_predicts(search: Search, node: Node) -> bool:
    excess = search.root.trial.left - 1.0
    if search.root.trial.left - node.trial.left <= search.criteria.form_explains * excess:
        return False
    # A free function of time claims nothing of what was left out, and so predicts nothing of it either.
    return not (node.trial.is_free_in_time or search.checked(node).reasons or is_doubtful(search, node))


def or_one_that_predicts(search: Search, node: Node) -> Node:
    """Return one hypothesis that predicts all that was left out better than a set which is not for sure; else the set.

    It must explain nearly all alone. What the set explains beyond that it explains only where fitted.
    """
    if len(node.members) < 2 or is_for_sure(search, node):
        return node
    most = search.root.trial.left - search.criteria.form_explains * (search.root.trial.left - 1.0)
    alone = [e for e in search.nodes if len(e.members) == 1 and not e.trial.refused and e.trial.left < most]
    alone.sort(key=lambda each: -each.score)
    return next((each for each in alone if predicts_better(search, each, node)), node)


def or_fewer_by_formulas(search: Search, node: Node) -> Node:
    """Return fewer known effects whose formulas explain as much as those of a set, and predict better; else the set.

    They must explain nearly all. What the set leaves less is explained by the functions of its forms, which of slow
    drifts at six screws are free enough for anything.
    """
    if not node.is_known or len(node.members) < 2:
        return node
    fewer = [each for each in search.nodes if each.faults < node.faults and not each.trial.refused]
    fewer.sort(key=lambda each: (each.faults, -each.score))
    return next((each for each in fewer if stand_before(search, each, node)), node)


def stand_before(search: Search, fewer: Node, more: Node) -> bool:
    """Check for fewer known effects that explain nearly all, by their formulas as much as more, and predict better.

    Or predict, each of its own form, where one of more is of quite another: two spikes after reversals were play of
    both sliders, of forms a third off, beside a drive that lags by nothing.
    """
    if not (fewer.is_known and more.is_known and fewer.faults < more.faults):
        return False
    most = search.root.trial.left - search.criteria.form_explains * (search.root.trial.left - 1.0)
    if fewer.trial.left >= most or search.left_by_formulas(fewer.trial) > search.left_by_formulas(more.trial):
        return False
    if any(map(_is_odd, more.trial.forms)) and not any(map(_is_odd, fewer.trial.forms)):
        least = search.criteria.form_explains
        return explained_by_formulas(search, fewer) >= least and not search.checked(fewer).reasons
    return predicts_better(search, fewer, more)


def _is_odd(form: Form | None) -> bool:
    return form is not None and form.is_odd


def predicts_better(search: Search, one: Node, several: Node) -> bool:
    """Check that a set errs less than another in every grouping that this claims to predict."""
    checked, others = search.checked(one), search.checked(several).heldout
    claimed = [grouping for grouping in others if grouping != ARC]
    if checked.reasons or not claimed or any(grouping not in checked.heldout for grouping in claimed):
        return False
    return all(
        checked.heldout[grouping].as_fitted / checked.heldout[grouping].before
        < others[grouping].as_fitted / others[grouping].before
        for grouping in claimed
    )
