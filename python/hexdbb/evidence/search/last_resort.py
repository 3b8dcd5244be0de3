"""What a search looks at last: fine functions of the lists, then every state at every place and products of any two.

There are thousands of them, and most say nearly what a listed one does. They are looked at only where what was found
leaves something, and one that says no more than that stays out of the search, where it would be a rival of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Trial
from hexdbb.evidence.linear.screen import Scored, Screen
from hexdbb.evidence.search.refine import finely_tuned
from hexdbb.evidence.search.screened import add_kin, screened_anew, screened_crossed, screened_finer
from hexdbb.evidence.search.settling import explained_by_formulas, is_complete, leaves_room, predicts
from hexdbb.evidence.search.shortlist import shortlist
from hexdbb.evidence.search.sure import is_for_sure
from hexdbb.learned import Learned
from hexdbb.learned.following import TURNING

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

TUNED = 2
"""Sets that are tuned before they are left, by several full fits each: both sliders of a guideway may say the same."""

AS_MUCH = 0.9
"""Part of what a set's explained squares are worth as evidence that what is fitted in its place must have to first
order. Pairs and sixes of elements that replaced a set, or came near to it, had 0.98 to 1.12 of it; those that had less
than 0.9 left 1.6 to thirty times as much."""

Screened = Callable[["Search", Trial, Screen], list[Scored]]


def needs_no_other(search: Search, best: Node) -> bool:
    """Check that a set explains all: known effects for sure, or functions that leave, and err by, little but noise.

    Known effects that are not for sure, or leave more than their forms hide where their formulas do not explain nearly
    all, and a function of another state or place, however fine, stand in for what is looked at last.
    """
    if not is_complete(search, best):
        return False
    if best.is_known:
        by_formulas = explained_by_formulas(search, best) >= search.criteria.form_explains
        return is_for_sure(search, best) and (by_formulas or not leaves_room(search, best))
    if not best.trial.left < search.criteria.leaves_more:
        return False
    checked, enough = search.checked(best), search.criteria.predicted_to
    # What errs no more than its fit expects errs by what the other readings do not determine. Nothing errs less there,
    # but what is less free: a ball that goes anywhere with the angle stood for two balls, each with a law of its own.
    along_one = axes_along(best) <= len(best.members)
    held = (checked.heldout[each] for each in checked.claimed)
    return all(each.after <= (max(enough, each.expected) if along_one else enough) for each in held)


def as_much_as(search: Search, node: Node, rows: int | None = None, part: float = AS_MUCH) -> float:
    """Return the evidence to first order, on so many rows or all, below which nothing explains as much as a set does.

    A part of what the set explains, counted as screening does: the rest is what values cost.
    """
    rows = len(search.engine.readings) if rows is None else rows
    explained: float = (search.root.trial.left - node.trial.left) / search.screen(search.root).temper
    return part * 0.5 * rows * explained


def explains_in_a_sweep(search: Search, best: Node) -> bool:
    """Check that a set explains all, for sure or not: what is another with each sweep contains what stays in one.

    Beside known effects that explain all, though not for sure, further functions are looked at next, such as a holder
    that falls over with the platform's tilt.
    """
    return needs_no_other(search, best) or (best.is_known and is_complete(search, best))


LAST_RESORTS: tuple[tuple[Screened, Callable[[Search, Node], bool]], ...] = (
    (screened_finer, is_complete),
    (screened_crossed, needs_no_other),
    (screened_anew, explains_in_a_sweep),
)
"""What is screened last, in this order, and what tells that a set needs none of it."""


def tried_last(search: Search, node: Node, screened: Screened, best: Node) -> list[Node]:
    """Return sets with such a function beside known effects that predict, or beside nothing.

    Parameters
    ----------
    search : Search
    node : Node
        The set beside which they are screened.
    screened : callable
        One of `LAST_RESORTS`.
    best : Node
        The best set found so far.
    """
    if not (node.is_known and predicts(search, node)):
        return []
    criteria = search.criteria
    count = criteria.full_fits if node is search.root else criteria.later_fits
    screen = search.screen(node)
    scored = screened(search, node.trial, screen)
    chosen = shortlist(scored, count, criteria.most_of_one_effect)
    # Those of the lists are kin by as many splines as they have there: with more of them they contain anything.
    learned = (each.hypothesis for each in chosen if isinstance(each.hypothesis, Learned))
    if crossed := [each for each in learned if search.learnable.is_crossed(each)]:
        add_kin(search, crossed)
    every = search.tried(node, chosen)
    found = [each for each in every if stands_before(search, each, best)]
    if not found:
        found = [each for each in _tuned(search, every) if stands_before(search, each, best)]
    found = [_or_as_listed(search, node, screen, each) for each in found]
    search.nodes += [each for each in found if not any(each is other for other in search.nodes)]
    return found


def _or_as_listed(search: Search, base: Node, screen: Screen, node: Node) -> Node:
    """Return the same state at a listed place of the element, tuned, unless the set with it elsewhere stands before.

    What is listed was screened with abrupt changes of sign and few splines, and may have been far behind.
    """
    last = next((each for each in node.hypotheses if search.learnable.is_crossed(each)), None)
    if not isinstance(last, Learned):
        return node
    every = (each for each in search.learnable.by_name.values() if not search.learnable.is_crossed(each))
    same = [each for each in every if state_of(each) == state_of(last)]
    listed = search.tried(base, [screen.scored(each) for each in same])
    if not listed:
        return node
    best = finely_tuned(search, max(listed, key=lambda each: each.score))
    return node if stands_before(search, finely_tuned(search, node), best) else best


def state_of(hypothesis: Learned) -> tuple[int, str]:
    """Return the element and the variable, whether its change of sign is gradual or not."""
    return hypothesis.element, hypothesis.variable.name.partition(f"_{TURNING}@")[0]


def _tuned(search: Search, every: Sequence[Node]) -> Iterator[Node]:
    """Yield the sets with the most evidence with their functions tuned: what was found before may be so already."""
    excess = search.root.trial.left - 1.0
    for each in sorted(every, key=lambda each: -each.score)[:TUNED]:
        if search.root.trial.left - each.trial.left >= search.criteria.explained_min * excess:
            yield finely_tuned(search, each)


def stands_before(search: Search, node: Node, best: Node) -> bool:
    """Check that a set with a function looked at last is not one of the many that explain what listed ones do.

    It has more evidence, and pushes along fewer axes, or leaves far less of what those leave beyond the noise.
    """
    is_last = any(search.learnable.is_crossed(each) for each in node.hypotheses)
    if not (is_last and best.members) or (best.is_known and not is_complete(search, best)):
        return True
    if node.score - best.score <= search.criteria.margin_nats:
        return False
    left, before = node.trial.left - 1.0, best.trial.left - 1.0
    is_less = before > search.criteria.leaves_more - 1.0 and left < search.criteria.far_better * before
    return is_less or axes_along(node) < axes_along(best)


def axes_along(node: Node) -> int:
    """Return along how many axes the functions of a set push."""
    return sum(each.components for each in node.hypotheses if isinstance(each, Learned))
