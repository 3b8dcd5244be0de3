"""A simple function with known effects beside it, in place of a product of states that leaves more than the noise."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.verdict import simple_beside
from hexdbb.learned import Learned

LOBES_EACH_WAY, LOBES = (Learned.parse(f"learned:reading:bar_angle{each}") for each in ("_each_way", ""))
PLAYS = [Known("backlash", (each,)) for each in ("3", "4", "6")]


def node_of(*hypotheses: Hypothesis, left: float = 2.3, score: float = -8784.0) -> Any:
    """Return a set with what is asked of it."""
    trial = SimpleNamespace(left=left, is_of_time=False, refused=())
    return SimpleNamespace(members=tuple(map(Member, hypotheses)), hypotheses=hypotheses, trial=trial, score=score)


def search_of(monkeypatch: pytest.MonkeyPatch, *, own: frozenset[Known]) -> Any:
    """Return a search in which the function of one state and all plays explain all; `own` do by their formulas."""
    evidence = {1: 10.0, 3: 30.0}

    def sets(search: Any, base: Any, most: int) -> list[Any]:
        assert most == DEFAULT.max_effects - 1
        few, all_three = (SimpleNamespace(members=[SimpleNamespace(known=k) for k in PLAYS[:n]]) for n in (1, 3))
        few.log_evidence, all_three.log_evidence = evidence[1], evidence[3]
        return [few, all_three]

    def is_own(search: Any, node: Any, member: Member, least: float) -> bool:
        assert least == DEFAULT.own_formula
        return member.hypothesis in own

    monkeypatch.setattr(simple_beside, "known_sets_beside", sets)
    monkeypatch.setattr(simple_beside, "explains_by_its_own", is_own)
    monkeypatch.setattr(simple_beside, "is_better", lambda search, node, than: node.score > than.score)
    monkeypatch.setattr(simple_beside, "predicts", lambda search, node: True)
    return SimpleNamespace(
        criteria=DEFAULT,
        root=None,
        screen=lambda node: SimpleNamespace(scored=lambda part: part),
        tried=lambda node, parts: [node_of(*parts, left=25.0)],
        node=lambda members, near: node_of(
            *(each.hypothesis for each in members), left=1.04, score=-8000.0 + 1000.0 * len(members)
        ),
    )


def test_play_beside_lobes_is_no_lobes_each_way(monkeypatch: pytest.MonkeyPatch) -> None:
    found = simple_beside.or_a_simple_one_beside(search_of(monkeypatch, own=frozenset(PLAYS)), node_of(LOBES_EACH_WAY))
    assert {*found.hypotheses} == {LOBES, *PLAYS}


def test_each_effect_explains_by_its_own_formula(monkeypatch: pytest.MonkeyPatch) -> None:
    """The larger set has one by the functions of its form; the smaller is what is left."""
    search = search_of(monkeypatch, own=frozenset(PLAYS[:1]))
    found = simple_beside.or_a_simple_one_beside(search, node_of(LOBES_EACH_WAY))
    assert {*found.hypotheses} == {LOBES, PLAYS[0]}


@pytest.mark.parametrize(
    "node",
    [node_of(LOBES_EACH_WAY, left=1.05), node_of(LOBES), node_of(LOBES_EACH_WAY, PLAYS[0])],
    ids=["leaves the noise", "one state", "beside an effect"],
)
def test_others_stay(monkeypatch: pytest.MonkeyPatch, node: Any) -> None:
    assert simple_beside.or_a_simple_one_beside(search_of(monkeypatch, own=frozenset(PLAYS)), node) is node
