"""Known effects in the place of learned functions in which they live: a cause is called by its name if it has one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import NOTHING_LEFT, Member
from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.search.needed import explained_beyond, explains_by_its_formula
from hexdbb.evidence.search.place import at_its_place
from hexdbb.evidence.search.screened import add_kin
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import (
    explained_by_formulas,
    explains_nearly,
    is_doubtful,
    leaves_what_forms_do,
    misses_most,
    must_explain,
)
from hexdbb.evidence.search.sure import is_for_sure
from hexdbb.learned import ALL, Learned

FAR_BEHIND = 30.0
"""Nats by which an effect of another form is behind the function that it is not: 100 and 636 of two; 7 of friction of
which five hundred readings measured the form at 0.27."""

TRIFLE = 1e-4
"""Part of what is missing that an effect of another form may leave more than the function: 2e-5 of friction in joints
that turn over more smoothly, 3e-4 of a drive that falls behind above a speed, 2e-3 of a gauge that saturates."""


def in_known_words(search: Search, node: Node) -> Node:
    """Put known effects in the place of the learned functions that contain them, where they explain nearly as much."""
    for learned in [each for each in node.hypotheses if isinstance(each, Learned)]:
        if learned in node.hypotheses:
            others = sorted(_with_known_instead(search, node, learned), key=lambda each: -each.score)
            search.nodes += others
            node = next((each for each in others if _says_as_much(search, each, node, learned)), node)
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
        if kept and not _explains_most(search, other, node, kept):
            continue
        # What is more than any simple function is no known effect that errs by all that it explains; but it is one
        # whose formula fits as well.
        is_more = search.learnable.is_further(learned) and trial.left - node.trial.left >= NOTHING_LEFT
        if not is_more or misses_most(search, other) <= misses_most(search, node):
            yield other


def _explains_most(search: Search, node: Node, than: Node, kept: tuple[Member, ...]) -> bool:
    """Check that known effects explain most of what functions explain beside what both sets have.

    Against all that is missing, little is lost where what is small beside a large cause is called by another name.
    """
    try:
        without = search.trials.of(kept).left
    except RunError:
        return True
    return without - node.trial.left >= search.criteria.explained_min * (without - than.trial.left)


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


def _says_as_much(search: Search, node: Node, than: Node, learned: Learned) -> bool:
    """Check that a set predicts, and is not excused from it where another is not.

    A free function of time claims nothing of what was left out: any formula that is hardly bent says more. One that
    predicts says what it is itself: an effect that explains it by functions of its form, not by its formula, says less.
    """
    is_no_such = _is_by_form(search, node, learned) or _is_of_another_form(search, node, than)
    if is_no_such and not is_doubtful(search, than):
        return False
    if _is_elsewhere(search, node, learned) and than.score - node.score > search.criteria.margin_nats:
        return False
    if _leaves_more(search, node, than, learned):
        return False
    if than.trial.is_of_time:
        return all(form is None or not form.is_odd for form in node.trial.forms)
    one, other = search.checked(node), search.checked(than)
    return not one.reasons and one.excused <= other.excused


def _is_by_form(search: Search, node: Node, learned: Learned) -> bool:
    """Check for one known effect of another form, or elsewhere than a function, whose formula explains hardly anything.

    Of a lead of the function's own slider geometry may take all but the form, and it is a lead nevertheless.
    """
    known, *others = node.hypotheses
    if others or not isinstance(known, Known) or (form := node.trial.forms[0]) is None:
        return False
    is_other = form.is_odd or not acts_there(search, known, learned)
    return is_other and explained_by_formulas(search, node) < search.criteria.formula_names


def _is_of_another_form(search: Search, node: Node, than: Node) -> bool:
    """Check for one known effect whose form is measured well, is quite another, and has far less evidence.

    However much its formula explains, it is no such effect: a drive that falls behind above a speed only. Unless that
    is nearly all, and its form leaves what the function does: friction of joints that turn over more smoothly.
    """
    if len(node.members) > 1 or than.score - node.score <= FAR_BEHIND:
        return False
    more = (node.trial.left - than.trial.left) / (search.root.trial.left - 1.0)
    if more < TRIFLE and explained_by_formulas(search, node) >= search.criteria.form_explains:
        return False
    (form,) = node.trial.forms
    return form is not None and form.is_odd and form.is_seen


def _is_elsewhere(search: Search, node: Node, learned: Learned) -> bool:
    """Check for one known effect that acts elsewhere than a function does, so that its form is no excuse.

    The ball of one leg's joint has lobes; the joint off its place, of this leg or of the other in the pair, said nearly
    all of it by functions of its form. One whose formula explains nearly all asks for no excuse: a joint off its place
    changes the length of its leg by the direction of that in the platform.
    """
    known, *others = node.hypotheses
    is_elsewhere = not others and isinstance(known, Known) and not acts_there(search, known, learned)
    return is_elsewhere and not leaves_what_forms_do(search, node)


def acts_there(search: Search, known: Known, learned: Learned) -> bool:
    """Check that a known effect pushes what a function pushes."""
    return learned.port in search.engine.absent.ports(known.effect) and (
        known.is_whole or learned.element == ALL or str(learned.element) in known.elements
    )


def _leaves_more(search: Search, node: Node, than: Node, learned: Learned) -> bool:
    """Check for a known effect that leaves more than its form may, and whose formula explains too little to be a cause.

    A rail that is kinked at one place explained 99 % as a bow, by smooth functions of the bow's form; a hundredth of
    the kink is more than a bow's form leaves. So is geometry bent far beyond its priors: a ball with lobes left two
    thirds of the noise's variance as a joint off its place, and geometry off by as much as three of it.

    One that is looked at last was so because known effects left more: what pushes a joint upward after reversals was
    play of its slider, which left three variances more. But not a free function of time, which leaves less of whatever
    drifts, and predicts none of it.

    Beside other functions it is one that leaves more, and of which the formula says little: a dent is no bow. Beside
    other effects, all of them for sure, the formula must say most of what the function does: a leg that a motor shakes
    most at one speed is no pitch error of its slider, however little either is against the ball that sits otherwise.
    """
    if node.is_known and len(node.members) > 1:
        if (new := _new_with_form(node, than)) is None or not _is_more_than_forms(search, node, than):
            return False
        return not _formula_says_it(search, node, than, *new) and is_for_sure(search, node)
    if not node.is_known:
        return _is_more_than_forms(search, node, than) and _is_mostly_form(search, node, than)
    is_last = search.learnable.is_further(learned) and not than.trial.is_of_time
    is_little = explained_by_formulas(search, node) < search.criteria.explained_min
    return _is_more_than_forms(search, node, than) and (is_last or is_little)


def _is_more_than_forms(search: Search, node: Node, than: Node) -> bool:
    """Check that a set leaves more than another by what a further effect must explain."""
    beyond = explained_beyond(search, than.trial, node.trial)
    return beyond > max(must_explain(search, node.trial), NOTHING_LEFT)


def _is_mostly_form(search: Search, node: Node, than: Node) -> bool:
    """Check for one known effect, new beside functions, whose formula explains too little of what it does to be one."""
    if (found := _new_with_form(node, than)) is None:
        return False
    new, form = found
    others = search.trials.of_fewer(node.without(new), node.trial)
    return not explains_by_its_formula(search, node, form, others, search.criteria.explained_min)


def _formula_says_it(search: Search, node: Node, than: Node, new: Member, form: Form) -> bool:
    """Check for an effect, new beside others, whose formula explains most of what a function explains there."""
    others = search.trials.of_fewer(node.without(new), node.trial).left
    by_formula = others - search.left_by_formula(node.trial, form)
    return by_formula >= search.criteria.explained_min * (others - than.trial.left)


def _new_with_form(node: Node, than: Node) -> tuple[Member, Form] | None:
    """Return the one member that another set does not have, and its form; None where it is not one, or has none."""
    new = [each for each in node.members if each.hypothesis not in than.hypotheses]
    form = node.trial.forms[node.members.index(new[0])] if len(new) == 1 else None
    return None if form is None else (new[0], form)


def _is_at(one: Hypothesis, learned: Learned) -> bool:
    return isinstance(one, Learned) and (one.place, one.element) == (learned.place, learned.element)


def _in_their_place(search: Search, hypotheses: Sequence[Hypothesis]) -> Iterator[tuple[Known, ...]]:
    """Yield known effects that live in some hypotheses; for a function that two elements share, one effect at both."""
    yield from ((known,) for known in known_for(search, [each.name for each in hypotheses]))
    for each in hypotheses:
        if isinstance(each, Learned) and each.of_each:
            one, other = (known_for(search, [alone.name]) for alone in each.of_each)
            yield from (both for both in product(one, other) if both[0].effect == both[1].effect and both[0] != both[1])


def known_for(search: Search, names: list[str]) -> list[Known]:
    """Return the known effects that live in one of some learned hypotheses, by what each explains of the readings."""
    found = []
    for name, kin in search.kin.items():
        if kin & set(names):
            effect, _, elements = name.partition(":")
            every = tuple(search.engine.base.info(effect).elements)
            found.append(Known(effect, tuple(elements.split(":")) if elements else every, not elements))
    return found
