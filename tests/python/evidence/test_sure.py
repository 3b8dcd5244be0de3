"""What may be said for sure: known causes that explain enough without the functions that refine them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from hexdbb.errors import RunError
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.heldout import HeldOut
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search import sure
from hexdbb.evidence.search.sure import Grade, graded, is_for_sure
from hexdbb.learned import Learned

LEGS = Member(Known("leg_thermal", ("all",), is_whole=True))
SCREW = Member(Known("screw_thermal", ("3",)))
STEPS = Member(Learned.parse("learned:leg:4:time"))
BEFORE, SHARE = 25.0, 24.0


@pytest.fixture
def explains_and_predicts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sure, "is_for_sure", lambda *_: True)


@pytest.fixture(autouse=True)
def nothing_is_put_down_to_geometry(monkeypatch: pytest.MonkeyPatch) -> None:
    """What each effect explains by its own formula is asked in `test_by_formulas.py`."""
    monkeypatch.setattr(sure, "err_by_geometry", lambda *_: False)


@pytest.fixture(autouse=True)
def each_explains_a_part(monkeypatch: pytest.MonkeyPatch) -> None:
    """This too."""
    monkeypatch.setattr(sure, "explain_in_part", lambda *_: True)


def searched(left: float | None) -> Any:
    """Return a search in which the known effect alone leaves so much, or cannot be fitted."""

    def of(members: tuple[Member, ...]) -> Any:
        assert members == (LEGS,)
        if left is None:
            raise RunError("no fit")
        return SimpleNamespace(left=left)

    root = SimpleNamespace(trial=SimpleNamespace(left=BEFORE))
    return SimpleNamespace(criteria=DEFAULT, root=root, trials=SimpleNamespace(of=of))


TRIAL: Any = SimpleNamespace(members=(LEGS, STEPS))
NODE = Node(TRIAL, 0.0)
ENOUGH = BEFORE - DEFAULT.explained_min * SHARE


@pytest.mark.usefixtures("explains_and_predicts")
@pytest.mark.parametrize("grade", ["effect", "ambiguous"])
@pytest.mark.parametrize(("left", "is_sure"), [(ENOUGH - 0.1, True), (ENOUGH + 0.1, False), (None, False)])
def test_causes_explain_enough_without_what_refines_them(grade: Grade, left: float | None, is_sure: bool) -> None:
    assert graded(searched(left), NODE, grade) == (grade if is_sure else "unknown")


@pytest.mark.usefixtures("explains_and_predicts")
def test_what_is_unknown_stays_so() -> None:
    assert graded(searched(None), NODE, "unknown") == "unknown"


def held(before: float, error: float) -> HeldOut:
    return HeldOut(before=before, after=error, share=0.9, expected=1.0, as_fitted=error)


def asked(
    form: Form,
    *,
    members: tuple[Member, ...] = (LEGS,),
    before: float = 5.0,
    missed: float = 0.0,
    left: float = 1.0,
    fitted: float = 1.0,
    **checked: Any,
) -> bool:
    """Return whether known effects are for sure that miss a part of what they explain.

    `left` is what their formulas leave, `fitted` what they leave with their forms, noise variances.
    """
    error = float(np.sqrt(1.0 + missed**2 * (BEFORE - 1.0)))
    names = tuple(each.hypothesis.name for each in members)
    trial: Any = SimpleNamespace(members=members, left=fitted, forms=(form,) * len(members), names=names)
    node = Node(trial, 0.0)
    search: Any = SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=BEFORE)),
        nodes=[],
        trials=SimpleNamespace(explained_before=0.0),
        left_by_formulas=lambda trial: left,
        kin={},
        checked=lambda node: SimpleNamespace(
            **{"share": 1.0, "excused": False, **checked},
            missed=missed,
            missed_at_least=missed,
            heldout={"circle": held(before, error)},
        ),
    )
    return is_for_sure(search, node)


@pytest.mark.parametrize(("beyond", "sure_of_it"), [(-0.1, True), (0.1, False)])
@pytest.mark.parametrize("excused", [True, False])
def test_one_effect_errs_by_no_more_than_it_explains(beyond: float, sure_of_it: bool, excused: bool) -> None:
    """Whether its form excuses it, or its formula nearly as it is leaves only noise."""
    form = Form(0.02, 0.5 * DEFAULT.form_exact, ())
    assert asked(form, missed=DEFAULT.missed_bent + beyond, excused=excused) is sure_of_it


@pytest.mark.parametrize(("part", "sure_of_it"), [(0.9, True), (1.1, False)])
def test_a_formula_that_leaves_what_its_form_may_is_nearly_as_it_is(part: float, sure_of_it: bool) -> None:
    form = Form(0.02, 0.5 * DEFAULT.form_exact, ())
    fitted = 1.0 + part * DEFAULT.form_described**2 * SHARE
    assert asked(form, missed=1.0, left=0.5 * BEFORE, fitted=fitted) is sure_of_it


@pytest.mark.parametrize(
    ("before", "left", "sure_of_it"),
    [(1.1, 1.0, True), (0.9, 1.0, False), (1.1, 5.0, False)],
    ids=["leads away", "geometry is held", "explains by its form"],
)
def test_what_geometry_leads_away_from_says_nothing_of_a_formula(before: float, left: float, sure_of_it: bool) -> None:
    """The one mount of a plan whose circles hold geometry by each other: without one nothing could predict it."""
    form = Form(0.1, 0.2, ())
    before_um = before * DEFAULT.leads_away * BEFORE**0.5
    assert asked(form, before=before_um, missed=5.0, left=left) is sure_of_it


def test_but_of_two_that_explain_nearly_all_it_does() -> None:
    """A lead error and legs that sag stood in for a joint off its place: their formulas explained 97 %."""
    form, before_um = Form(0.0, 0.0, ()), 1.1 * DEFAULT.leads_away * BEFORE**0.5
    assert not asked(form, members=(LEGS, SCREW), before=before_um, missed=5.0)


@pytest.mark.parametrize("left", [1.0, 8.0], ids=["together by formulas", "together by forms"])
def test_unless_each_does_by_its_own_and_errs_by_geometry(monkeypatch: pytest.MonkeyPatch, left: float) -> None:
    monkeypatch.setattr(sure, "err_by_geometry", lambda *_: True)
    assert asked(Form(0.0, 0.0, ()), members=(LEGS, SCREW), missed=5.0, left=left)


@pytest.mark.parametrize(
    ("before", "part", "sure_of_it"),
    [(0.9, 0.9, True), (1.1, 1.1, True), (1.1, 0.9, False)],
    ids=["other circles test it", "its formula explains a part", "functions of its form alone"],
)
def test_what_nothing_tests_is_explained_by_a_formula(before: float, part: float, sure_of_it: bool) -> None:
    """A bow of a guideway that is nine tenths functions of its form may be the slider's cover."""
    form = Form(0.4, 0.07, ("learned:vertical:3:position",))
    left = BEFORE - part * DEFAULT.formula_explains * SHARE
    assert asked(form, before=before * DEFAULT.leads_away * BEFORE**0.5, left=left) is sure_of_it


