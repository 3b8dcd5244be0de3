"""Whether causes explain enough, and predict well enough, to be named for sure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from hexdbb.errors import RunError
from hexdbb.evidence.admissible import missed_of
from hexdbb.evidence.heldout import HeldOut
from hexdbb.evidence.node import Node
from hexdbb.evidence.readings import ARC
from hexdbb.evidence.screen import Known
from hexdbb.evidence.search import Search
from hexdbb.evidence.settling import NOTHING_LEFT, explained_by_formulas, is_complete, missed

Grade = Literal["none", "effect", "ambiguous", "unknown"]


def graded(search: Search, node: Node, grade: Grade) -> Grade:
    """Return a grade as it may be said of causes: what is not for sure is unknown.

    A cause with its rivals claims less than one alone: it may err by more. Known causes explain enough without the
    learned functions that refine them: in such as free as six steps of a leg another cause may hide.
    """
    criteria = search.criteria
    missed_most = criteria.missed_sure if grade == "effect" else criteria.missed_most
    is_sure = is_for_sure(search, node, missed_most) and (grade == "unknown" or _explain_unrefined(search, node))
    return grade if is_sure else "unknown"


def _explain_unrefined(search: Search, node: Node) -> bool:
    """Check that the known effects of a set explain enough without its learned functions."""
    known = tuple(each for each in node.members if isinstance(each.hypothesis, Known))
    try:
        left = search.trials.of(known).left
    except RunError:
        return False
    excess = search.root.trial.left - 1.0
    return search.root.trial.left - left >= search.criteria.explained_min * excess


def is_for_sure(search: Search, node: Node, missed_most: float | None = None) -> bool:
    """Check that causes together explain enough to be named for sure.

    One effect of another form need not predict circles that geometry alone does not predict either. Several that are
    excused so together, or of which one is of quite another form, were put together to fit: each takes what the others
    leave. So was one that is excused, or several, whose formulas explain little of what the functions of their forms
    do; of several that leave something, or where circles hardly hold geometry, these must explain enough. And what errs
    on circles left out by half of all that it explains where fitted may stand in for something else, however much worse
    geometry alone errs; by more, where formulas explain nearly all, or one that is nearly as it is leaves only noise:
    other circles hardly tell its size, but that it is there. What errs by more than all that it explains is not excused
    either, but where the other circles hold geometry so badly that it leads away.

    Parameters
    ----------
    search : Search
    node : Node
    missed_most : float, optional
        Part of what is explained by which it may err on what was left out; `Criteria.missed_sure` where not given.
    """
    criteria = search.criteria
    missed_most = criteria.missed_sure if missed_most is None else missed_most
    checked, is_one = search.checked(node), len(node.members) == 1
    if checked.share < criteria.explained_min or (checked.excused and not is_one):
        return False
    deviation = max((form.deviation for form in node.trial.forms if form is not None), default=0.0)
    if not is_one and deviation > criteria.form_named:
        return False
    by_formulas = explained_by_formulas(search, node)
    error = missed(search, node)
    if by_formulas >= criteria.form_explains:
        missed_most = criteria.missed_most
    if error > criteria.missed_bent or not (checked.excused or error <= missed_most or _is_exact(search, node)):
        # Where geometry makes much of little, what else explains enough and errs no more is named beside it.
        return is_one and by_formulas >= criteria.form_explains and _geometry_misses(search, node)
    if is_one and not checked.excused:
        return True
    is_all = is_one or (is_complete(search, node) and not _leads_away(search, _held(search, node)))
    return by_formulas >= (criteria.formula_explains if is_all else criteria.explained_min)


def _held(search: Search, node: Node) -> list[HeldOut]:
    return [held for grouping, held in search.checked(node).heldout.items() if grouping != ARC]


def _geometry_misses(search: Search, node: Node) -> bool:
    """Check that geometry leads away wherever one known effect misses much: nothing could predict that."""
    missing = [
        each
        for each in _held(search, node)
        if missed_of(each, node.trial, search.root.trial) > search.criteria.missed_sure
    ]
    return node.is_known and all(_leads_away(search, [each]) for each in missing)


def _leads_away(search: Search, held: Sequence[HeldOut]) -> bool:
    """Check whether the readings left in hold geometry so badly that what is left out says nothing."""
    before = search.root.trial.left**0.5
    return any(each.before > search.criteria.leads_away * before for each in held)


def _is_exact(search: Search, node: Node) -> bool:
    """Check that one effect's formula, hardly bent, leaves only noise."""
    form = node.trial.forms[0]
    is_formula = len(node.members) == 1 and form is not None and form.deviation <= search.criteria.form_exact
    return is_formula and node.trial.left - 1.0 < NOTHING_LEFT
