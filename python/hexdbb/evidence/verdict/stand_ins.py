"""Known effects beside a learned function that stood in for how the machine's form differs from it.

Found before the function was refined, such an effect explains what its further splines and the other functions at its
place describe after: a joint off its place beside a guideway that bows by less and less as it warms.
"""

from __future__ import annotations

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.needed import needs
from hexdbb.evidence.search.refine import refined
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import must_explain
from hexdbb.learned import Learned, part_of
from hexdbb.learned.places import members


def without_stand_ins(search: Search, node: Node, wider: Node) -> tuple[Node, Node]:
    """Leave out the hypotheses that the refined functions of the others need no more.

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
        if not _may_stand_in(node, member) or _is_needed(search, wider, member):
            continue
        try:
            others = search.node(node.without(member), near=node)
            again = refined(search, others)
        except RunError:
            continue
        if _says_the_same(search, again, wider):
            node, wider = others, again
    return node, wider


def _may_stand_in(node: Node, member: Member) -> bool:
    """Check for a known effect beside a function, or one that several elements share beside one of some of them."""
    one = member.hypothesis
    if isinstance(one, Known):
        return not node.is_known
    others = [each.hypothesis for each in node.members if isinstance(each.hypothesis, Learned)]
    return any(part_of(each) == part_of(one) and {*members(each.element)} < {*members(one.element)} for each in others)


def _is_needed(search: Search, wider: Node, member: Member) -> bool:
    """Check that a known effect is needed beside refined functions; a function describes whatever these would."""
    return isinstance(member.hypothesis, Known) and needs(search, wider, member)


def _says_the_same(search: Search, node: Node, wider: Node) -> bool:
    """Check that a set leaves no more than forms may hide of what another explains, predicts, and is as likely.

    Functions of the reading's angles say whatever repeats: beside many of them nothing else is needed.
    """
    more = node.trial.left - wider.trial.left
    if node.trial.refused or more >= search.criteria.secondary * must_explain(search, node.trial):
        return False
    if node.score < wider.score - search.criteria.margin_nats:
        return False
    return not search.checked(node).reasons
