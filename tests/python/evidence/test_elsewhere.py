"""A rival at another leg: named beside an effect whose formula alone leaves much."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.verdict.elsewhere import rivals_elsewhere
from hexdbb.learned import Learned
from hexdbb.studies.verdicts.cases import line_of
from hexdbb_truth.forms.cases import case

OFFSET = Known("joint_offset", ("6",))
BEFORE = 11.0
BY_FORM, BY_FORMULA = 4.0, 1.5
"""What the effect's formula leaves, in noise variances: it explains seven tenths of what was missing, or nearly all."""


def node_of(score: float, *hypotheses: Known | Learned) -> Node:
    members, names = tuple(map(Member, hypotheses)), tuple(each.name for each in hypotheses)
    trial: Any = SimpleNamespace(members=members, names=names, left=1.0, refused=())
    return Node(trial, score)


def named(
    function: str,
    formula_leaves: float,
    *,
    lead: float = 40.0,
    alike: tuple[str, ...] = (),
    beside: tuple[Known, ...] = (),
    keeps_it: bool = False,
) -> list[str]:
    """Return what is named beside a joint of leg 6 off its place, in whose form a learned function lives."""
    learned = Learned.parse(function)
    kept = (OFFSET,) if keeps_it else ()
    chosen, other = node_of(0.0, OFFSET, *beside), node_of(lead, *kept, learned)
    search: Any = SimpleNamespace(
        nodes=[chosen, other],
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=BEFORE)),
        kin={OFFSET.name: {learned.name}},
        learnable=SimpleNamespace(by_name={learned.name: learned}),
        left_by_formulas=lambda trial: formula_leaves,
        checked=lambda node: SimpleNamespace(reasons=()),
        engine=SimpleNamespace(
            absent=SimpleNamespace(ports=lambda effect: frozenset({"platform_joint"})),
            base=SimpleNamespace(info=lambda effect: SimpleNamespace(is_set_up=False, element_kind="leg")),
        ),
    )
    return rivals_elsewhere(search, chosen, OFFSET, alike)


OTHER_LEG = "learned:leg:5:platform_joint_angle"


@pytest.mark.parametrize("function", [OTHER_LEG, "learned:platform_joint:5:joint_angle"])
def test_a_function_at_another_leg_is_named_beside_it(function: str) -> None:
    """A ball with lobes in the joint of leg 5 was called a joint of leg 6 off its place, for sure."""
    assert named(function, BY_FORM) == [function]


def test_not_where_the_formula_explains_nearly_all() -> None:
    assert named(OTHER_LEG, BY_FORMULA) == []


def test_not_where_it_is_one_of_several() -> None:
    """Then the functions of its form describe what the others leave."""
    assert named(OTHER_LEG, BY_FORM, beside=(Known("sample_delay", ("1",), is_whole=True),)) == []


def test_not_with_less_evidence() -> None:
    assert named(OTHER_LEG, BY_FORM, lead=-0.9 * DEFAULT.margin_nats) == [OTHER_LEG]
    assert named(OTHER_LEG, BY_FORM, lead=-1.1 * DEFAULT.margin_nats) == []


@pytest.mark.parametrize("function", ["learned:leg:6:platform_joint_angle", "learned:leg:5-6:platform_joint_angle"])
def test_not_at_its_own_leg(function: str) -> None:
    assert named(function, BY_FORM) == []


def test_not_where_the_same_effect_at_that_leg_says_the_same() -> None:
    assert named(OTHER_LEG, BY_FORM, alike=("backlash:4 + joint_offset:5",)) == []
    assert named(OTHER_LEG, BY_FORM, alike=("backlash:5 + joint_offset:3",)) == [OTHER_LEG]


@pytest.mark.parametrize("function", ["learned:lateral:1:position", "learned:slider:5:position"])
def test_elements_of_another_kind_are_not_compared(function: str) -> None:
    """Guideway 1 has sliders 1 and 2: its number says nothing of theirs."""
    assert named(function, BY_FORM) == []


def test_at_the_other_end_of_the_measuring_loop_it_is_named_whatever_the_formula_explains() -> None:
    assert named("learned:ball:roll", BY_FORMULA) == ["learned:ball:roll"]


def test_a_set_that_has_the_effect_itself_is_no_rival_of_it() -> None:
    """A bow was named beside itself, where a function of the deflection stood for the gauge's gain."""
    gain = (Known("bar_gain", ("1",), is_whole=True),)
    assert named("learned:ball:roll", BY_FORMULA, beside=gain) == ["learned:ball:roll"]
    assert named("learned:ball:roll", BY_FORMULA, beside=gain, keeps_it=True) == []


@pytest.mark.long
def test_a_joint_off_its_place_is_for_sure_where_its_pair_s_other_joint_says_the_same() -> None:
    line = line_of(case("joint_offset-d10-x30-calibrate-s2"), ())
    assert (line["outcome"], line["grade"]) == ("right", "effect")
