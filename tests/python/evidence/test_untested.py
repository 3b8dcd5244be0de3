"""One effect that nothing tests where geometry is hardly held: a function with more evidence is as likely."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.heldout import HeldOut
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search import sure
from hexdbb.learned import Learned
from hexdbb.studies.verdicts.cases import line_of
from hexdbb_truth.forms.cases import case

BALL = Member(Known("ball_eccentricity", ("2",)))
BEFORE, LEFT = 101.0, 1.0
EXPLAINED = (BEFORE - LEFT) ** 0.5


def asked(
    part: float,
    score: float,
    left: float,
    name: str = "learned:ball:pitch",
    without: float = 2.0,
    share: float = 0.8,
    *,
    lives_in: str = "",
    by_formula: float = LEFT,
) -> bool:
    """Return whether a ball that sits otherwise is for sure.

    Parameters
    ----------
    part : float
        Error of the circles left out over what it explains; so much is what the fit expects.
    score, left : float
        Of the function that was tried too, by how much its log evidence is larger.
    name : str
        Of that.
    without : float
        Error without the effect, over that with it.
    share : float
        Part of that which was left out that the effect explains.
    lives_in : str
        Function that contains the effect.
    by_formula : float
        What its formula leaves.
    """
    error = part * EXPLAINED
    held = HeldOut(before=without * error, after=error, share=share, expected=error, as_fitted=error)
    function: Any = Member(Learned.parse(name))
    other = Node(_trial(function, left), score)
    node = Node(_trial(BALL, LEFT), 0.0)
    search: Any = SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=BEFORE)),
        nodes=[node, other],
        trials=SimpleNamespace(explained_before=0.0),
        left_by_formulas=lambda _: by_formula,
        kin={BALL.hypothesis.name: {lives_in}},
        checked=lambda _: SimpleNamespace(
            share=1.0, excused=False, missed=0.0, missed_at_least=0.0, heldout={"circle": held}
        ),
    )
    return sure.is_for_sure(search, node)


def _trial(member: Member, left: float) -> Any:
    is_of_time = isinstance(member.hypothesis, Learned) and member.hypothesis.is_of_time
    return SimpleNamespace(
        members=(member,),
        left=left,
        forms=(Form(0.0, 0.0, ()),),
        refused=(),
        is_of_time=is_of_time,
        names=(member.hypothesis.name,),
    )


@pytest.mark.parametrize(
    ("part", "score", "left", "name", "expected"),
    [
        (1.1 * DEFAULT.missed_far, 100.0, 1.0, "learned:ball:pitch", False),
        (0.9 * DEFAULT.missed_far, 100.0, 1.0, "learned:ball:pitch", True),
        (1.1 * DEFAULT.missed_far, 1.0, 1.0, "learned:ball:pitch", True),
        (1.1 * DEFAULT.missed_far, 100.0, 9.0, "learned:ball:pitch", True),
        (1.1 * DEFAULT.missed_far, 100.0, 1.0, "learned:ball:time", True),
    ],
    ids=["a function says more", "circles test it", "as likely by chance", "leaves much", "of time alone"],
)
def test_an_effect_that_nothing_tests_is_for_sure_by_its_evidence(
    monkeypatch: pytest.MonkeyPatch, part: float, score: float, left: float, name: str, expected: bool
) -> None:
    monkeypatch.setattr(sure, "err_by_geometry", lambda *_: True)
    assert asked(part, score, left, name) is expected


@pytest.mark.parametrize(("without", "share", "expected"), [(1.1, 0.6, True), (0.9, 0.6, False), (0.9, 0.9, True)])
def test_an_effect_that_errs_more_than_geometry_alone_is_not_for_sure(
    monkeypatch: pytest.MonkeyPatch, without: float, share: float, expected: bool
) -> None:
    monkeypatch.setattr(sure, "err_by_geometry", lambda *_: True)
    assert asked(1.1 * DEFAULT.missed_far, -100.0, 9.0, without=without, share=share) is expected


def test_a_function_in_which_an_effect_lives_says_how_its_form_differs(monkeypatch: pytest.MonkeyPatch) -> None:
    """A gain of 9 per mille, with a square, was not for sure: a function of the deflection had 37 nats more."""
    monkeypatch.setattr(sure, "err_by_geometry", lambda *_: True)
    error, name = 1.1 * DEFAULT.missed_far, "learned:ball:pitch"
    assert not asked(error, 100.0, 1.0, name)
    assert asked(error, 100.0, 1.0, name, lives_in=name)
    assert not asked(error, 100.0, 1.0, name, lives_in=name, by_formula=60.0)


@pytest.mark.long
def test_a_cup_that_goes_by_the_tilt_is_no_ball_that_sits_otherwise_for_sure() -> None:
    assert line_of(case("any_cup_tilt-d0-x10-judge-s4"), ())["grade"] == "unknown"
