"""Two of several known effects are exchanged at once, where neither of the others alone says enough."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.verdict import two_others

SPIKE, DRIFT = Known("reversal_spike", ("2",)), Known("bar_drift", ("1",))
SCREWS = [Known("screw_thermal", (each,)) for each in ("3", "4", "5")]
SCORES = {frozenset({SPIKE, SCREWS[0], SCREWS[2]}): -7058.0}
"""Log evidence of sets; of all others as low as that of the set found."""


def node_of(*known: Known) -> Any:
    """Return a set with what is asked of it."""
    return SimpleNamespace(
        members=tuple(map(Member, known)),
        hypotheses=known,
        is_known=True,
        score=SCORES.get(frozenset(known), -7515.0),
        trial=SimpleNamespace(names=known),
    )


def search_of(monkeypatch: pytest.MonkeyPatch, *, is_sure: bool = False) -> Any:
    """Return a search whose best pair beside a spike alone is two screws; beside others there is none."""

    def sets(search: Any, base: Any, most: int) -> list[Any]:
        assert most == 2
        pair = SimpleNamespace(members=[SimpleNamespace(known=SCREWS[0]), SimpleNamespace(known=SCREWS[2])])
        return [pair] if base.names == (SPIKE,) else []

    monkeypatch.setattr(two_others, "known_sets_beside", sets)
    monkeypatch.setattr(two_others, "is_for_sure", lambda search, node: is_sure)
    monkeypatch.setattr(two_others, "is_better", lambda search, node, than: node.score > than.score)
    monkeypatch.setattr(two_others, "is_admissible", lambda search, node: True)
    return SimpleNamespace(node=lambda members, near: node_of(*(each.hypothesis for each in members)))


def test_two_screws_stand_for_a_drift_and_the_screw_between_them(monkeypatch: pytest.MonkeyPatch) -> None:
    found = two_others.or_two_others(search_of(monkeypatch), node_of(DRIFT, SPIKE, SCREWS[1]))
    assert {*found.hypotheses} == {SPIKE, SCREWS[0], SCREWS[2]}


def test_what_is_for_sure_and_two_alone_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    three, two = node_of(DRIFT, SPIKE, SCREWS[1]), node_of(DRIFT, SPIKE)
    sure = two_others.or_two_others(search_of(monkeypatch, is_sure=True), three)
    pair = two_others.or_two_others(search_of(monkeypatch), two)
    assert (sure, pair) == (three, two)


def test_a_pair_with_an_effect_that_is_there_is_no_exchange_of_two(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each one taken out was looked for already."""
    node = node_of(DRIFT, SPIKE, SCREWS[0])
    found = two_others.or_two_others(search_of(monkeypatch), node)
    assert found is node
