"""Whether a cause, small beside others, is more than their forms: it explains what these do not describe."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hexdbb.evidence.linear.screen import Hypothesis, Known, Screen
from hexdbb.evidence.linear.sums import Sums
from hexdbb.evidence.search.place import at_a_place_of_its_kin, functions_at
from hexdbb.evidence.search.settling import explained, explains_by_formulas
from hexdbb.learned import Learned
from hexdbb.learned.places import members

if TYPE_CHECKING:
    from hexdbb.evidence.fit.node import Node
    from hexdbb.evidence.fit.trial import Member, Trial
    from hexdbb.evidence.search.search import Search

NOISE = 1.0
"""Mean square of the noise, in its variances: what explains less beside others is too small to be told from a form."""


def is_no_form(search: Search, node: Node, member: Member) -> bool:
    """Check that a known effect explains, by its formula, more than the forms of the others may leave undescribed.

    That is: more than these are seen to be off, or nearly all that they leave, or far more than any function at their
    own places does.

    Parameters
    ----------
    search : Search
    node : Node
        The set.
    member : Member
        The effect of the set.
    """
    criteria = search.criteria
    if len(node.members) < 2:
        return False
    others = search.trials.of(node.without(member))
    beyond, left = others.left - node.trial.left, others.left - 1.0
    if beyond < NOISE or _by_formula(search, node, member, others) < criteria.formula_explains * beyond:
        return False
    if beyond >= criteria.form_explains * left or beyond >= _seen(search, node, member):
        return True
    return beyond >= criteria.no_form * left * _explained_at_their_places(search, others)


def is_apart(search: Search, node: Node, member: Member) -> bool:
    """Check that a function beside known effects is no form of theirs: it is elsewhere, and explains most of the rest.

    A battery that sags every ten seconds is no form of a slider's lag, however much smaller. It explains far more than
    any function at the effects' own places does.

    Parameters
    ----------
    search : Search
    node : Node
        The set.
    member : Member
        The function of the set.
    """
    criteria, learned = search.criteria, member.hypothesis
    others = search.trials.of(node.without(member))
    causes = [each.hypothesis for each in others.members]
    if not isinstance(learned, Learned) or not causes or not all(isinstance(each, Known) for each in causes):
        return False
    if any(is_near(search, each, learned) for each in causes):
        return False
    beyond, left = others.left - node.trial.left, others.left - 1.0
    if beyond < max(NOISE, criteria.apart * left):
        return False
    return beyond >= criteria.no_form * left * _explained_at_their_places(search, others)


def is_near(search: Search, cause: Hypothesis, learned: Learned) -> bool:
    """Check whether a function acts where a cause does, or at a slider, a joint or a leg of the same number.

    What lifts the joint of a slider after reversals leaves a spike of that slider.
    """
    numbers = {str(each) for each in members(learned.element)}
    of_its_number = isinstance(cause, Known) and not (cause.is_whole or numbers.isdisjoint(cause.elements))
    return of_its_number or at_a_place_of_its_kin(search, cause, learned)


def _by_formula(search: Search, node: Node, member: Member, others: Trial) -> float:
    """Return what an effect explains by its formula: of what the others leave by theirs, where these explain enough.

    Where they do not, as of a bow that geometry imitates but for its form, nothing can be told without their forms.
    """
    if explains_by_formulas(search, others):
        return search.left_by_formulas(others) - search.left_by_formulas(node.trial)
    form = node.trial.forms[node.members.index(member)]
    return others.left - (node.trial.left if form is None else search.left_by_formula(node.trial, form))


def _seen(search: Search, node: Node, member: Member) -> float:
    """Return what forms may leave undescribed that are seen to be off, beside what is asked for, by so much.

    What is learned has no form that could be seen, and may leave what forms may.
    """
    criteria = search.criteria
    forms = [form for each, form in zip(node.members, node.trial.forms, strict=True) if each is not member]
    off = max(criteria.form_sigma if form is None else form.deviation for form in forms)
    return criteria.secondary * max(off, criteria.form_described) ** 2 * explained(search, node.trial)


def _explained_at_their_places(search: Search, trial: Trial) -> float:
    """Return the largest part of what causes leave that a function at their own places explains."""
    linear = search.trials.linear(trial)
    screen = Screen(Sums(linear, search.engine.readings, ()), search.criteria, search.thinned)
    return screen.most_explained(functions_at(search, trial, linear))
