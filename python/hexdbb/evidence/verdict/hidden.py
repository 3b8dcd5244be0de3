"""What the form of a known effect hides: another known effect, at the same place.

Play of 10 µm beside spikes of 30 µm after the same reversals is play of 15 µm whose form is off by four tenths: the
functions of a form describe another effect there as well as its own errors. Both by their own forms are the simpler
answer.
"""

from __future__ import annotations

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.search.needed import is_better, needs_all
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.known_words import known_for


def with_what_forms_hide(search: Search, node: Node) -> Node:
    """Add known effects to those of quite another form at their places, where all are then of their own forms."""
    wider = node
    for member in node.members:
        wider = _with_another_there(search, wider, member)
    is_sound = wider is not node and needs_all(search, wider) and not search.checked(wider).reasons
    return wider if is_sound else node


def _with_another_there(search: Search, node: Node, member: Member) -> Node:
    """Add the known effect that explains most beside one of quite another form; both are then of their own."""
    criteria = search.criteria
    form = node.trial.forms[node.members.index(member)]
    if form is None or not form.is_odd or len(node.members) >= criteria.max_effects:
        return node
    found = []
    for known in known_for(search, list(form.functions)):
        if known in node.hypotheses:
            continue
        try:
            trial = search.trials.of((*node.members, Member(known)))
        except RunError:
            continue
        forms = (trial.forms[node.members.index(member)], trial.forms[-1])
        are_own = all(each is not None and not each.is_odd for each in forms)
        other = Node(trial, node.score + trial.log_evidence - node.trial.log_evidence)
        if are_own and not trial.refused and is_better(search, other, node):
            found.append(other)
    search.nodes += found
    return max(found, key=lambda each: each.score, default=node)
