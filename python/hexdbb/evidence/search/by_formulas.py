"""What known effects explain each by its own formula: that is what they are, however far geometry leads away beside."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hexdbb.errors import RunError
from hexdbb.evidence.fit.admissible import errs_by_chance
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.readings import ARC
from hexdbb.evidence.linear.screen import Hypothesis
from hexdbb.evidence.search.needed import needs_all
from hexdbb.evidence.search.no_form import NOISE
from hexdbb.evidence.search.settling import errs_as_expected, explained_by_formulas, is_complete, predicts

if TYPE_CHECKING:
    from hexdbb.evidence.fit.node import Node
    from hexdbb.evidence.search.search import Search


def explain_by_own_formulas(search: Search, node: Node) -> bool:
    """Check for known effects that each explain by their own formula most of what they do, and of what others leave.

    Together they then explain enough: what is left is what several forms leave, one beside the other.
    """
    return _explain_so(search, node, search.criteria.own_formula, search.criteria.explained_min)


def explain_in_part(search: Search, node: Node) -> bool:
    """Check for known effects that together explain enough by formulas, and each a part of what the others leave."""
    return _explain_so(search, node, search.criteria.formula_names, search.criteria.explained_min)


def explain_nearly_all(search: Search, node: Node) -> bool:
    """Check for known effects that each explain by their own formula nearly all that they do, and together nearly all.

    Of what the others leave each explains enough: the rest of it may be what the others' formulas leave.
    """
    return _explain_so(search, node, search.criteria.form_explains, search.criteria.form_explains)


def are_what_they_are(search: Search, node: Node) -> bool:
    """Check for several known effects that need no second look: all needed, `explain_nearly_all`, err as expected."""
    if len(node.members) < 2 or node.trial.refused or not (is_complete(search, node) and predicts(search, node)):
        return False
    return errs_as_expected(search, node) and explain_nearly_all(search, node) and needs_all(search, node)


def _explain_so(search: Search, node: Node, each: float, together: float) -> bool:
    """Check for known effects that explain so much by their formulas: each of what it does, all of what is missing."""
    if not node.is_known or explained_by_formulas(search, node) < together:
        return False
    return all(explains_by_its_own(search, node, member, each) for member in node.members)


def explains_by_its_own(search: Search, node: Node, member: Member, least: float) -> bool:
    """Check for an effect of a set that explains so much of what it does by its own formula."""
    form = node.trial.forms[node.members.index(member)]
    try:
        others = search.trials.of(node.without(member)).left
    except RunError:
        return False
    explains = others - search.left_by_formula(node.trial, form)
    is_enough = explains >= min(least, search.criteria.own_formula) * (others - 1.0)
    return is_enough and explains >= least * (others - node.trial.left)


def are_no_form_of(search: Search, node: Node, hypothesis: Hypothesis) -> bool:
    """Check that all but one of a set are no form of that: each explains by its formula nearly all that is left.

    A sag of five times the noise beside a pitch error of thirty: the form of that could have been off by so much, but
    the sag's formula said nine tenths of the fifteen noise variances that it left.
    """
    others = [each for each in node.members if each.hypothesis != hypothesis]
    return 0 < len(others) < len(node.members) and all(_is_no_form(search, node, each) for each in others)


def _is_no_form(search: Search, node: Node, member: Member) -> bool:
    try:
        left = search.trials.of(node.without(member)).left
    except RunError:
        return False
    return left - 1.0 >= NOISE and explains_by_its_own(search, node, member, search.criteria.formula_leaves)


def err_by_geometry(search: Search, node: Node) -> bool:
    """Check for known effects, each by its own formula, whose error where left out geometry and chance make up.

    Where one hypothesis alone leaves no more than forms may, several are no simpler; but where it is one of them and
    the others are no form of it.
    """
    if not explain_by_own_formulas(search, node):
        return False
    alone = (each for each in search.nodes if len(each.members) == 1 and _is_another(search, each))
    if len(node.members) > 1 and not all(are_no_form_of(search, node, each.hypotheses[0]) for each in alone):
        return False
    held = search.checked(node).heldout
    base, left = search.root.trial, search.left_by_formulas(node.trial)
    left_out = [each for grouping, each in held.items() if grouping != ARC]
    return all(errs_by_chance(each, node.trial, base, left, search.criteria) for each in left_out)


def _is_another(search: Search, one: Node) -> bool:
    return is_complete(search, one) and not one.trial.refused
