"""A set's hypotheses exchanged for better ones: looked at again, put into known words, given the better form."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

from hexdbb.errors import RunError
from hexdbb.evidence.needed import is_better, needs, needs_all
from hexdbb.evidence.node import Node
from hexdbb.evidence.one_cause import explains_nearly
from hexdbb.evidence.place import at_its_place
from hexdbb.evidence.screen import Hypothesis, Known
from hexdbb.evidence.screened import add_kin
from hexdbb.evidence.search import Search
from hexdbb.evidence.settling import NOTHING_LEFT, explained_by_formulas, is_doubtful, misses_most
from hexdbb.evidence.trial import Member
from hexdbb.learned import Learned


def settled(search: Search, node: Node) -> Node:
    """Take each cause out of a set and look again beside the others, until no set explains the readings better.

    An early choice may have stood in for what came later: it is exchanged, or left out where it is needed no more.
    """
    for _ in range(search.criteria.most_rounds):
        if len(node.members) < 2:
            return node
        for member in node.members:
            others = node.without(member)
            search.expand(search.node(others, near=node))
        better = sorted(
            (each for each in search.nodes if is_better(search, each, node) and _may_replace(search, each, node)),
            key=lambda each: -each.score,
        )
        # The best may have one too many, as it was reached; to look at every other so would take as many fits again.
        tried = (*(_all_needed(search, each) for each in better[:1]), *better)
        admissible = (e for e in tried if is_better(search, e, node) and _is_admissible(search, e))
        chosen = next(admissible, _all_needed(search, node))
        if chosen is node:
            return node
        node = in_known_words(search, chosen)
    return node


def with_found_beside(search: Search, node: Node) -> Node:
    """Return the best set that was tried with all of a set and more, where it is better, needs all and predicts."""
    wider = (each for each in search.nodes if {*node.hypotheses} < {*each.hypotheses} and is_better(search, each, node))
    best_first = sorted(wider, key=lambda each: -each.score)
    return next((each for each in best_first if _is_admissible(search, each)), node)


def _may_replace(search: Search, one: Node, other: Node) -> bool:
    """Check that a set neither says the same in fewer known words, nor misses most where the other predicts."""
    if _names_fewer(search, one, other):
        return False
    return is_doubtful(search, other) or not is_doubtful(search, one)


def _names_fewer(search: Search, one: Node, other: Node) -> bool:
    """Check whether a set has the causes of another in the words of learned functions: no other explanation."""
    known = [sum(isinstance(each, Known) for each in node.hypotheses) for node in (one, other)]
    return known[0] < known[1] and all(
        any(search.same_kind(each, same) for same in second.hypotheses)
        for first, second in ((one, other), (other, one))
        for each in first.hypotheses
    )


def _all_needed(search: Search, node: Node) -> Node:
    """Leave out a known effect that stood in for what was found after it, where the others predict without it."""
    for member in node.members:
        if len(node.members) > 1 and isinstance(member.hypothesis, Known) and not needs(search, node, member):
            others = search.node(node.without(member), near=node)
            if not (others.trial.refused or search.checked(others).reasons):
                return others
    return node


def in_known_words(search: Search, node: Node) -> Node:
    """Put known effects in the place of the learned functions that contain them, where they explain nearly as much."""
    for learned in [each for each in node.hypotheses if isinstance(each, Learned)]:
        if learned in node.hypotheses:
            others = sorted(_with_known_instead(search, node, learned), key=lambda each: -each.score)
            search.nodes += others
            node = next((each for each in others if _predicts_no_worse(search, each, node)), node)
    return node


def _with_known_instead(search: Search, node: Node, learned: Learned) -> Iterator[Node]:
    """Yield sets in which known effects replace all at a learned function's place, and explain nearly as much."""
    if learned.variable.period:
        add_kin(search, [learned])  # it may have moved since it was proposed
    at_place = [m for m in node.members if _is_at(m.hypothesis, learned)]
    kept = tuple(each for each in node.members if each not in at_place)
    instead = (*_in_their_place(search, [each.hypothesis for each in at_place]), *_as_good(search, node, learned))
    for known in dict.fromkeys(instead):
        if not {*known}.isdisjoint(node.hypotheses):
            continue
        try:
            trial = search.trials.of((*kept, *map(Member, known)))
        except RunError:
            continue
        other = Node(trial, node.score + trial.log_evidence - node.trial.log_evidence)
        if trial.refused or not explains_nearly(search, trial.left, node.trial.left):
            continue
        # What is more than any simple function is no known effect that errs by all that it explains; but it is one
        # whose formula fits as well.
        is_more = search.learnable.is_further(learned) and trial.left - node.trial.left >= NOTHING_LEFT
        if not is_more or misses_most(search, other) <= misses_most(search, node):
            yield other


