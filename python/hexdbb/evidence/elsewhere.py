"""Whether the ball bar may be the cause rather than the machine, or the machine rather than the ball bar.

A known effect is put in the place of a learned function that contains its form. Where the two push at different ends of
the measuring loop, they are different causes: legs that grow alike, and a gauge that drifts.
"""

from __future__ import annotations

from hexdbb.evidence.node import Node
from hexdbb.evidence.screen import Hypothesis, Known
from hexdbb.evidence.search import Search
from hexdbb.learned import Learned

INSTRUMENT = frozenset({"reading", "ball", "cup"})
"""Ports of the ball bar and its set-up; all others are the machine's."""


def rivals_elsewhere(search: Search, node: Node, cause: Known) -> list[str]:
    """Return sets in which a learned function at the other end stands for a cause, with more evidence.

    Parameters
    ----------
    search : Search
    node : Node
        Set that the cause belongs to.
    cause : Known
    """
    kin = search.kin.get(cause.name, set())
    # A gauge that is read late reads like all sliders ahead of it, and is the instrument's.
    is_set_up = search.engine.base.info(cause.effect).is_set_up
    is_instrument = is_set_up or search.engine.absent.ports(cause.effect) <= INSTRUMENT
    found = []
    for other in search.nodes:
        stands_in = [h for h in other.hypotheses if _is_elsewhere(h, kin, is_instrument)]
        lead = (other.score - node.score) / max(node.trial.left, 1.0)
        more = lead > search.criteria.margin_nats and len(other.members) <= len(node.members)
        if stands_in and more and not (other.trial.refused or search.checked(other).reasons):
            found.append(" + ".join(other.trial.names))
    return found


def _is_elsewhere(hypothesis: Hypothesis, kin: set[str], is_instrument: bool) -> bool:
    if not isinstance(hypothesis, Learned) or hypothesis.name not in kin:
        return False
    return ({hypothesis.port} <= INSTRUMENT) != is_instrument
