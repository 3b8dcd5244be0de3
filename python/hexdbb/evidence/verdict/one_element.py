"""An effect of all elements of which one function, at one of them, says far more: that element is at fault alone.

Weight makes all legs give. Where one leg gives and the others do not, the functions of the effect's form describe the
difference, six of them being free enough, and its formula explains what a sixth of it explains of that leg. So it is
with sizes of its own at each element: five drives that lag alike, as geometry imitates, describe how one lags.
"""

from __future__ import annotations

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.place import homes_of
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import explained_by_formulas, is_complete, missed, of_forms, predicts
from hexdbb.learned import ALL, Learned
from hexdbb.learned.places import SHARED, members


def or_one_element(search: Search, node: Node) -> Node:
    """Return the function of one element that explains far more than one effect of all does by its formula.

    Where the form of that is quite another, what leaves less than half as much: a scale that creeps after its
    neighbour was six drives that lag, each by as much as its form made of it.

    Or the same effect at one of its elements, where its formula explains nearly all there and misses less than half as
    much of what was left out. Of drives that all lag none explained more than three quarters alone.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged where it is no such effect, or there is no such function.
    """
    effect = node.hypotheses[0] if len(node.members) == 1 else None
    if not isinstance(effect, Known) or not _is_of_all(search, effect):
        return node
    if (alone := _alone(search, node, effect)) is not None:
        return alone
    by_formula, form = search.left_by_formulas(node.trial), node.trial.forms[0]
    most = by_formula - of_forms(search, node.trial)
    if form is not None and form.is_odd:  # no form of this effect excuses what it leaves
        most = max(most, search.criteria.far_better * by_formula)
    ports = search.engine.absent.ports(effect.effect)
    found = [
        each
        for each in search.nodes
        if each.trial.left < most and _is_of_one(each, ports) and is_complete(search, each) and predicts(search, each)
    ]
    return max(found, key=lambda each: each.score, default=node)


def _alone(search: Search, node: Node, effect: Known) -> Node | None:
    """Return the best of the same effect at one element that may stand in place of it at all; None if none may."""
    most = search.criteria.far_better * missed(search, node)
    found = (
        each
        for each in search.nodes
        if len(each.members) == 1
        and not each.trial.refused
        and isinstance(one := each.hypotheses[0], Known)
        and one.effect == effect.effect
        and len(one.elements) == 1 < len(effect.elements)
        and explained_by_formulas(search, each) >= search.criteria.form_explains
        and missed(search, each) < most
    )
    return max(found, key=lambda each: each.score, default=None)


def _is_of_all(search: Search, effect: Known) -> bool:
    """Check that an effect lives in a function which all elements share."""
    return any(each.place in SHARED and each.element == ALL for each in homes_of(search, effect))


def _is_of_one(node: Node, ports: frozenset[str]) -> bool:
    """Check for a function of one element, at one of some ports, that is admissible and no free function of time."""
    if len(node.members) != 1 or node.trial.refused or node.trial.is_of_time:
        return False
    learned = node.hypotheses[0]
    if not isinstance(learned, Learned) or learned.element == ALL:
        return False
    return learned.port in ports and len(members(learned.element)) == 1
