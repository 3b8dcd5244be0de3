"""Known effects that each explain by their own formula, and what they may err by where left out."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.errors import RunError
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.heldout import HeldOut
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.by_formulas import (
    err_by_geometry,
    explain_by_own_formulas,
    explain_in_part,
    explain_nearly_all,
)
from hexdbb.learned import Learned

JOINT, SCREW = Known("joint_offset", ("2",)), Known("lead_error", ("5",))
FUNCTION = Learned.parse("learned:leg:2:joint_angle")
FIRST, LEFT = 25.0, 1.0


def node_of(*hypotheses: Known | Learned, left: float = LEFT) -> Node:
    members = tuple(map(Member, hypotheses))
    # A form stands for the member that it belongs to.
    trial: Any = SimpleNamespace(members=members, left=left, refused=(), forms=tuple(each.name for each in hypotheses))
    return Node(trial, 0.0)


def searched(
    node: Node,
    *others: Node,
    without: dict[str, float | None],
    own: dict[str, float],
    formulas: float = LEFT,
    held: HeldOut | None = None,
) -> Any:
    """Return a search of one set and others.

    `without` is what the set leaves without a member (None: not fitted), `own` what it leaves with the formula of one
    alone, `formulas` what it leaves with all formulas.
    """

    def of(members: tuple[Member, ...]) -> Any:
        (gone,) = {each.hypothesis.name for each in node.members} - {each.hypothesis.name for each in members}
        left = without[gone]
        if left is None:
            raise RunError("no fit")
        return SimpleNamespace(left=left)

    heldout = {"arc": HeldOut(1.0, 1e6, 0.0, 1.0, 1e6)}
    if held is not None:
        heldout["circle"] = held
    return SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=FIRST)),
        nodes=[node, *others],
        trials=SimpleNamespace(of=of),
        left_by_formula=lambda trial, form: own[form],
        left_by_formulas=lambda trial: formulas,
        checked=lambda node: SimpleNamespace(heldout=heldout),
    )


BOTH = {JOINT.name: 11.0, SCREW.name: 5.0}


@pytest.mark.parametrize(
    ("own", "each_does"), [({JOINT.name: 2.9, SCREW.name: 1.7}, True), ({JOINT.name: 2.9, SCREW.name: 1.9}, False)]
)
def test_each_explains_most_of_what_the_others_leave(own: dict[str, float], each_does: bool) -> None:
    """A fifth of ten noise variances may be left by the formula of one, of four by the other's."""
    node = node_of(JOINT, SCREW)
    assert explain_by_own_formulas(searched(node, without={**BOTH}, own=own), node) is each_does


@pytest.mark.parametrize(("left", "each_does"), [(1.9, True), (2.9, False)])
def test_or_nearly_all_where_one_hypothesis_may_be_said_instead(left: float, each_does: bool) -> None:
    node = node_of(JOINT, SCREW)
    search = searched(node, without={**BOTH}, own={JOINT.name: left, SCREW.name: 1.3})
    assert explain_by_own_formulas(search, node)
    assert explain_nearly_all(search, node) is each_does


@pytest.mark.parametrize(
    ("own", "formulas", "each_does"),
    [(4.1, 6.9, True), (4.3, 6.9, False), (5.2, 6.9, False), (4.1, 7.1, False)],
    ids=["a part each", "less", "nothing", "too little together"],
)
def test_in_part_is_a_fifth_each_and_enough_together(own: float, formulas: float, each_does: bool) -> None:
    """Of four noise variances that the joint leaves the screw's formula must explain 0.8."""
    node = node_of(JOINT, SCREW)
    search = searched(node, without={**BOTH}, own={JOINT.name: 2.9, SCREW.name: own}, formulas=formulas)
    assert explain_in_part(search, node) is each_does


def test_a_learned_function_has_no_formula() -> None:
    node = node_of(JOINT, FUNCTION)
    search = searched(node, without={JOINT.name: 11.0, FUNCTION.name: 5.0}, own={JOINT.name: 1.0, FUNCTION.name: 1.0})
    assert not explain_by_own_formulas(search, node)


def test_what_cannot_be_fitted_shows_nothing() -> None:
    node = node_of(JOINT, SCREW)
    search = searched(node, without={JOINT.name: 11.0, SCREW.name: None}, own={JOINT.name: 1.0, SCREW.name: 1.0})
    assert not explain_by_own_formulas(search, node)


def errs(node: Node, error: float, *others: Node, formulas: float = LEFT, left: float = LEFT) -> bool:
    """Ask for a circle on which geometry errs by 100 where it leaves 25 noise variances, and 2 are expected."""
    held = HeldOut(before=100.0, after=error, share=0.9, expected=2.0, as_fitted=10.0 * error)
    without = {each.hypothesis.name: 11.0 for each in node.members}
    own = {each.hypothesis.name: left for each in node.members}
    return err_by_geometry(searched(node, *others, without={**without}, own=own, formulas=formulas, held=held), node)


@pytest.mark.parametrize("part", [0.99, 1.01])
@pytest.mark.parametrize(("formulas", "carried"), [(1.0, 0.0), (1.1, 40.0)])
def test_error_is_what_is_expected_and_what_geometry_carries(part: float, formulas: float, carried: float) -> None:
    """A tenth of a noise variance left by formulas is carried as 25 are: 100 squared over 25 of them."""
    most = (DEFAULT.by_chance * (2.0**2 + carried)) ** 0.5
    assert errs(node_of(JOINT, SCREW), part * most, formulas=formulas) is (part < 1.0)


def test_what_explains_by_its_form_has_no_such_excuse() -> None:
    assert not errs(node_of(JOINT, SCREW), 1.0, left=5.0)


@pytest.mark.parametrize(("left", "is_sure"), [(1.02, False), (2.0, True)])
def test_several_are_nothing_simpler_than_one_that_explains_all(left: float, is_sure: bool) -> None:
    assert errs(node_of(JOINT, SCREW), 1.0, node_of(FUNCTION, left=left)) is is_sure


def test_one_refused_is_no_other() -> None:
    refused: Any = node_of(FUNCTION)
    refused.trial.refused = ("negative play",)
    assert errs(node_of(JOINT, SCREW), 1.0, refused)


def test_one_effect_is_the_one() -> None:
    """By its formula, though another hypothesis explains as much: that is named beside it (`rivals.py`)."""
    assert errs(node_of(JOINT), 1.0, node_of(FUNCTION))
