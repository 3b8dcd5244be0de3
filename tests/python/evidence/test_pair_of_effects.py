"""A function that two neighbours share is one known effect at both, where that explains nearly as much."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.verdict.known_words import in_known_words
from hexdbb.learned import Learned

SHARED = Member(Learned.parse("learned:slider:1-2:position"))
LEADS = (Known("lead_error", ("1",)), Known("lead_error", ("2",)))


def searched(left: float) -> tuple[Any, Node]:
    """Return a search in which nothing leaves 11, the shared function 1.01, and both leads so much; one lead 6."""

    def trial_of(members: Sequence[Member]) -> Any:
        known = {each.hypothesis for each in members}
        value = left if known == {*LEADS} else 1.01 if SHARED in members else 6.0
        evidence = -1000.0 * value
        return SimpleNamespace(
            members=tuple(members), left=value, log_evidence=evidence, refused=(), is_of_time=False, forms=()
        )

    found = trial_of([SHARED])
    node = Node(found, found.log_evidence)
    infos = SimpleNamespace(info=lambda effect: SimpleNamespace(elements=("1", "2", "3")))
    search = SimpleNamespace(
        criteria=DEFAULT,
        nodes=[node],
        root=SimpleNamespace(trial=SimpleNamespace(left=11.0)),
        trials=SimpleNamespace(of=trial_of),
        engine=SimpleNamespace(base=infos),
        kin={
            "lead_error:1": {"learned:slider:1:position"},
            "lead_error:2": {"learned:slider:2:position"},
            "screw_thermal:1": {"learned:slider:1:position"},
        },
        learnable=SimpleNamespace(is_further=lambda learned: False),
        checked=lambda each: SimpleNamespace(reasons=(), excused=False, missed=0.0, missed_at_least=0.0),
    )
    return search, node


@pytest.mark.parametrize(("left", "is_known"), [(1.0, True), (1.3, True), (2.0, False)])
def test_both_leads_take_the_place_of_the_function(left: float, is_known: bool) -> None:
    search, node = searched(left)
    assert set(in_known_words(search, node).hypotheses) == ({*LEADS} if is_known else {SHARED.hypothesis})
