"""Whether causes explain enough, and predict well enough, to be named for sure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

from hexdbb.errors import RunError
from hexdbb.evidence.fit.admissible import leads_away, missed_of
from hexdbb.evidence.fit.heldout import HeldOut
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.readings import ARC
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.by_formulas import err_by_geometry, explain_in_part
from hexdbb.evidence.search.settling import (
    explained_by_formulas,
    is_complete,
    leaves_room,
    leaves_what_forms_do,
    missed,
)

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

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
    """Check that causes together explain enough, and err little enough elsewhere, to be named for sure.

    The formula of one effect must explain a part where its form excuses it from predicting, or geometry leads away so
    that nothing left out tests it; those of several more: functions of forms, free enough, stand in for something else.

    Parameters
    ----------
    search : Search
    node : Node
    missed_most : float, optional
        Part of what is explained by which it may err on what was left out; `Criteria.missed_sure` where not given.
    """
    missed_most = search.criteria.missed_sure if missed_most is None else missed_most
    checked, is_one = search.checked(node), node.faults == 1
    if checked.share < search.criteria.explained_min or not _predicts_more_than_laps(search, node):
        return False
    # Sizes of its own at each element make one effect no less free than several causes: a function is asked of it, too.
    if len(node.members) == 1 and _is_outdone_untested(search, node):
        return False
    if _is_put_together(search, node):
        return err_by_geometry(search, node)
    if _is_made_up(search, node):
        return False
    if not _errs_little(search, node, missed_most):
        by_formula = is_one and _explains_by_formulas(search, node) and misses_only_geometry(search, node)
        return by_formula or err_by_geometry(search, node)
    if is_one and not checked.excused and not _leads_away(search, _held(search, node)):
        return True
    return explained_by_formulas(search, node) >= _least_by_formulas(search, node)


def _predicts_more_than_laps(search: Search, node: Node) -> bool:
    """Check that a set predicts circles, feeds or directions left out, where there are such.

    A further lap repeats what was fitted: whatever follows the readings of one predicts the next.
    """
    checked = search.checked(node)
    least = search.criteria.heldout_share_min * checked.share
    others = [held.share for grouping, held in checked.heldout.items() if grouping not in (ARC, "lap")]
    return not others or max(others) >= least


def _is_outdone_untested(search: Search, node: Node) -> bool:
    """Check for one effect that misses far more than it explains, whatever excuses it, where a function says more.

    Where the readings left in hardly hold geometry, an error of any size is no more than is expected: nothing tests the
    effect then but its evidence, and a function that has more of it may be true as well; but for one in which it lives,
    where its formula explains nearly all: that says how its form differs. So may anything where it errs more than
    geometry does without it, and nothing else that was left out is explained by it.
    """
    explains = max(search.root.trial.left - node.trial.left, 1e-9) ** 0.5
    missing = [each for each in _held(search, node) if each.after > search.criteria.missed_far * explains]
    if not missing:
        return False
    shares = [held.share for grouping, held in search.checked(node).heldout.items() if grouping not in (ARC, "lap")]
    if max(shares, default=0.0) < search.criteria.explained_min and any(each.after > each.before for each in missing):
        return True
    own = search.kin.get(node.trial.names[0], set()) if leaves_what_forms_do(search, node) else set()
    alone = (each for each in search.nodes if len(each.members) == 1 and not each.is_known)
    alone = (each for each in alone if each.trial.names[0] not in own)
    tested = (each for each in alone if not (each.trial.is_of_time or each.trial.refused) and is_complete(search, each))
    return any(each.score - node.score > search.criteria.margin_nats for each in tested)


def _is_put_together(search: Search, node: Node) -> bool:
    """Check for several excused from predicting, or one among them of quite another form: each takes what others leave.

    So it fits, whatever is true; unless each explains by its own formula what it does.
    """
    is_odd = search.checked(node).excused or any(form is not None and form.is_odd for form in node.trial.forms)
    return len(node.members) > 1 and is_odd


def _is_made_up(search: Search, node: Node) -> bool:
    """Check for several known effects whose formulas leave much, and one of which explains hardly anything by its own.

    Effects that nearly cancel are as free as a function: three screws, one that grew and two that shrank, followed an
    arm of the platform that warmed. The formulas left a quarter of what was missed, and the functions of their forms
    described that; compared with what each screw pushes, these were small, so that no form was refused. Of a bow or a
    joint off its place geometry takes nearly all but what the form is: beside others such are what predicts circles
    that were left out to the noise, nearly. What follows a drift claims no other circle.
    """
    if len(node.members) < 2 or not node.is_known or _explains_by_formulas(search, node):
        return False
    return not (explain_in_part(search, node) or _predict_circles(search, node))


def _predict_circles(search: Search, node: Node) -> bool:
    """Check that causes claim to predict circles left out, and predict all that was left out to the noise, nearly.

    What the fit expects of itself is no excuse here: of a ball in one of three set-ups, which followed a plate that
    bends by its form, that was eight times the noise.
    """
    most = search.criteria.heldout_ratio * max(node.trial.left, 1.0) ** 0.5
    return "circle" in search.checked(node).heldout and all(each.after <= most for each in _held(search, node))


def _errs_little(search: Search, node: Node, missed_most: float) -> bool:
    """Check that a set errs little on what was left out, against all that it explains where fitted.

    What errs by half of that may stand in for something else, however much worse geometry alone errs. By more where
    formulas explain nearly all, or one that is nearly as it is leaves only noise: other circles hardly tell its size,
    but that it is there. By more than all not even what its form excuses.
    """
    error = missed(search, node)
    most = search.criteria.missed_most if _explains_by_formulas(search, node) else missed_most
    is_excused = search.checked(node).excused or _is_exact(search, node)
    return error <= search.criteria.missed_bent and (is_excused or error <= most)


def _explains_by_formulas(search: Search, node: Node) -> bool:
    """Check that formulas explain nearly all."""
    return explained_by_formulas(search, node) >= search.criteria.form_explains


def _least_by_formulas(search: Search, node: Node) -> float:
    """Return what formulas must explain: more of several that leave something, or that nothing left out tests.

    Nearly all of an effect at several elements: sizes of its own at each are as free as a function.
    """
    if any(isinstance(each, Known) and len(each.elements) > 1 for each in node.hypotheses):
        return search.criteria.form_explains
    is_tested = is_complete(search, node) and not _leads_away(search, _held(search, node))
    return search.criteria.formula_explains if node.faults == 1 or is_tested else search.criteria.explained_min


def _held(search: Search, node: Node) -> list[HeldOut]:
    return [held for grouping, held in search.checked(node).heldout.items() if grouping != ARC]


def misses_only_geometry(search: Search, node: Node) -> bool:
    """Check that geometry leads away wherever known effects miss much: nothing could predict that.

    What else explains enough and errs no more is named beside one effect (`rivals.py`).
    """
    missing = [
        each
        for each in _held(search, node)
        if missed_of(each, each.as_fitted, node.trial, search.root.trial, search.criteria) > search.criteria.missed_sure
    ]
    return node.is_known and all(_leads_away(search, [each]) for each in missing)


def _leads_away(search: Search, held: Sequence[HeldOut]) -> bool:
    """Check whether geometry leads away on any of some groupings left out."""
    return any(leads_away(each, search.root.trial, search.criteria) for each in held)


def _is_exact(search: Search, node: Node) -> bool:
    """Check that one effect's formula, hardly bent, leaves only noise, or what its form may leave undescribed."""
    form = node.trial.forms[0]
    is_formula = node.faults == 1 and form is not None and form.deviation <= search.criteria.form_exact
    return is_formula and not leaves_room(search, node)
