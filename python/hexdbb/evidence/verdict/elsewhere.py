"""Rivals of a known effect at another place: at the other end of the measuring loop, or at another leg.

A known effect is put in the place of a learned function that contains its form. Where the two push at different ends of
the measuring loop, they are different causes: legs that grow alike, and a gauge that drifts. So are a ball with lobes
in the joint of one leg, and a displaced joint of the other leg that explains a third of it by functions of its form.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.place import kin_of
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import explained_by_formulas
from hexdbb.learned import ALL
from hexdbb.learned.places import INSTRUMENT, members


def rivals_elsewhere(search: Search, node: Node, cause: Known, alike: Sequence[str]) -> list[str]:
    """Return sets in which a learned function elsewhere stands for a cause, with no less evidence.

    Of some hundred known effects of other forms the nearest such set had 220 nats less; that a cup creeps had 2 more
    than a screw that cools, which was named for sure.

    Parameters
    ----------
    search : Search
    node : Node
        Set that the cause belongs to.
    cause : Known
    alike : sequence of str
        Sets with its effect at other elements that say the same.
    """
    same = {element for name in alike for effect, _, element in _named(name) if effect == cause.effect}
    elsewhere = {*_at_other_end(search, cause), *_at_other_elements(search, node, cause, {*cause.elements, *same})}
    found = []
    for other in search.nodes:
        lead = (other.score - node.score) / max(node.trial.left, 1.0)
        is_close = lead > -search.criteria.margin_nats and len(other.members) <= len(node.members)
        stands_in = cause not in other.hypotheses and not elsewhere.isdisjoint(other.trial.names)
        if stands_in and is_close and not (other.trial.refused or search.checked(other).reasons):
            found.append(" + ".join(other.trial.names))
    return found


def _at_other_end(search: Search, cause: Known) -> Iterator[str]:
    """Yield the functions that contain a cause's form and push at the other end of the measuring loop."""
    # A gauge that is read late reads like all sliders ahead of it, and is the instrument's.
    is_set_up = search.engine.base.info(cause.effect).is_set_up
    is_instrument = is_set_up or search.engine.absent.ports(cause.effect) <= INSTRUMENT
    yield from (each.name for each in kin_of(search, cause) if ({each.port} <= INSTRUMENT) != is_instrument)


def _named(name: str) -> Iterator[tuple[str, str, str]]:
    """Yield effect, colon and element of each member in the name of a set."""
    yield from (each.partition(":") for each in name.split(" + "))


def _at_other_elements(search: Search, node: Node, cause: Known, elements: set[str]) -> Iterator[str]:
    """Yield the functions at none of some elements, if the effect is the only cause and its formula leaves much.

    Beside other causes the functions of an effect's form also describe what those leave.
    """
    is_one = len(node.members) == 1 and not cause.is_whole
    if not is_one or explained_by_formulas(search, node) >= search.criteria.form_explains:
        return
    kind = search.engine.base.info(cause.effect).element_kind
    alike = (each for each in kin_of(search, cause) if each.kind == kind and each.element != ALL)
    yield from (each.name for each in alike if elements.isdisjoint(map(str, members(each.element))))
