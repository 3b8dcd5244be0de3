"""A further element of an effect that is there already: little where fitted, much where left out."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.verdict import further_elements
from hexdbb.evidence.verdict.further_elements import with_elements_that_predict
from hexdbb.learned import Learned

SPIKE, BOW = Known("reversal_spike", ("3",)), Known("straightness", ("3",))
FUNCTION = Learned.parse("learned:leg:4:time")
ELEMENTS = {"reversal_spike": tuple("123456"), "straightness": tuple("123")}


def node_of(*hypotheses: Known | Learned, evidence: float = 0.0, left: float = 3.0) -> Node:
    trial: Any = SimpleNamespace(members=tuple(map(Member, hypotheses)), refused=(), log_evidence=evidence, left=left)
    return Node(trial, evidence)


@pytest.fixture
def search(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a search in which guideway 1, beside, makes the set predict, and guideway 2 explains a little more."""
    evidence = {"straightness:1": 100.0, "straightness:2": 120.0}
    found = SimpleNamespace(criteria=DEFAULT, asked=[], missed={"straightness:1": 0.1, "straightness:2": 9.0})
    found.nodes, found.left = [], 2.9

    def node(members: tuple[Member, ...], near: Node) -> Node:
        last = members[-1].hypothesis.name
        found.asked.append(last)
        return node_of(*(each.hypothesis for each in members), evidence=evidence.get(last, 1.0), left=found.left)

    def missed(search: Any, node: Node) -> float:
        return float(found.missed.get(node.hypotheses[-1].name, 20.0))

    found.node = node
    found.log_prior = lambda hypothesis: -4.0
    found.checked = lambda node: SimpleNamespace(reasons=())
    found.engine = SimpleNamespace(base=SimpleNamespace(info=lambda name: SimpleNamespace(elements=ELEMENTS[name])))
    monkeypatch.setattr(further_elements, "missed", missed)
    monkeypatch.setattr(further_elements, "is_for_sure", lambda search, node: missed(search, node) < 0.5)
    found.is_form_alone = False
    monkeypatch.setattr(further_elements, "is_form_alone", lambda search, *of: search.is_form_alone)
    return found


def test_the_element_that_makes_a_set_predict_is_added(search: Any) -> None:
    found = with_elements_that_predict(search, node_of(SPIKE, BOW))
    assert [each.name for each in found.hypotheses] == ["reversal_spike:3", "straightness:3", "straightness:1"]
    assert len(search.asked) == len(set(search.asked)) == 7


@pytest.mark.parametrize(("other", "is_added"), [(90.0, True), (110.0, False)])
def test_nor_one_instead_of_which_another_effect_would_do(search: Any, other: float, is_added: bool) -> None:
    node = node_of(SPIKE, BOW)
    search.missed["joint_offset:3"] = 0.2
    search.nodes = [node, node_of(SPIKE, BOW, Known("joint_offset", ("3",)), evidence=other)]
    assert (with_elements_that_predict(search, node) is not node) is is_added


def test_nor_one_that_explains_nothing(search: Any) -> None:
    search.left = 2.99
    node = node_of(SPIKE, BOW)
    assert with_elements_that_predict(search, node) is node


def test_nor_one_of_which_functions_of_its_form_say_all(search: Any) -> None:
    search.is_form_alone = True
    node = node_of(SPIKE, BOW)
    assert with_elements_that_predict(search, node) is node


@pytest.mark.parametrize("errs", [20.0, 0.6], ids=["as much", "less, and is not for sure"])
def test_but_not_one_that_errs(search: Any, errs: float) -> None:
    search.missed["straightness:1"] = errs
    node = node_of(SPIKE, BOW)
    assert with_elements_that_predict(search, node) is node


@pytest.mark.parametrize(
    "node",
    [
        node_of(SPIKE, Known("straightness", ("1",))),
        node_of(BOW, FUNCTION),
        node_of(),
        node_of(SPIKE, BOW, Known("backlash", ("1", "2"))),
    ],
    ids=["for sure", "a function beside", "nothing", "as many as are looked for"],
)
def test_nor_is_one_looked_for(search: Any, node: Node) -> None:
    assert with_elements_that_predict(search, node) is node
    assert search.asked == []
