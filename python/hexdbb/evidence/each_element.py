"""Six elements that depend on one state, each in its own way: legs that swing with the room, six drives that lag.

Of such a machine one element explains a part, and what moves in several directions, the cup or a joint, explains more:
what all six do together is looked at here, for every state that elements of one place have, where what was found leaves
more than the noise. The function of each element is free, so that the state is what is claimed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from hexdbb.evidence.last_resort import needs_no_other
from hexdbb.evidence.needed import explains_more
from hexdbb.evidence.node import Node
from hexdbb.evidence.refine import finely_tuned
from hexdbb.evidence.screen import Screen
from hexdbb.evidence.settling import predicts
from hexdbb.evidence.signatures import varying
from hexdbb.evidence.thinned import Thinned
from hexdbb.learned import Learned
from hexdbb.learned.places import ALL, EACH, SHARED, members

if TYPE_CHECKING:
    from hexdbb.evidence.search import Search

FITTED = 2
"""States that are fitted in full: a position and what resembles it may rank by their sharpness."""


def or_at_each_element(search: Search, node: Node) -> Node:
    """Return six elements with functions of one state, where they have more evidence than a set and leave far less.

    Parameters
    ----------
    search : Search
    node : Node
        Returned unchanged where it explains and predicts all but the noise, or nothing is learned.
    """
    if not search.learns or needs_no_other(search, node):
        return node
    screen = search.screen(search.root)
    few = Thinned(search.engine.readings, search.criteria.thinned_rows, search.criteria.ranking_roughness, keeps=False)
    ranked = Screen(screen.sums, search.criteria, few).ranked([*varying(_every(search), search.engine.readings)])
    tried = search.tried(search.root, [screen.scored(each) for each in ranked[:FITTED]])
    found = [finely_tuned(search, each) for each in tried]
    better = [each for each in found if _stands_before(search, each, node)]
    search.nodes += better
    return max(better, key=lambda each: each.score, default=node)


def _stands_before(search: Search, each: Node, node: Node) -> bool:
    """Check that six functions have more evidence than a set, leave far less of what that leaves, and explain all.

    Nearly all is not enough: six functions follow the platform wherever it goes, and those of five legs describe what
    the state of the sixth, which is at fault, is not quite.
    """
    is_more = each.score - node.score > search.criteria.margin_nats
    is_less = each.trial.left - 1.0 < search.criteria.far_better * (node.trial.left - 1.0)
    is_all = is_more and is_less and not each.trial.refused and predicts(search, each) and needs_no_other(search, each)
    return is_all and _is_of_more_than_one(search, each)


def _is_of_more_than_one(search: Search, each: Node) -> bool:
    """Check that no element alone, by its function of the same state, explains as much but for what forms may hide."""
    (function,) = each.hypotheses
    assert isinstance(function, Learned)
    alone = [replace(function, element=element) for element in members(function.element)]
    screen = search.screen(search.root)
    best = screen.ranked([*varying(alone, search.engine.readings)])[:1]
    tried = search.tried(search.root, [screen.scored(one) for one in best])
    return all(explains_more(search, each, finely_tuned(search, one)) for one in tried)


def _every(search: Search) -> Iterator[Learned]:
    """Yield the functions of every state that all elements of a place have, and of the periods that were found.

    Six free functions of time are whatever drifts: they claim nothing, and stand before nothing here.
    """
    listed = (*search.learnable.simple, *search.learnable.further.values())
    for place in SHARED:
        variables = [each.variable for each in listed if each.place == place and each.element != ALL]
        periods = [each.variable for each in _functions(search) if each.is_of_time and each.variable.period]
        for variable in dict.fromkeys((*variables, *periods)):
            each = Learned(place, EACH, variable)
            is_free = each.is_of_time and not variable.period
            if not (variable.of_element or is_free) and each.size <= search.criteria.most_tuned:
                yield each


def _functions(search: Search) -> Iterator[Learned]:
    """Yield the learned functions of all sets that were fitted."""
    yield from (each for node in search.nodes for each in node.hypotheses if isinstance(each, Learned))
