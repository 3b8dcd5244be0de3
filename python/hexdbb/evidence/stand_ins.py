"""Known effects beside a learned function that stood in for how the machine's form differs from it.

Found before the function was refined, such an effect explains what its further splines and the other functions at its
place describe after: a joint off its place beside a guideway that bows by less and less as it warms.
"""

from __future__ import annotations

from hexdbb.errors import RunError
from hexdbb.evidence.needed import needs
from hexdbb.evidence.node import Node
from hexdbb.evidence.refine import refined
from hexdbb.evidence.screen import Known
from hexdbb.evidence.search import Search
from hexdbb.evidence.settling import must_explain


def without_stand_ins(search: Search, node: Node, wider: Node) -> tuple[Node, Node]:
    """Leave out the known effects that the refined functions of the others need no more.

    Parameters
    ----------
    search : Search
    node : Node
        Of the verdict.
    wider : Node
        The same refined.

    Returns
    -------
    node, wider : Node
        The others, as they were and refined by functions at their own places alone.
    """
    for member in node.members:
        if node.is_known or not isinstance(member.hypothesis, Known) or needs(search, wider, member):
            continue
        try:
            others = search.node(node.without(member), near=node)
            again = refined(search, others)
        except RunError:
            continue
        if _says_the_same(search, again, wider):
            node, wider = others, again
    return node, wider


def _says_the_same(search: Search, node: Node, wider: Node) -> bool:
    """Check that a set leaves no more than forms may hide of what another explains, and predicts."""
    more = node.trial.left - wider.trial.left
    if node.trial.refused or more >= search.criteria.secondary * must_explain(search, node.trial):
        return False
    return not search.checked(node).reasons
