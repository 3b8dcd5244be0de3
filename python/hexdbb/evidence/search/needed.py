"""What a set of hypotheses needs: a hypothesis stays that is more than the forms of the others may leave."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.no_form import is_apart, is_no_form
from hexdbb.evidence.search.settling import (
    explained,
    explains_by_formulas,
    is_complete,
    is_doubtful,
    must_explain,
    of_forms,
    rests_on_form,
)

if TYPE_CHECKING:
    from hexdbb.evidence.fit.node import Node
    from hexdbb.evidence.fit.trial import Trial
    from hexdbb.evidence.forms.form import Form
    from hexdbb.evidence.search.search import Search


SLOW_DRIFTS = 3
"""Effects that can be made to cancel but for something else; two have not the freedom."""


def needs_all(search: Search, node: Node) -> bool:
    """Check that no hypothesis of a set could be left out, and that known effects together are what they explain."""
    # A set without a member that was fitted already costs nothing to ask, and one member too many settles it.
    first = sorted(node.members, key=lambda member: not search.trials.has(node.without(member)))
    return _are_of_size(search, node) and all(needs(search, node, member) for member in first)


def is_better(search: Search, node: Node, than: Node) -> bool:
    """Check that a set has more evidence than another, and explains more where it has more hypotheses.

    What many explain no better than few is no other explanation, whatever their priors make of it; unless the few are
    excused by their forms where the many predict, or explain by their forms what the many do by their formulas:
    functions free enough stand in for what is missing.
    """
    if len(node.members) == len(than.members) and is_complete(search, node) and is_complete(search, than):
        if by_formulas_instead(search, node, than.trial):
            return True
        if by_formulas_instead(search, than, node.trial):
            return False
    if node.score <= than.score:
        return False
    if node.faults <= than.faults or explains_more(search, node, than):
        return True
    return _instead(search, node, than.trial)


def by_formulas_instead(search: Search, node: Node, fewer: Trial) -> bool:
    """Check that known effects explain by their formulas, all but what forms may, what others do by their forms."""
    if not (node.is_known and rests_on_form(search, fewer)):
        return False
    least, left = of_forms(search, fewer), search.left_by_formulas(node.trial)
    return left - 1.0 < least <= search.left_by_formulas(fewer) - left


def _instead(search: Search, node: Node, fewer: Trial) -> bool:
    return _predict_instead(search, node, fewer) or by_formulas_instead(search, node, fewer)


def _predict_instead(search: Search, node: Node, fewer: Trial) -> bool:
    """Check that known effects predict, far better, what one misses, or fewer are only excused from by their forms."""
    missing = search.checked_trial(fewer)
    in_doubt = missing.excused or (len(fewer.members) == 1 and missing.missed > search.criteria.missed_sure)
    if not (node.is_known and in_doubt) or is_doubtful(search, node) or _is_of_its_element(search, node, fewer):
        return False
    return search.checked(node).missed < search.criteria.far_better * missing.missed


def _is_of_its_element(search: Search, node: Node, fewer: Trial) -> bool:
    """Check that what a set has more is known effects that push where one of the few does: they describe its form.

    Play of a slider beside its stiction, which dies away otherwise than by its formula, says how it does elsewhere.
    """
    few = [each.hypothesis for each in fewer.members if isinstance(each.hypothesis, Known)]
    more = [each for each in node.hypotheses if isinstance(each, Known) and each not in few]
    return bool(more) and all(any(push_one_element(search, each, one) for one in few) for each in more)


def push_one_element(search: Search, one: Known, other: Known) -> bool:
    """Check that two effects push the same element; of what is but one, as the gauge, each has its own law."""
    if one.is_whole or other.is_whole or {*one.elements}.isdisjoint(other.elements):
        return False
    ports = search.engine.absent.ports
    return not ports(one.effect).isdisjoint(ports(other.effect))


def explained_beyond(search: Search, trial: Trial, others: Trial) -> float:
    """Return what a set explains beyond others, in noise variances: of the readings, and of geometry bent for it."""
    return others.left - trial.left + search.trials.bent(others) - search.trials.bent(trial)


def explains_more(search: Search, node: Node, than: Node) -> bool:
    """Check that a set explains more than another by what a further effect must explain."""
    return explained_beyond(search, node.trial, than.trial) > must_explain(search, than.trial)


def best_of(search: Search, best: Node, others: Iterable[Node]) -> Node:
    """Return the best of some sets, each better than the one before."""
    for each in others:
        best = each if is_better(search, each, best) else best
    return best


def needs(search: Search, node: Node, member: Member) -> bool:
    """Check that a hypothesis is more than the forms of the others may leave, or that these alone do not predict.

    Nor do others predict that only their forms excuse, where all together are known effects that do.

    A free function describes whatever a form leaves: what it explains beyond the others counts. For a known effect its
    own size does, since other causes may stand in for most of it.

    Parameters
    ----------
    search : Search
    node : Node
        The set.
    member : Member
        The hypothesis in question.
    """
    criteria, trials = search.criteria, search.trials
    others = trials.of_fewer(node.without(member), node.trial)
    gain = node.trial.log_evidence - others.log_evidence + search.log_prior(member.hypothesis)
    beyond = explained_beyond(search, node.trial, others)
    if gain < criteria.detect_nats or is_form_alone(search, node, member, others):
        return False
    if _instead(search, node, others):
        return True
    if beyond < criteria.secondary * must_explain(search, others):
        return False
    least = of_forms(search, others)
    if beyond >= least or search.checked_trial(others).reasons:
        return True
    if not isinstance(member.hypothesis, Known):
        return is_apart(search, node, member)
    return _is_of_size(search, node, member.hypothesis, least) or is_no_form(search, node, member)


def is_form_alone(search: Search, node: Node, member: Member, others: Trial) -> bool:
    """Check for a known effect beside others of which the functions of its form explain nearly all: it is not there.

    A gauge that drifts stood so for a delay that changes over the test, by functions of time fourteen times as much as
    by its formula. Others that explain too little by theirs have taken what its formula would.
    """
    form = node.trial.forms[node.members.index(member)]
    if form is None or not form.columns or not others.members:
        return False
    if not explains_by_formulas(search, others):
        return False
    return not explains_by_its_formula(search, node, form, others, search.criteria.formula_least)


def explains_by_its_formula(search: Search, node: Node, form: Form, others: Trial, least: float) -> bool:
    """Check that an effect explains such a part of what it does beside others without the functions of its form."""
    by_formula = others.left - search.left_by_formula(node.trial, form)
    return by_formula >= least * (others.left - node.trial.left)


def has_form_alone(search: Search, node: Node) -> bool:
    """Check for a set with an effect of which the functions of its form explain nearly all."""
    return any(
        is_form_alone(search, node, each, search.trials.of_fewer(node.without(each), node.trial))
        for each in node.members
        if len(node.members) > 1 and isinstance(each.hypothesis, Known)
    )


def _is_of_size(search: Search, node: Node, known: Known, least: float) -> bool:
    """Check the size of a known effect; what pushes more than was missing is undone by another of the set."""
    sizes = _sizes(search, node)
    return least <= sizes[known] and max(sizes.values()) <= search.root.trial.left


def _are_of_size(search: Search, node: Node) -> bool:
    """Check that what several known effects push is neither mostly what geometry pushes too, nor undone by each other.

    Slow drifts that geometry stands in for can be made to cancel but for a step that none of them has.
    """
    sizes = _sizes(search, node)
    if len(sizes) < max(len(node.members), SLOW_DRIFTS):
        return True
    ratio = sum(sizes.values()) / max(explained(search, node.trial), 1e-9)
    return search.criteria.of_size <= ratio <= 1.0 / search.criteria.of_size


def _sizes(search: Search, node: Node) -> dict[Known, float]:
    return {each: search.trials.size(node.trial, each) for each in node.hypotheses if isinstance(each, Known)}
