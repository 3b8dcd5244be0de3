"""A set that was fitted before comes back with its members in the order of then."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence import refine
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.node import Node
from hexdbb.evidence.trial import Member
from hexdbb.learned import Learned

NAMES = ("learned:leg:1:position", "learned:cup:time")


def test_each_function_is_tuned_in_its_own_stead(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[str, ...]] = []

    def of(members: tuple[Member, ...], near: Any) -> Any:
        asked.append(tuple(each.hypothesis.name for each in members))
        return SimpleNamespace(members=tuple(reversed(members)))

    monkeypatch.setattr(refine, "retunings", lambda search, node, member: [member])
    monkeypatch.setattr(refine, "_if_better", lambda search, fitted, node, worth, enough: Node(fitted(), 0.0))
    search: Any = SimpleNamespace(criteria=DEFAULT, trials=SimpleNamespace(of=of))
    refine.with_best_splines(search, _node(*(Member(Learned.parse(each)) for each in NAMES)))
    assert [sorted(each) for each in asked] == [sorted(NAMES)] * 2


def _node(*members: Member) -> Node:
    trial: Any = SimpleNamespace(members=members)
    return Node(trial, 0.0)
