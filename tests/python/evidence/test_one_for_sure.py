"""Several causes that are not for sure, and the effect of one of them that is so alone."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Hypothesis, Known
from hexdbb.evidence.search import fine_enough
from hexdbb.evidence.search.fine_enough import or_one_place
from hexdbb.learned import Learned

BALL, OTHERWISE = Known("ball_eccentricity", ("1",)), Known("ball_eccentricity", ("2",))
BOW = Known("straightness", ("1",))
LOAD = Learned.parse("learned:load:angle")


def node_of(score: float, left: float, *hypotheses: Hypothesis) -> Node:
    members, names = tuple(map(Member, hypotheses)), tuple(each.name for each in hypotheses)
    trial: Any = SimpleNamespace(members=members, names=names, left=left, refused=(), forms=(), is_of_time=False)
    return Node(trial, score)


@pytest.fixture
def chosen(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return what is chosen in place of a ball and a bow, where the ball otherwise is for sure and leaves so much."""

    def choose(left: float, alone: Hypothesis = OTHERWISE, is_sure: bool = True) -> tuple[str, ...]:
        several, one = node_of(-5.0, 5.0, BALL, BOW), node_of(-20.0, left, alone)
        for name in ("is_for_sure", "predicts"):
            monkeypatch.setattr(fine_enough, name, lambda _, node: node is one and is_sure)
        for name in ("refined", "finely_tuned"):
            monkeypatch.setattr(fine_enough, name, lambda _, node: node)
        search: Any = SimpleNamespace(
            nodes=[several, one],
            criteria=DEFAULT,
            root=SimpleNamespace(trial=SimpleNamespace(left=101.0)),
            left_by_formulas=lambda trial: trial.left,
        )
        return or_one_place(search, several, several)[0].trial.names

    return choose


def test_an_effect_that_is_for_sure_alone_is_named_alone(chosen: Any) -> None:
    """Its seat rocks: what that leaves is no bow."""
    assert chosen(left=9.0) == (OTHERWISE.name,)


@pytest.mark.parametrize(
    "case",
    [{"left": 20.0}, {"left": 9.0, "is_sure": False}, {"left": 9.0, "alone": Known("bar_gain", ("bar",))}],
    ids=["explains less", "is not for sure", "is none of the causes"],
)
def test_another_leaves_the_causes_as_they_are(chosen: Any, case: dict[str, Any]) -> None:
    assert chosen(**case) == (BALL.name, BOW.name)


@pytest.mark.parametrize(
    ("several_leave", "one_leaves", "name"),
    [(1.05, 3.3, BALL.name), (1.05, 1.02, LOAD.name), (30.0, 3.3, LOAD.name)],
    ids=["known ones say all", "both say all", "known ones say a part"],
)
def test_known_effects_that_explain_all_do_not_give_way_to_a_part(
    monkeypatch: pytest.MonkeyPatch, several_leave: float, one_leaves: float, name: str
) -> None:
    """Functions of the same place beside the one, which would have more evidence, change nothing in that."""
    several, one = node_of(-5.0, several_leave, BALL, BOW), node_of(-20.0, one_leaves, LOAD)
    monkeypatch.setattr(fine_enough, "is_for_sure", lambda *_: False)
    monkeypatch.setattr(fine_enough, "predicts", lambda *_: True)
    monkeypatch.setattr(fine_enough, "finely_tuned", lambda _, node: node)
    monkeypatch.setattr(fine_enough, "refined", lambda _, node: node_of(0.0, 1.0, *node.hypotheses))
    root = SimpleNamespace(trial=SimpleNamespace(left=37.0))
    search: Any = SimpleNamespace(nodes=[several, one], criteria=DEFAULT, root=root)
    assert or_one_place(search, several, several)[0].trial.names[0] == name
