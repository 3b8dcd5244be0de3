"""Six elements that depend on one state, each in its own way: legs that swing with the room, six drives that lag.

Of such a machine one element explains a part, and what moves in several directions, the cup or a joint, explains more:
what all six do together is looked at here, for every state that elements of one place have, where what was found leaves
more than the noise. The function of each element is free, so that the state is what is claimed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Screen, may_be_finer
from hexdbb.evidence.linear.signatures import varying
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.evidence.search.last_resort import as_much_as, needs_no_other
from hexdbb.evidence.search.needed import explains_more
from hexdbb.evidence.search.refine import finely_tuned
from hexdbb.evidence.search.settling import errs_as_expected, predicts
from hexdbb.evidence.search.tuned import with_tuned_numbers
from hexdbb.learned import Learned
from hexdbb.learned.places import ALL, EACH, SHARED, members

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

FITTED = 2
"""States that are fitted in full: a position and what resembles it may rank by their sharpness."""
FINER = 4
"""Multiple of the splines with which functions are looked at besides, where they may be finer: six joints whose balls
have nineteen lobes show nothing with twelve splines, and so no rank would tell which to look at."""


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
    tuned = _tuned(search, node)
    if needs_no_other(search, tuned):
        return node
    screen = search.screen(search.root)
    few = Thinned(search.engine.readings, search.criteria.thinned_rows, search.criteria.ranking_roughness, keeps=False)
    ranked = Screen(screen.sums, search.criteria, few).ranked([*varying(_every(search), search.engine.readings)])
    best = {each.name: each for each in reversed(ranked)}
    chosen = [each for each in ranked if best[each.name] is each][:FITTED]
    least = as_much_as(search, tuned)
    scored = (screen.scored(each) for each in chosen)
    tried = search.tried(search.root, [each for each in scored if each.log_evidence >= least])
    most = search.root.trial.left - search.criteria.form_explains * (search.root.trial.left - 1.0)
    found = [finely_tuned(search, each) for each in tried if each.trial.left < most]
    better = [each for each in found if _stands_before(search, each, tuned)]
    search.nodes += better
    return max(better, key=lambda each: each.score, default=node)


def _tuned(search: Search, node: Node) -> Node:
    """Return a set with its best periods and time constants, to compare with: other steps tune it in their order.

    A period that is nearly right leaves what six functions by a better one do not.
    """
    before = [*search.nodes]
    tuned = with_tuned_numbers(search, node)
    search.nodes[:] = before
    return tuned


def _stands_before(search: Search, each: Node, node: Node) -> bool:
    """Check that six functions have more evidence than a set, leave far less of what that leaves, and explain all.

    Nearly all is not enough: six functions follow the platform wherever it goes, and those of five legs describe what
    the state of the sixth, which is at fault, is not quite.
    """
    is_more = each.score - node.score > search.criteria.margin_nats
    is_less = each.trial.left - 1.0 < search.criteria.far_better * (node.trial.left - 1.0)
    is_all = is_more and is_less and not each.trial.refused and predicts(search, each) and _is_exact(search, each)
    return is_all and _is_of_more_than_one(search, each)


def _is_exact(search: Search, each: Node) -> bool:
    """Check that a set leaves no structure, and errs on what is left out as it expects of itself."""
    return each.trial.left < search.criteria.leaves_structure and errs_as_expected(search, each)


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
    """Yield the functions of every simple state that elements of a place have, and of the periods that were found.

    Six free functions of time are whatever drifts: they claim nothing, and stand before nothing here.
    """
    simple = [each for each in search.learnable.simple if each.element != ALL]
    for place in SHARED:
        variables = [each.variable for each in simple if each.place == place and not each.variable.of_neighbour]
        periods = [each.variable for each in _functions(search) if each.is_of_time and each.variable.period]
        for variable in dict.fromkeys((*variables, *periods)):
            each = Learned(place, EACH, variable)
            if variable.of_element or (each.is_of_time and not variable.period):
                continue
            finer = [each.finer(FINER)] if may_be_finer(variable) else []
            yield from (one for one in (each, *finer) if one.size <= search.criteria.most_of_each)


def _functions(search: Search) -> Iterator[Learned]:
    """Yield the learned functions of all sets that were fitted."""
    yield from (each for node in search.nodes for each in node.hypotheses if isinstance(each, Learned))
