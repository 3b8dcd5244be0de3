"""A function of one state in place of an effect of two: another explanation if it has more evidence."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.verdict.one_state import of_one_state
from hexdbb.learned import Learned

WARMS, SAGS = Known("screw_thermal", ("2",)), Known("gravity_sag", ("machine",), is_whole=True)
HOME = Learned.parse("learned:slider:2:time_position")
MORE = 2.0 * DEFAULT.margin_nats


def node_of(score: float, *hypotheses: Known | Learned, refused: tuple[str, ...] = ()) -> Node:
    members, names = tuple(map(Member, hypotheses)), tuple(each.name for each in hypotheses)
    is_free = any(isinstance(each, Learned) and each.is_of_time for each in hypotheses)
    trial: Any = SimpleNamespace(members=members, names=names, left=1.0, refused=refused, is_free_in_time=is_free)
    return Node(trial, score)


def named(*tried: Node, reasons: tuple[str, ...] = ()) -> list[str]:
    """Return what is named beside a screw that warms, and legs that sag, whose set has a score of 0."""
    search: Any = SimpleNamespace(
        nodes=tried,
        criteria=DEFAULT,
        checked=lambda node: SimpleNamespace(reasons=reasons),
        same_kind=lambda one, other: other.name == HOME.name,
        kin={WARMS.name: {HOME.name}},
        learnable=SimpleNamespace(by_name={HOME.name: HOME}),
        engine=SimpleNamespace(absent=SimpleNamespace(ports=lambda effect: frozenset({HOME.port}))),
    )
    return list(of_one_state(search, node_of(0.0, WARMS, SAGS), WARMS))


@pytest.mark.parametrize(
    ("name", "is_named"),
    [
        ("learned:slider:2:time", True),
        ("learned:slider:2:fine_time", True),
        ("learned:slider:2:position", True),
        ("learned:slider:3:time", False),
        ("learned:leg:2:time", False),
        ("learned:slider:2:velocity", False),
        (HOME.name, False),
    ],
)
def test_one_of_its_states_at_its_place_is_named(name: str, is_named: bool) -> None:
    tried = node_of(MORE, SAGS, Learned.parse(name))
    assert named(tried) == ([f"gravity_sag + {name}"] if is_named else [])


def test_no_more_evidence_is_no_other_explanation() -> None:
    assert named(node_of(0.0, SAGS, Learned.parse("learned:slider:2:time"))) == []


def test_nor_is_one_beside_other_causes_or_refused() -> None:
    time = Learned.parse("learned:slider:2:time")
    assert named(node_of(MORE, time), node_of(MORE, SAGS, WARMS, time)) == []
    assert named(node_of(MORE, SAGS, time, refused=("negative sag",))) == []


@pytest.mark.parametrize(("name", "is_named"), [("learned:slider:2:time", True), ("learned:slider:2:position", False)])
def test_what_does_not_predict_is_none_unless_it_claims_nothing(name: str, is_named: bool) -> None:
    tried = node_of(MORE, SAGS, Learned.parse(name))
    assert bool(named(tried, reasons=("does not predict the other feed",))) is is_named
