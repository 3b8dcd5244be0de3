"""Other explanations of what a cause explains: sets without it that fit as well, and predict as well."""

from __future__ import annotations

from dataclasses import dataclass

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import NOTHING_LEFT
from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.search.needed import by_formulas_instead, explains_more
from hexdbb.evidence.search.place import at_a_place_of_its_kin
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import missed
from hexdbb.evidence.search.sure import is_for_sure, misses_only_geometry
from hexdbb.evidence.verdict.elsewhere import rivals_elsewhere
from hexdbb.evidence.verdict.one_state import of_one_state
from hexdbb.evidence.verdict.predicting import predicts_better, stand_before
from hexdbb.evidence.verdict.rivals_of_several import better_by_formula, of_one_size, one_instead
from hexdbb.evidence.verdict.without import acts_where_they_do, has_effect, has_kind, sets_without
from hexdbb.learned import Learned


@dataclass(frozen=True)
class Rivals:
    """Names of sets that explain the readings as well.

    Attributes
    ----------
    others : tuple of str
        Of another kind than the cause.
    alike : tuple of str
        The same effect at other elements.
    margin : float
        Log evidence over the best set that has none of the cause's kind, over what the chosen set leaves.
    """

    others: tuple[str, ...]
    alike: tuple[str, ...]
    margin: float


def rivals_of(search: Search, node: Node, cause: Hypothesis) -> Rivals:
    """Return the rivals of a cause of the chosen set."""
    others: list[str] = []
    alike: list[str] = []
    margin = float("inf")
    for other, lead in sets_without(search, node, cause):
        is_close = lead < search.criteria.margin_nats and other is not search.root
        is_known_too = has_effect(other, cause)
        # The best come first: what lies behind the margin found need not be held out.
        if not (is_close or lead < margin) or not _is_rival(search, other, node, lead):
            continue
        if len(other.members) > len(node.members) and _describe(search, other, cause):
            continue
        if _has_functions_more(search, other, node):
            continue
        if len(other.members) == 1 and len(node.members) > 1 and acts_where_they_do(search, other, node):
            continue
        if is_close:
            (alike if is_known_too else others).append(" + ".join(other.trial.names))
        if not is_known_too:
            margin = min(margin, lead)
    form = node.trial.forms[node.hypotheses.index(cause)]
    if form is not None and form.is_odd:
        others += _nearly_as_good(search, node, cause, form)
    if isinstance(cause, Known) and len(node.members) == 1:
        others += _errs_no_more(search, node, cause)
    if form is not None and len(node.members) == 1:
        others += _lenders(search, node, cause, form)
    if node.is_known and len(node.members) > 1:
        others += better_by_formula(search, node, cause)
        others += one_instead(search, node, cause)
        others += of_one_size(search, node, cause)
    if isinstance(cause, Known):
        others += rivals_elsewhere(search, node, cause, alike)
        others += of_one_state(search, node, cause)
        others = [each for each in others if each not in _the_same_elsewhere(node, cause)]
    return Rivals(tuple(dict.fromkeys(others)), tuple(dict.fromkeys(alike)), margin)


def _the_same_elsewhere(node: Node, cause: Known) -> set[str]:
    """Return the same effect at the set's other elements: they are causes themselves, none is another explanation.

    By its form, which follows every circle, a ball that sits otherwise in one of three set-ups says what both do.
    """
    known = (each for each in node.hypotheses if isinstance(each, Known))
    return {each.name for each in known if each.effect == cause.effect and each != cause}


def _has_it_elsewhere(other: Node, node: Node, cause: Hypothesis) -> bool:
    """Check for a set of more causes that has the effect at another element: it says so too, and something besides."""
    return len(other.members) > len(node.members) and has_effect(other, cause)


def _is_rival(search: Search, other: Node, node: Node, lead: float) -> bool:
    """Check that a set is another explanation, against which nothing speaks that does not against the chosen one.

    That there is nothing to explain is one too, by which a lead is told where there is no other.
    """
    if other is search.root:
        return True
    # What it explains by its forms, where the chosen one does by its formulas, is none however much evidence it has.
    if by_formulas_instead(search, node, other.trial) or stand_before(search, node, other):
        return False
    is_ahead = lead < -search.criteria.margin_nats
    reasons = set(search.checked(other).reasons)
    # What the chosen one is excused from, circles that its form does not predict, refutes no set that fits better.
    if is_ahead and reasons and reasons <= set(search.checked(node).excused_from):
        return not _is_bent(search, other)
    # Nor do circles that geometry does not predict, of the same effect at another element.
    if is_ahead and _errs_where_geometry_does(search, other, node):
        return not _is_bent(search, other)
    if reasons or _is_bent(search, other):
        return False
    # What fits better and errs less on everything that was left out is one, for sure itself or not.
    if is_ahead and len(other.members) <= len(node.members) and predicts_better(search, other, node):
        return True
    # What stands in for something else makes nothing less sure that is for sure.
    if is_for_sure(search, other, search.criteria.missed_most) or not is_for_sure(search, node):
        return True
    # But where geometry leads away, what fewer faults miss there does not refute them, if they fit better.
    return is_ahead and other.is_known and other.faults < node.faults and misses_only_geometry(search, other)


