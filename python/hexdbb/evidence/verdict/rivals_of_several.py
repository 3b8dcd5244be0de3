"""Rivals of several known effects: no more of them that explain more by formulas, or one hypothesis in their place."""

from __future__ import annotations

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import NOTHING_LEFT
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.search.all_elements import FEWEST
from hexdbb.evidence.search.by_formulas import explain_nearly_all, explains_by_its_own
from hexdbb.evidence.search.screened import known_beside
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import is_complete, must_explain, of_forms
from hexdbb.evidence.search.shortlist import shortlist
from hexdbb.evidence.verdict.without import acts_where_they_do, has_effect, sets_without


def better_by_formula(search: Search, node: Node, cause: Hypothesis) -> list[str]:
    """Return sets of no more effects without a cause that explain all too, by their formulas, and more by these.

    Functions of forms hold what geometry leaves of a slow drift: more evidence may be more of such functions. Sets
    that both leave less than the noise count as explaining the same.
    """
    least = max(node.trial.left, 1.0)
    left, spare = search.left_by_formulas(node.trial), must_explain(search, node.trial)
    found = (
        " + ".join(sorted(other.trial.names))
        for other, _ in sets_without(search, node, cause)
        if other.is_known
        and _is_no_freer(other, node)
        and not has_effect(other, cause)
        and is_complete(search, other)
        and other.trial.left - least < spare
        and not search.checked(other).reasons
        and search.left_by_formulas(other.trial) < min(left, 1.0 + of_forms(search, other.trial))
    )
    return list(dict.fromkeys(found))


def of_one_size(search: Search, node: Node, cause: Hypothesis) -> list[str]:
    """Return sets with an effect of one size in place of one that has a size at each of its elements.

    On circles of one radius about one cup a gauge that drifts is six screws that grow, and these, each with its form,
    have more evidence. The one must explain nearly all that it does by its own formula, and what the sets leave differ
    by less than forms may hide.
    """
    if not isinstance(cause, Known) or len(cause.elements) <= FEWEST:
        return []
    most = max(node.trial.left, 1.0) + must_explain(search, node.trial)
    fewer = search.node(node.without(node.member(cause)), near=node)
    screened = known_beside(search, fewer.trial, search.screen(fewer))
    of_one = [each for each in screened if isinstance(each.hypothesis, Known) and each.hypothesis.is_whole]
    found = [
        other
        for other in search.tried(fewer, shortlist(of_one, search.criteria.later_fits, 1))
        if is_complete(search, other)
        and other.trial.left < most
        and not (other.trial.refused or search.checked(other).reasons)
        and explains_by_its_own(search, other, other.members[-1], search.criteria.form_explains)
    ]
    search.nodes += found
    return [" + ".join(other.trial.names) for other in found]


def one_instead(search: Search, node: Node, cause: Hypothesis) -> list[str]:
    """Return single hypotheses without a cause that leave only noise and predict, unless each of several is for sure.

    Several whose forms make up for what their formulas leave may stand in for one cause: one that errs by no more than
    what may be for sure, as a function does that is not quite the cause. A function that two sliders share says the
    same as a cause of each.
    """
    if explain_nearly_all(search, node):
        return []
    return [
        other.trial.names[0]
        for other, _ in sets_without(search, node, cause)
        if len(other.members) == 1
        and not acts_where_they_do(search, other, node)
        and other.trial.left - 1.0 < NOTHING_LEFT
        and not search.checked(other).reasons
        and search.checked(other).missed <= search.criteria.missed_bent
    ]


def _is_no_freer(other: Node, node: Node) -> bool:
    """Check for a set of fewer causes; of as many, one at no more elements: six sizes stand in for any drift."""
    return len(other.members) < len(node.members) or (
        len(other.members) == len(node.members) and other.faults <= node.faults
    )
