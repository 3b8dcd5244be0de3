"""One effect at several elements at once: drives of one make lag alike, screws of one batch err alike.

Looked for one by one, six such faults are more causes than a search follows, and two of them explain so little that
functions of all sliders stand before them. Here an effect is one cause at all its elements, where it is seen at most.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.linear.screen import Hypothesis, Known, Scored
from hexdbb.evidence.search.all_elements import FEWEST, at_all_elements, effect_of
from hexdbb.evidence.search.by_formulas import are_what_they_are
from hexdbb.evidence.search.needed import best_of, needs
from hexdbb.evidence.search.screened import known_beside
from hexdbb.evidence.search.settling import (
    explained_by_formulas,
    is_complete,
    is_doubtful,
    leaves_room,
    predicts,
)
from hexdbb.evidence.search.shortlist import shortlist
from hexdbb.evidence.search.some_elements import at_those_seen, count_kin, of_wrong_sign
from hexdbb.learned import ALL

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search


def or_at_several(search: Search, best: Node) -> Node:
    """Return a set with an effect at all its elements, where that is better than what was found one by one.

    It is looked for beside nothing, and beside the known effects of the best set, all or less one of them, which may
    have stood in for it. Where known effects, each at one element, explain all and predict, only what may be the one
    cause of all that several of them explain is looked at: of nearly all, where they are what they are by formulas.
    Nothing, where one effect at two elements is so: at all of them it says that too, and the rest is none of its sizes.
    """
    effects = [effect_of(each) for each in best.hypotheses]
    is_explained = is_complete(search, best) and best.is_known and not leaves_room(search, best)
    is_by_formulas, are_distinct = are_what_they_are(search, best), len({*effects}) == len(effects)
    if is_explained and is_by_formulas and not are_distinct:
        return best
    is_settled = is_explained and are_distinct and not is_doubtful(search, best)
    criteria, found = search.criteria, list[Node]()
    least = criteria.form_explains if is_by_formulas else criteria.explained_min
    for start in _starts(best, is_settled):
        fewer = search.node(start, near=best)
        at_several = at_all_elements(search, fewer, search.screen(fewer))
        if is_settled:
            at_several = [each for each in at_several if each.share >= least]
        at_several.sort(key=lambda each: -each.log_evidence)
        found += [_grown(search, each) for each in _tried(search, fewer, at_several[: criteria.beam])]
    found = [each for each in found if _may_be_sure(search, each)]
    search.nodes += found
    return _with_those_seen(search, best_of(search, best, found))


def _with_those_seen(search: Search, node: Node) -> Node:
    """Return a set whose effects at all elements are at those where they are seen, if that is better."""
    for hypothesis in node.hypotheses:
        if is_of_several(hypothesis):
            member = node.member(hypothesis)
            others = node.without(member)
            node = _of_shapes_anew(search, node, (*others, member))
            some = at_those_seen(search, search.node(others, near=node), (*others, member), one_by_one=True)
            node = best_of(search, node, [some] if some is not None and _may_be_sure(search, some) else [])
    return node


def _of_shapes_anew(search: Search, node: Node, members: Sequence[Member]) -> Node:
    """Return a set with the shapes of its last effect sought anew, in its stead, where that has more evidence."""
    if not search.engine.absent.has_shape(effect_of(members[-1].hypothesis)):
        return node
    trial = search.trials.with_shapes_anew(members)
    if trial.model is node.trial.model:
        return node
    found = Node(trial, node.score + trial.log_evidence - node.trial.log_evidence)
    search.nodes[:] = [found if each is node else each for each in search.nodes]
    return found


def _tried(search: Search, fewer: Node, every: Sequence[Scored]) -> Iterator[Node]:
    """Yield sets with an effect at all elements, or at those where it is seen."""
    for each in every:
        whole = search.tried(fewer, [each])
        if whole and not whole[0].trial.refused:
            yield whole[0]
            continue
        members = as_one_cause(search, (*fewer.members, search.member(each)))
        some = None if members is None else at_those_seen(search, fewer, members)
        yield from whole if some is None else [some]


def _starts(best: Node, is_settled: bool) -> Iterable[tuple[Member, ...]]:
    """Return the sets beside which an effect at all its elements is looked for."""
    if is_settled:
        return [()] if len(best.members) > 1 else []
    known = tuple(each for each in best.members if isinstance(each.hypothesis, Known))
    return dict.fromkeys([(), known, *(tuple(e for e in known if e is not member) for member in known)])


def _may_be_sure(search: Search, node: Node) -> bool:
    """Check for known effects that predict, and explain enough by their formulas.

    Sizes at six elements, each with its form, are as free as a function: such are no better lead than what is learned.
    """
    if node.trial.refused or not (node.is_known and predicts(search, node)):
        return False
    return explained_by_formulas(search, node) >= search.criteria.explained_min


def _grown(search: Search, node: Node) -> Node:
    """Add known effects, the best first, until a set explains all.

    An effect of one sign that comes out with the other at half of its elements stands in for something else: nothing is
    looked for beside it, since what is added to it hardly turns as many.
    """
    if 2 * len(node.trial.refused) >= len(_elements(node.members[-1])):
        return node
    while len(node.members) < search.criteria.max_effects and not is_complete(search, node):
        tried = search.tried(node, beside(search, node))
        more = [each for each in tried if not each.trial.refused and needs(search, each, each.members[-1])]
        if not more:
            break
        node = max(more, key=lambda each: each.score)
    return node


def beside(search: Search, node: Node) -> list[Scored]:
    """Return the known effects beside a set that are worth a full fit, some of them at several elements."""
    screen, criteria = search.screen(node), search.criteria
    single = known_beside(search, node.trial, screen)
    every = [*at_all_elements(search, node, screen, single), *single]
    return shortlist(every, criteria.later_fits, criteria.most_of_one_effect)


def as_one_cause(search: Search, members: Sequence[Member]) -> tuple[Member, ...] | None:
    """Return a set, its last an effect at several elements, with the effect as one cause at all of them.

    Those at which the model has it already are not looked for.

    Returns
    -------
    tuple of Member or None
        The same set where its last is at one element; None where set and model do not have the effect at all elements.
    """
    *before, last = members
    if not is_of_several(last.hypothesis):
        return tuple(members)
    effect = effect_of(last.hypothesis)
    every = tuple(search.engine.base.info(effect).elements)
    there = {element for each in members if effect_of(each.hypothesis) == effect for element in _elements(each)}
    others = (each for each in before if effect_of(each.hypothesis) != effect)
    if there == set(every):
        return (*others, Member(_of_all(search, effect, every)))
    present = {element for name, element in search.trials.present_elements if name == effect}
    if there | present != set(every):
        return None
    left = Known(effect, tuple(each for each in every if each in there))
    count_kin(search, [left])
    return (*others, Member(left))


def is_at_most(search: Search, trial: Trial) -> bool:
    """Check that at most elements the last effect of a trial is more than a form of what it is at the others.

    Nor is it there with the sign that it cannot have: six drives that all lead, each by less than the limit of what is
    refused, undo a part of a gauge that is read late.
    """
    effect = effect_of(trial.members[-1].hypothesis)
    every = _elements(trial.members[-1])
    least = search.criteria.form_variance * search.trials.size(trial, Known(effect, every))
    wrong = of_wrong_sign(search, trial)
    there = (each for each in every if each not in wrong)
    return sum(search.trials.size(trial, Known(effect, (each,))) > least for each in there) >= FEWEST


def is_of_several(hypothesis: Hypothesis) -> bool:
    """Check for an effect at several elements."""
    return isinstance(hypothesis, Known) and len(hypothesis.elements) > 1


def _elements(member: Member) -> tuple[str, ...]:
    return member.hypothesis.elements if isinstance(member.hypothesis, Known) else ()


def _of_all(search: Search, effect: str, elements: tuple[str, ...]) -> Known:
    """Return an effect at all its elements, and count what is learned at all of them among its kin."""
    known = Known(effect, elements, True)
    if known.name not in search.kin:
        kin = set().union(*(search.kin.get(Known(effect, (each,)).name, set()) for each in elements))
        by_name = search.learnable.by_name
        every = (replace(by_name[each], element=ALL).name for each in kin if each in by_name)
        search.kin[known.name] = by_name.keys() & set(every)
    return known
