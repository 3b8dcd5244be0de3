"""A known effect that stood in for how the machine's form differs from a learned function is no cause beside it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence import stand_ins
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.screen import Known
from hexdbb.evidence.trial import Member
from hexdbb.learned import Learned
from hexdbb.studies.verdicts.cases import line_of
from hexdbb_truth.forms.cases import case

KNOWN = Member(Known("joint_offset", ("3",)))
LEARNED = Member(Learned.parse("learned:guideway:3:time_position"))


def node_of(*members: Member, left: float) -> Any:
    return SimpleNamespace(
        members=members,
        is_known=all(isinstance(each.hypothesis, Known) for each in members),
        trial=SimpleNamespace(left=left, refused=()),
        without=lambda member: tuple(each for each in members if each is not member),
    )


def answered(monkeypatch: pytest.MonkeyPatch, left: float, reasons: tuple[str, ...], *, is_needed: bool) -> bool:
    """Return whether the known effect stays, where the others refined leave so much of 101 noise variances."""
    node, wider, others = node_of(KNOWN, LEARNED, left=3.0), node_of(KNOWN, LEARNED, left=1.0), node_of(LEARNED, left=5)
    again = node_of(LEARNED, left=left)
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
    ("left", "reasons", "is_needed", "stays"),
    [
        (1.2, (), False, False),
        (1.2, (), True, True),  # the refined others need it
        (2.0, (), False, True),  # refined without it they explain less by more than a form may hide
        (1.2, ("does not predict",), False, True),
    ],
)
def test_it_goes_where_the_others_refined_say_the_same(
    monkeypatch: pytest.MonkeyPatch, left: float, reasons: tuple[str, ...], is_needed: bool, stays: bool
) -> None:
    assert answered(monkeypatch, left, reasons, is_needed=is_needed) == stays


@pytest.mark.long
def test_a_guideway_that_bows_as_it_warms_is_one_cause() -> None:
    """By less and less: what grows in proportion to time misses it, and a joint off its place made up for that."""
    line = line_of(case("guideway_warms-d0-x10-calibrate-s33"), ())
    assert line["outcome"] == "right"
    assert [each["name"] for each in line["found"]] == ["learned:guideway:3:time_position"]
    assert all(each["after"] < 2.5 for each in line["heldout"].values())