def _as_good(search: Search, node: Node, learned: Learned) -> list[tuple[Known, ...]]:
    """Return the known effects at the place of the only cause whose formulas, nearly as they are, leave no more.

    Of few readings a function does not contain such an effect: where its speed turns, there are none.
    """
    if len(node.members) > 1:
        return []
    return [
        (each.hypotheses[0],)
        for each in search.nodes
        if len(each.members) == 1
        and isinstance(each.hypotheses[0], Known)
        and at_its_place(search, each.hypotheses[0], learned)
        and each.trial.left < node.trial.left + NOTHING_LEFT
        and explained_by_formulas(search, each) >= search.criteria.form_explains
    ]


def _predicts_no_worse(search: Search, node: Node, than: Node) -> bool:
    """Check that a set predicts, and is not excused from it where another is not.

    A free function of time claims nothing of what was left out: any formula that is hardly bent says more. One that
    predicts says what it is itself: an effect that explains it by functions of its form, not by its formula, says less.
    """
    if than.trial.is_of_time:
        return all(form is None or form.deviation <= search.criteria.form_named for form in node.trial.forms)
    if _is_by_form(search, node) and not is_doubtful(search, than):
        return False
    one, other = search.checked(node), search.checked(than)
    return not one.reasons and one.excused <= other.excused


def of_better_form(search: Search, node: Node) -> Node:
    """Exchange an effect of quite another form for a known one whose own form fits, at the same place."""
    for place, member in enumerate(node.members):
        form = node.trial.forms[place]
        if form is None or form.deviation <= search.criteria.form_named:
            continue
        others = node.without(member)
        for known in _known_for(search, list(form.functions)):
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


def _is_admissible(search: Search, node: Node) -> bool:
    """Check that a set predicts and that nothing could be left out of it."""
    return not node.trial.refused and needs_all(search, node) and not search.checked(node).reasons


def _is_at(one: Hypothesis, learned: Learned) -> bool:
    return isinstance(one, Learned) and (one.place, one.element) == (learned.place, learned.element)


def _in_their_place(search: Search, hypotheses: Sequence[Hypothesis]) -> Iterator[tuple[Known, ...]]:
    """Yield known effects that live in some hypotheses; for a function that two elements share, one effect at both."""
    yield from ((known,) for known in _known_for(search, [each.name for each in hypotheses]))
    for each in hypotheses:
        if isinstance(each, Learned) and each.of_each:
            one, other = (_known_for(search, [alone.name]) for alone in each.of_each)
            yield from (both for both in product(one, other) if both[0].effect == both[1].effect and both[0] != both[1])


def _known_for(search: Search, names: list[str]) -> list[Known]:
    """Return the known effects that live in one of some learned hypotheses, by what each explains of the readings."""
    found = []
    for name, kin in search.kin.items():
        if kin & set(names):
            effect, _, elements = name.partition(":")
            every = tuple(search.engine.base.info(effect).elements)
            found.append(Known(effect, tuple(elements.split(",")) if elements else every, not elements))
    return found


def _is_by_form(search: Search, node: Node) -> bool:
    """Check for one known effect whose formula explains less than that of any effect whose form is off."""
    is_one = node.is_known and node.faults == 1
    return is_one and explained_by_formulas(search, node) < search.criteria.formula_explains
