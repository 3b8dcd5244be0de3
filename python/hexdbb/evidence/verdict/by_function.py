"""A learned function in place of a known effect that fits by the functions of its form alone."""

from __future__ import annotations

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.readings import ARC
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.needed import explains_by_its_formula
from hexdbb.evidence.search.place import at_its_place
from hexdbb.evidence.search.refine import refined
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import explained_by_formulas, explains_nearly, predicts
from hexdbb.evidence.search.sure import is_for_sure
from hexdbb.learned import Learned


def or_by_functions(search: Search, node: Node) -> Node:
    """Return a set with learned functions in place of known effects that the functions of their forms make fit.

    Geometry takes nearly all of a ball that sits otherwise in one set-up, and a twentieth of its push, as a step from
    each circle to the next, described a plate that bends as it is tilted. That predicts no other circle; a function of
    the tilt does.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged where it is for sure, or no function at the effect's place that was tried
        beside the others explains nearly as much and errs less on what was left out.
    """
    if is_for_sure(search, node):
        return node
    if len(node.members) == 1:
        return _or_elsewhere(search, node)
    for member in node.members:
        if is_by_form(search, node, member):
            node = max(_instead(search, node, member), key=lambda each: each.score, default=node)
    return node


def or_by_refinements(search: Search, node: Node, wider: Node) -> tuple[Node, Node]:
    """Return several causes with the function that refines an effect in its stead, where that alone says more.

    A dent beside legs that sag was a bow by the functions of its form, which have few splines; refined, a finer one
    said all of it, and the bow nothing.

    Parameters
    ----------
    search : Search
    node, wider : Node
        Causes, alone and refined; returned as they are where they are one, or for sure.
    """
    if len(node.members) < 2 or is_for_sure(search, node):
        return node, wider
    for member in node.members:
        if not is_by_form(search, node, member, search.criteria.formula_names):
            continue
        for function in wider.members:
            learned = function.hypothesis
            # One of the causes itself, with more splines, is there already.
            if not isinstance(learned, Learned) or learned.name in node.trial.names:
                continue
            if not at_its_place(search, member.hypothesis, learned):
                continue
            instead = [function if each is member else each for each in node.members]
            try:
                other = search.node(instead, near=wider)
            except RunError:
                continue
            if other.score > wider.score and not other.trial.refused and predicts(search, other):
                return other, refined(search, other)
    return node, wider


def _or_elsewhere(search: Search, node: Node) -> Node:
    """Return a function elsewhere in place of one effect whose formula explains hardly anything.

    At its own place the effect keeps its name: of a bow of which geometry takes nearly all only its form is seen,
    beside nothing that the form could have borrowed. Elsewhere: a ball with lobes was one that sits 2.6 mm otherwise in
    one set-up, of which geometry took all but the lobes.
    """
    (member,) = node.members
    cause, form = member.hypothesis, node.trial.forms[0]
    if not isinstance(cause, Known) or form is None or not form.columns:
        return node
    if explained_by_formulas(search, node) >= search.criteria.formula_names:
        return node
    own = search.kin.get(cause.name, set())
    found = []
    for each in search.nodes:
        is_other = len(each.members) == 1 and not each.is_known and each.trial.names[0] not in own
        is_tested = is_other and not (each.trial.refused or each.trial.is_of_time)
        if is_tested and _says_as_much(search, each, node) and _predicts_better(search, each, node, member):
            found.append(each)
    return max(found, key=lambda each: each.score, default=node)


def is_by_form(search: Search, node: Node, member: Member, least: float | None = None) -> bool:
    """Check for a known effect of which the formula explains less than a part of what it does.

    The smaller part (`Criteria.formula_most`) where no other is given; the functions of its form explain the rest.
    """
    form = node.trial.forms[node.members.index(member)]
    if not isinstance(member.hypothesis, Known) or form is None or not form.columns:
        return False
    others = search.trials.of_fewer(node.without(member), node.trial)
    least = search.criteria.formula_most if least is None else least
    return not explains_by_its_formula(search, node, form, others, least)


def _instead(search: Search, node: Node, member: Member) -> list[Node]:
    """Return the sets tried that have a function at the place of a known effect instead, and predict better."""
    others = {each.hypothesis for each in node.without(member)}
    found = []
    for each in search.nodes:
        new = {*each.hypotheses} - others
        if len(each.members) != len(node.members) or len(new) != 1 or each.trial.refused:
            continue
        (learned,) = new
        if not isinstance(learned, Learned) or not at_its_place(search, member.hypothesis, learned):
            continue
        if _says_as_much(search, each, node) and _predicts_better(search, each, node, member):
            found.append(each)
    return found


def _says_as_much(search: Search, one: Node, node: Node) -> bool:
    """Check that a set leaves hardly more than another: what leaves structure besides says less than its form does.

    Of a ball that sits otherwise, and moves a little with the tilt, functions of the bar's direction said all but a
    hundredth, which was two and a half times the noise.
    """
    most = search.criteria.leaves_structure * max(node.trial.left, 1.0)
    return one.trial.left < most and explains_nearly(search, one.trial.left, node.trial.left)


def _predicts_better(search: Search, one: Node, node: Node, member: Member) -> bool:
    """Check that a set errs far less than another; one that follows time by the form of a member predicts nothing."""
    form = node.trial.forms[node.members.index(member)]
    is_of_time = form is not None and any(Learned.parse(name).is_of_time for name in form.functions)
    most = search.criteria.far_better * _worst(search, node)
    return predicts(search, one) and (is_of_time or _worst(search, one) < most)


def _worst(search: Search, node: Node) -> float:
    """Return the error of the grouping that a set predicts worst; what it expects of itself is no excuse here."""
    held = search.checked(node).heldout
    return max((each.after for grouping, each in held.items() if grouping != ARC), default=0.0)