def _errs_where_geometry_does(search: Search, other: Node, node: Node) -> bool:
    """Check for the same effect at one other element, which fails only on what geometry alone does not predict."""
    if len(node.members) != 1 or other.faults != 1 or not (other.is_known and has_effect(other, node.hypotheses[0])):
        return False
    checked = search.checked(other)
    return set(checked.reasons) <= set(checked.of_geometry)


def _describe(search: Search, other: Node, cause: Hypothesis) -> bool:
    """Check for several functions at a cause's own place: they describe its form, however far that is off."""
    return all(isinstance(each, Learned) and at_a_place_of_its_kin(search, cause, each) for each in other.hypotheses)


def _has_functions_more(search: Search, other: Node, node: Node) -> bool:
    """Check for more causes than several known effects, functions among them, that explain no more than forms hide."""
    if not node.is_known or len(node.members) < 2 or other.is_known or other.faults <= node.faults:
        return False
    return not explains_more(search, other, node)


def _nearly_as_good(search: Search, node: Node, cause: Hypothesis, form: Form) -> list[str]:
    """Return sets without a cause that explain nearly as much, at once or better than with so different a form.

    What explains more than the effect's formula does, all but the square of its deviation, needs no form at all: known
    effects by their own formulas. Six drives that lag, each by its form, were friction of one leg, a third off.
    """
    excess = search.root.trial.left - 1.0
    share = max(search.criteria.same_kind_share, form.deviation**2)
    return [
        " + ".join(other.trial.names)
        for other in sorted(search.nodes, key=lambda each: each.trial.left)
        if not has_kind(search, other, cause)
        and not _has_it_elsewhere(other, node, cause)
        and _left_without_forms(search, other) - node.trial.left < share * excess
        and not (other.trial.refused or search.checked(other).reasons)
    ]


def _left_without_forms(search: Search, node: Node) -> float:
    return search.left_by_formulas(node.trial) if node.is_known else node.trial.left


def _errs_no_more(search: Search, node: Node, cause: Hypothesis) -> list[str]:
    """Return what explains enough and errs no more where left out than a cause that errs there by more than all.

    Such a cause is a lead, and no better one than these, however well it fits; better than what explains less than its
    formula alone does.
    """
    error, excess = missed(search, node), search.root.trial.left - 1.0
    if error <= search.criteria.missed_bent:
        return []
    most = min(search.root.trial.left - search.criteria.explained_min * excess, search.left_by_formulas(node.trial))
    return [
        " + ".join(other.trial.names)
        for other, _ in sets_without(search, node, cause)
        if not _has_it_elsewhere(other, node, cause)
        and other.trial.left <= most
        and not search.checked(other).reasons
        and search.checked(other).missed <= error
    ]


def _lenders(search: Search, node: Node, cause: Hypothesis, form: Form) -> list[str]:
    """Return other effects that live in the functions of a cause's form, and explain as much with less of a form.

    Few readings hardly tell a gauge that drifts, and is not linear, from one that is linear, but of another gain. What
    explains less by its formula than the cause does by its own is no simpler.
    """
    by_formula = search.left_by_formulas(node.trial)
    return [
        other.trial.names[0]
        for other, _ in sets_without(search, node, cause)
        if len(other.members) == 1
        and other.is_known
        and not has_effect(other, cause)
        and not search.kin.get(other.trial.names[0], set()).isdisjoint(form.functions)
        and other.trial.left < node.trial.left + NOTHING_LEFT
        and other.trial.forms[0] is not None
        and other.trial.forms[0].deviation < form.deviation
        and not search.checked(other).reasons
        and search.left_by_formulas(other.trial) <= by_formula
    ]


def _is_bent(search: Search, node: Node) -> bool:
    return any(form is not None and form.deviation > search.criteria.form_limit for form in node.trial.forms)
