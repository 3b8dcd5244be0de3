"""A set's hypotheses exchanged for better ones: looked at again, given the better form."""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.by_formulas import are_what_they_are, explain_by_own_formulas
from hexdbb.evidence.search.expansion import expanded
from hexdbb.evidence.search.needed import is_better, needs, needs_all
from hexdbb.evidence.search.place import at_its_place
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import explained_by_formulas, explains_nearly, is_complete, is_doubtful
from hexdbb.evidence.search.sure import is_for_sure
from hexdbb.evidence.verdict.known_words import in_known_words, known_for
from hexdbb.evidence.verdict.predicting import predicts_better
from hexdbb.learned import Learned


def settled(search: Search, node: Node) -> Node:
    """Take each cause out of a set and look again beside the others, until no set explains the readings better.

    An early choice may have stood in for what came later: it is exchanged, or left out where it is needed no more.
    """
    for _ in range(search.criteria.most_rounds):
        if len(node.members) < 2 or are_what_they_are(search, node):
            return node
        learns = search.learns and not _is_known_for_sure(search, node)
        for member in node.members:
            others = node.without(member)
            _expand_better_formulas(search, node, expanded(search, search.node(others, near=node), learns), learns)
        better = sorted(
            (each for each in search.nodes if is_better(search, each, node) and _may_replace(search, each, node)),
            key=lambda each: -each.score,
        )
        # The best may have one too many, as it was reached; to look at every other so would take as many fits again.
        tried = (*(_all_needed(search, each) for each in better[:1]), *better)
        admissible = (
            each
            for each in tried
            if is_better(search, each, node) and is_admissible(search, each) and not _gives_up(search, node, each)
        )
        chosen = next(admissible, _all_needed(search, node))
        if chosen is node:
            return node
        node = in_known_words(search, chosen)
    return node


def _is_known_for_sure(search: Search, node: Node) -> bool:
    """Check for known effects, each what it is by its own formula: only another known effect may stand for one of them.

    A function in place of one would only say the same; to screen all beside each of them took a third of the time.
    """
    if not (node.is_known and is_complete(search, node) and explain_by_own_formulas(search, node)):
        return False
    return is_for_sure(search, node)


def _expand_better_formulas(search: Search, node: Node, instead: Sequence[Node], learns: bool) -> None:
    """Expand the set whose formulas explain most, of those that have another known effect in place of one of a set.

    One effect may stand in for two: either of these alone explains less than it does, but more by its formula.
    """
    if not node.is_known or len(node.members) >= search.criteria.max_effects:
        return
    known = [each for each in instead if each.is_known and not each.trial.refused]
    best = min(known, key=lambda each: search.left_by_formulas(each.trial), default=node)
    if search.left_by_formulas(best.trial) < search.left_by_formulas(node.trial):
        expanded(search, best, learns)


def _gives_up(search: Search, node: Node, other: Node) -> bool:
    """Check that one of known effects, for sure by formulas that explain nearly all, would be given up for a function.

    A function of the time since each circle began says what a slider's reversals do, with a little more evidence than
    an effect a tenth off its formula. What leaves far less is no other wording.
    """
    if not node.is_known or other.is_known or {*node.hypotheses} <= {*other.hypotheses}:
        return False
    if _leaves_far_less(search, other, node):
        return False
    return explained_by_formulas(search, node) >= search.criteria.form_explains and is_for_sure(search, node)


def with_found_beside(search: Search, node: Node) -> Node:
    """Return the best set that was tried with all of a set and more, where it is better, needs all and predicts."""
    wider = (each for each in search.nodes if {*node.hypotheses} < {*each.hypotheses} and is_better(search, each, node))
    best_first = sorted(wider, key=lambda each: -each.score)
    return next((each for each in best_first if is_admissible(search, each)), node)


def _may_replace(search: Search, one: Node, other: Node) -> bool:
    """Check that a set neither says the same in fewer known words, nor misses most where the other predicts.

    What errs less on everything that was left out may, however far geometry leads both away.
    """
    if _names_fewer(search, one, other):
        return False
    return is_doubtful(search, other) or not is_doubtful(search, one) or predicts_better(search, one, other)


def _names_fewer(search: Search, one: Node, other: Node) -> bool:
    """Check whether a set has the causes of another in the words of learned functions: no other explanation.

    Functions elsewhere that leave far less are one.
    """
    if _leaves_far_less(search, one, other) and not _is_where(search, one, other):
        return False
    known = [sum(isinstance(each, Known) for each in node.hypotheses) for node in (one, other)]
    return known[0] < known[1] and all(
        any(search.same_kind(each, same) for same in second.hypotheses)
        for first, second in ((one, other), (other, one))
        for each in first.hypotheses
    )


def _leaves_far_less(search: Search, one: Node, other: Node) -> bool:
    return one.trial.left - 1.0 < search.criteria.far_better * (other.trial.left - 1.0)


def _is_where(search: Search, one: Node, other: Node) -> bool:
    """Check that the functions of a set act where the causes of another do."""
    return all(
        any(at_its_place(search, cause, each) for cause in other.hypotheses)
        for each in one.hypotheses
        if isinstance(each, Learned)
    )


def _all_needed(search: Search, node: Node) -> Node:
    """Leave out a known effect that stood in for what was found after it, where the others predict without it."""
    for member in node.members:
        if len(node.members) > 1 and isinstance(member.hypothesis, Known) and not needs(search, node, member):
            others = search.node(node.without(member), near=node)
            if not (others.trial.refused or search.checked(others).reasons):
                return others
    return node


def of_better_form(search: Search, node: Node) -> Node:
    """Exchange an effect of quite another form for a known one whose own form fits, at the same place."""
    for place, member in enumerate(node.members):
        form = node.trial.forms[place]
        if form is None or not form.is_odd:
            continue
        others = node.without(member)
        for known in known_for(search, list(form.functions)):
            if known in node.hypotheses:
                continue
            try:
                trial = search.trials.of((*others, Member(known)))
            except RunError:
                continue
            own = trial.forms[-1]
            near = explains_nearly(search, trial.left, node.trial.left)
            if near and not trial.refused and own is not None and own.deviation < form.deviation:
                found = Node(trial, node.score + trial.log_evidence - node.trial.log_evidence)
                search.nodes.append(found)
                if not search.checked(found).reasons:
                    return _without_the_needless(search, found)
    return node


def _without_the_needless(search: Search, node: Node) -> Node:
    """Leave out what made up for a form that is exchanged now."""
    excess = search.root.trial.left - 1.0
    for member in node.members:
        others = node.without(member)
        if not others:
            break
        trial = search.trials.of(others)
        if trial.left - node.trial.left < search.criteria.complete * excess and not trial.refused:
            node = Node(trial, node.score + trial.log_evidence - node.trial.log_evidence)
            search.nodes.append(node)
    return node


def is_admissible(search: Search, node: Node) -> bool:
    """Check that a set predicts and that nothing could be left out of it."""
    return not node.trial.refused and needs_all(search, node) and not search.checked(node).reasons
