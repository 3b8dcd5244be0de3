"""A set that was fitted before comes back with its members in the order asked for, the last the one that was added."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from tests.foreign_records import samples_of

from hexdbb.diagnosis import noise_of
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search import refine
from hexdbb.evidence.search.search import Search
from hexdbb.learned import Learned
from hexdbb.model import new_model
from hexdbb.samples.places import with_set_up_of

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


def test_a_set_has_its_members_in_the_order_asked_for() -> None:
    samples = samples_of("bow-small")
    model = with_set_up_of(samples, new_model(samples.machine))
    search = Search(Engine(samples, model, noise_of(samples), DEFAULT), ("straightness",), DEFAULT)
    bow, other_bow = (Member(Known("straightness", (each,))) for each in "12")
    one, other = search.trials.of((bow, other_bow)), search.trials.of((other_bow, bow))
    assert one.names == ("straightness:1", "straightness:2")
    assert other.names == one.names[::-1]
    assert other.forms == one.forms[::-1]
    assert other.model is one.model
    assert search.trials.of((other_bow, bow)) is other
    assert search.checked_trial(other) is search.checked_trial(one)


def _node(*members: Member) -> Node:
    trial: Any = SimpleNamespace(members=members)
    return Node(trial, 0.0)
