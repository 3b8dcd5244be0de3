"""What stood in for how the machine's form differs from a learned function is no cause beside it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.verdict import stand_ins
from hexdbb.learned import Learned
from hexdbb.studies.verdicts.cases import line_of
from hexdbb_truth.forms.cases import case

KNOWN = Member(Known("joint_offset", ("3",)))
PAIR, LEG, OTHER_LEG = (Member(Learned.parse(f"learned:leg:{each}:joint_angle")) for each in ("5-6", "5", "4"))
LEARNED = Member(Learned.parse("learned:guideway:3:time_position"))


def node_of(*members: Member, left: float, score: float = 0.0) -> Any:
    return SimpleNamespace(
        members=members,
        score=score,
        is_known=all(isinstance(each.hypothesis, Known) for each in members),
        trial=SimpleNamespace(left=left, refused=()),
        without=lambda member: tuple(each for each in members if each is not member),
    )


def answered(
    monkeypatch: pytest.MonkeyPatch,
    left: float,
    reasons: tuple[str, ...],
    *,
    is_needed: bool,
    less_likely: float = 0.0,
    first: Member = KNOWN,
    second: Member = LEARNED,
) -> bool:
    """Return whether the first member stays, where the other one refined leaves so much of 101 noise variances.

    `less_likely` is the log evidence by which the other one is behind both.
    """
    node, wider, others = node_of(first, second, left=3.0), node_of(first, second, left=1.0), node_of(second, left=5)
    again = node_of(second, left=left, score=-less_likely)
    monkeypatch.setattr(stand_ins, "needs", lambda search, node, member: is_needed)
    monkeypatch.setattr(stand_ins, "refined", lambda search, node: again)
    search: Any = SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=101.0)),
        trials=SimpleNamespace(explained_before=0.0),
        node=lambda members, near: others,
        checked=lambda each: SimpleNamespace(reasons=reasons),
    )
    found = stand_ins.without_stand_ins(search, node, wider)
    assert found in ((node, wider), (others, again))
    return found == (node, wider)


@pytest.mark.parametrize(
    ("left", "reasons", "is_needed", "less_likely", "stays"),
    [
        (1.2, (), False, 3.0, False),
        (1.2, (), True, 0.0, True),  # the refined others need it
        (2.0, (), False, 0.0, True),  # refined without it they explain less by more than a form may hide
        (1.2, ("does not predict",), False, 0.0, True),
        (1.2, (), False, 600.0, True),  # many functions of the reading say what play does, and are less likely
    ],
)
def test_it_goes_where_the_others_refined_say_the_same(
    monkeypatch: pytest.MonkeyPatch,
    left: float,
    reasons: tuple[str, ...],
    is_needed: bool,
    less_likely: float,
    stays: bool,
) -> None:
    assert answered(monkeypatch, left, reasons, is_needed=is_needed, less_likely=less_likely) == stays


@pytest.mark.parametrize(
    ("first", "second", "stays"),
    [(PAIR, LEG, False), (PAIR, OTHER_LEG, True), (LEG, OTHER_LEG, True)],
    ids=["a pair beside its leg", "a pair beside another leg", "a leg beside another leg"],
)
def test_a_function_that_two_legs_share_goes_where_that_of_one_says_the_same(
    monkeypatch: pytest.MonkeyPatch, first: Member, second: Member, stays: bool
) -> None:
    """Lobes of a joint's ball, finer than the splines of the first fit: what was left of them was put down to both."""
    assert answered(monkeypatch, 1.2, (), is_needed=False, first=first, second=second) == stays


@pytest.mark.long
def test_a_guideway_that_bows_as_it_warms_is_one_cause() -> None:
    """By less and less: what grows in proportion to time misses it, what grows towards an end is it."""
    line = line_of(case("guideway_warms-d0-x10-calibrate-s33"), ())
    assert line["outcome"] == "right"
    (found,) = line["found"]
    assert found["name"].startswith("learned:guideway:3:time_position_settling@")
    assert all(each["after"] < 1.5 for each in line["heldout"].values())
