"""Whether one state alone says more than a known effect that is a product of two.

A screw that warms moves its slider in proportion to its length: by time and position. An encoder's reading that drifts
does so by time alone. Over a short travel the two are nearly one, and a free function of time is no rival of what
predicts; but if, in the effect's stead, it has more evidence than the effect with all that its form may be off, the
readings do not ask for the other state.
"""

from __future__ import annotations

from collections.abc import Iterator

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.search.place import homes_of
from hexdbb.evidence.search.search import Search
from hexdbb.learned import Learned
from hexdbb.learned.places import EACH


def of_one_state(search: Search, node: Node, cause: Known) -> Iterator[str]:
    """Yield sets with a function of one state in place of a cause that is one of two, if they have more evidence.

    Parameters
    ----------
    search : Search
    node : Node
        The chosen set.
    cause : Known
        One of its hypotheses.
    """
    others = {*node.hypotheses} - {cause}
    for other in search.nodes:
        instead = {*other.hypotheses} - others
        if len(other.members) != len(node.members) or len(instead) != 1 or other.trial.refused:
            continue
        lead = (node.score - other.score) / max(node.trial.left, 1.0)
        if lead >= -search.criteria.margin_nats or not _is_of_one(search, cause, instead.pop()):
            continue
        # A free function of time claims no other feed's, beside whatever it stands.
        if other.trial.is_free_in_time or not search.checked(other).reasons:
            yield " + ".join(other.trial.names)


def _is_of_one(search: Search, cause: Known, function: Hypothesis) -> bool:
    """Check for a function of one of the two states of an effect, at its place, that does not contain the effect.

    Those of all six elements contain that of the effect's own.
    """
    if not isinstance(function, Learned) or function.parts or search.same_kind(cause, function):
        return False
    if function.element == EACH:
        return False
    states = (state for home in homes_of(search, cause) for state in home.parts)
    return any(
        (each.place, each.element, each.variable.column) == (function.place, function.element, function.variable.column)
        for each in states
    )