@pytest.mark.parametrize(
    ("left", "missed", "before", "sure_of_it"),
    [(5.0, 1.2, 1.0, True), (8.0, 1.2, 1.0, False), (8.0, 0.3, 1.0, True), (8.0, 0.3, 11.0, False)],
    ids=["by formulas", "by forms", "by forms that predict", "by forms that nothing tests"],
)
def test_several_explain_enough_by_their_formulas(left: float, missed: float, before: float, sure_of_it: bool) -> None:
    """What they miss is that of their formulas: the functions of a form lead away beside another cause."""
    trial: Any = SimpleNamespace(members=(LEGS, SCREW), left=1.0, forms=(None, None))
    node = Node(trial, 0.0)
    heldout = {"circle": held(before * BEFORE**0.5, 1.0)}
    search: Any = SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=BEFORE)),
        left_by_formulas=lambda trial: left,
        checked=lambda node: SimpleNamespace(
            share=1.0, excused=False, missed=missed, missed_at_least=0.4, heldout=heldout
        ),
    )
    assert is_for_sure(search, node) is sure_of_it


@pytest.mark.parametrize(("left", "sure_of_it"), [(3.0, True), (5.0, False)], ids=["nearly all", "much is left"])
def test_several_that_leave_much_each_explain_a_part(
    monkeypatch: pytest.MonkeyPatch, left: float, sure_of_it: bool
) -> None:
    """Effects that nearly cancel are as free as a function; where formulas explain nearly all, none is asked."""
    monkeypatch.setattr(sure, "explain_in_part", lambda *_: False)
    trial: Any = SimpleNamespace(members=(LEGS, SCREW), left=1.0, forms=(None, None))
    search: Any = SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=BEFORE)),
        left_by_formulas=lambda trial: left,
        checked=lambda node: SimpleNamespace(share=1.0, excused=False, missed=0.1, missed_at_least=0.1, heldout={}),
    )
    assert is_for_sure(search, Node(trial, 0.0)) is sure_of_it


@pytest.mark.parametrize(("left", "sure_of_it"), [(2.5, True), (5.0, False)], ids=["by its formula", "by its form"])
def test_an_effect_at_all_elements_explains_nearly_all_by_its_formula(left: float, sure_of_it: bool) -> None:
    """Sizes of its own at each of six are as free as a function."""
    every = Member(Known("servo_lag", tuple("123456"), is_whole=True))
    trial: Any = SimpleNamespace(members=(every,), left=1.0, forms=(None,))
    search: Any = SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=BEFORE)),
        nodes=[],
        left_by_formulas=lambda trial: left,
        checked=lambda node: SimpleNamespace(share=1.0, excused=False, missed=0.1, missed_at_least=0.1, heldout={}),
    )
    assert is_for_sure(search, Node(trial, 0.0)) is sure_of_it
