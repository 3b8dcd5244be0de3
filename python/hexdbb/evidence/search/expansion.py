"""What may be missing beside a set: hypotheses screened, the best of them fitted in full, one more than the set has."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Known, Scored, Screen
from hexdbb.evidence.search.by_formulas import are_what_they_are
from hexdbb.evidence.search.known_together import or_known_together
from hexdbb.evidence.search.screened import in_other_words, screened, screened_further
from hexdbb.evidence.search.settling import settles
from hexdbb.evidence.search.shortlist import shortlist
from hexdbb.learned.places import INSTRUMENT

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search


def expanded(search: Search, node: Node, learns: bool | None = None) -> list[Node]:
    """Return sets with one hypothesis more than a set, the best first; none where as many were expanded as may be.

    Parameters
    ----------
    search : Search
        Keeps what was found.
    node : Node
    learns : bool, optional
        Whether learned functions are looked at; as the search does where not given.
    """
    learns = search.learns if learns is None else learns
    key = frozenset(node.trial.names), learns
    if key not in search.expanded:
        if len(search.expanded) >= search.criteria.most_expansions:
            return []
        screen = search.screen(node)
        found = _children(search, node, screen, learns)
        search.nodes += found
        if learns and not any(settles(search, each) for each in found) and not _are_known(search, node, found):
            further = _further(search, node, screen)
            search.nodes += further
            found += further
        search.expanded[key] = sorted(found, key=lambda each: -each.score)
    return search.expanded[key]


def _children(search: Search, node: Node, screen: Screen, learns: bool) -> list[Node]:
    known, learned = screened(search, node.trial, screen, learns=learns)
    count, most = _fits_of(search, node), search.criteria.most_of_one_effect
    chosen = [*shortlist(known, count, most), *shortlist(learned, count, most)]
    found = search.tried(node, [*chosen, *in_other_words(search, known, learned, chosen)])
    if learns and node is search.root and not any(settles(search, each) for each in found):
        found += search.tried(node, [each for each in known if _is_of_all(search, each) and each not in chosen])
    return found


def _further(search: Search, node: Node, screen: Screen) -> list[Node]:
    further = screened_further(search, node.trial, screen)
    return search.tried(node, shortlist(further, _fits_of(search, node), search.criteria.most_of_one_effect))


def _fits_of(search: Search, node: Node) -> int:
    return search.criteria.full_fits if node is search.root else search.criteria.later_fits


def _are_known(search: Search, node: Node, alone: Sequence[Node]) -> bool:
    """Check for known effects, chosen together, that are what they are by formulas: they are looked at first.

    They must have more evidence than whatever was tried alone. Finer functions, and those of more states, are then
    only more values that say the same.
    """
    if node is search.root and alone:
        found = or_known_together(search, max(alone, key=lambda each: each.score))
        search.sure_together = found if are_what_they_are(search, found) else None
    return node is search.root and search.sure_together is not None


def _is_of_all(search: Search, scored: Scored) -> bool:
    """Check for an effect that all legs or sliders share, at the machine's end of the measuring loop.

    Geometry takes what they do alike, and what is seen is how they differ, its form, by which it is not screened:
    legs that grow unequally were a guideway that grows.
    """
    known = scored.hypothesis
    return isinstance(known, Known) and known.is_whole and not search.engine.absent.ports(known.effect) <= INSTRUMENT
