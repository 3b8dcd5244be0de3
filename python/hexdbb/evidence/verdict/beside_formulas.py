"""What the forms of known effects hide: another known effect, whose formula explains nearly all that theirs leave.

A lead error of three times the noise beside a bow of five is a bow whose form is off by a hundredth: free functions
of a form describe a small effect at another place as well. No form is like the formula of another effect by chance:
where that, of few values, explains nearly all that the formulas found leave, it is there.
"""

from __future__ import annotations

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import NOTHING_LEFT
from hexdbb.evidence.linear.readings import ARC
from hexdbb.evidence.linear.screen import Known, Scored
from hexdbb.evidence.search.needed import push_one_element
from hexdbb.evidence.search.no_form import NOISE
from hexdbb.evidence.search.screened import known_by_formulas
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import errs_as_expected, predicts
from hexdbb.evidence.search.several import beside

LEAST = 0.5
"""Mean square, in noise variances, that formulas leave and another may explain: a lead beside two effects explained 0.8
of 0.9. Noise that is estimated a tenth too small leaves 0.2."""

BETTER = 3.0
"""Error where held out, over that with one more effect, that shows it: 9, 7 and 5 times where one of a tenth or a third
of the size was missing."""


def with_what_formulas_leave(search: Search, node: Node) -> Node:
    """Add to known effects others whose formulas explain nearly all that theirs leave, the likeliest first.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged where it has a learned function, or where formulas leave hardly more than noise.
    """
    while node.members and node.is_known and len(node.members) < search.criteria.max_effects:
        if search.left_by_formulas(node.trial) - 1.0 < LEAST:
            break
        tried = (_as_well_fitted(search, node, each) for each in search.tried(node, _likeliest(search, node)))
        found = [each for each in tried if _is_there(search, node, each)]
        if not found:
            break
        search.nodes += found
        node = max(found, key=lambda each: each.score)
    return node


def _likeliest(search: Search, node: Node) -> list[Scored]:
    """Return the known effects to try: of what formulas leave, and of what they leave with their forms.

    To first order neighbours look alike: the fifth in the list, a lead, explained all, the first another screw's third.
    """
    by_formulas = known_by_formulas(search, node.trial)[: search.criteria.full_fits]
    there = {each.hypothesis for each in by_formulas}
    return [*by_formulas, *(each for each in beside(search, node) if each.hypothesis not in there)]


def _as_well_fitted(search: Search, node: Node, wider: Node) -> Node:
    """Fit a set again beside its forms if it is likelier and leaves only noise, but mispredicts what was held out."""
    is_likelier = not wider.trial.refused and wider.score - node.score >= search.criteria.detect_nats
    if not is_likelier or wider.trial.left - 1.0 >= NOTHING_LEFT or errs_as_expected(search, wider):
        return wider
    again = search.trials.beside_own_forms(wider.trial)
    return Node(again, wider.score + again.log_evidence - wider.trial.log_evidence)


def _is_there(search: Search, node: Node, wider: Node) -> bool:
    """Check that a set's last effect is likelier than the forms of the others, and explains what these leave.

    At an element of theirs it may be a part of their form: a spike explained 0.89 of what the formula of play left, a
    quarter of what its form did.
    """
    last = wider.members[-1].hypothesis
    if wider.trial.refused or wider.score - node.score < search.criteria.detect_nats or not predicts(search, wider):
        return False
    if _is_all_that_lacked(search, node, wider):
        return True
    by_formulas, by_forms = _explains_of_formulas(search, node, wider), _explains_of_forms(search, node, wider)
    known = [each for each in node.hypotheses if isinstance(each, Known)]
    if isinstance(last, Known) and any(push_one_element(search, each, last) for each in known):
        return by_formulas and by_forms
    return by_formulas or (by_forms and node.trial.left - 1.0 >= NOISE)


def _is_all_that_lacked(search: Search, node: Node, wider: Node) -> bool:
    """Check that others miss much of what was left out, and with one more only noise is left, there as well.

    By its formula a lead of three times the noise explained a third of what it did beside a bow of thirty: geometry
    takes its straight part. Circles left out were predicted to 1.6 in place of 14 times the noise.
    """
    if _lacks_nothing(search, node) or not _lacks_nothing(search, wider):
        return False
    before, after = search.checked(node).heldout, search.checked(wider).heldout
    return any(before[each].after >= BETTER * after[each].after for each in before.keys() & after.keys() - {ARC})


def _lacks_nothing(search: Search, node: Node) -> bool:
    return node.trial.left - 1.0 < NOTHING_LEFT and errs_as_expected(search, node)


def _explains_of_formulas(search: Search, node: Node, wider: Node) -> bool:
    before, after = (search.left_by_formulas(each.trial) for each in (node, wider))
    return before - after >= search.criteria.formula_leaves * (before - 1.0)


def _explains_of_forms(search: Search, node: Node, wider: Node) -> bool:
    """Check the same of what the others leave with the functions of their forms, by the formula of what was added."""
    before, form = node.trial.left, wider.trial.forms[-1]
    after = wider.trial.left if form is None else search.left_by_formula(wider.trial, form)
    return before - after >= search.criteria.formula_leaves * max(before - 1.0, LEAST)
