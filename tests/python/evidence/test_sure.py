"""What may be said for sure: known causes that explain enough without the functions that refine them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.errors import RunError
from hexdbb.evidence import sure
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.form import Form
from hexdbb.evidence.screen import Known
from hexdbb.evidence.sure import Grade, graded, is_for_sure
from hexdbb.evidence.trial import Member
from hexdbb.learned import Learned

LEGS = Member(Known("leg_thermal", ("all",), is_whole=True))
STEPS = Member(Learned.parse("learned:leg:4:time"))
BEFORE, SHARE = 25.0, 24.0


@pytest.fixture
def explains_and_predicts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sure, "is_for_sure", lambda *_: True)


def searched(left: float | None) -> Any:
    """Return a search in which the known effect alone leaves so much, or cannot be fitted."""

    def of(members: tuple[Member, ...]) -> Any:
        assert members == (LEGS,)
        if left is None:
            raise RunError("no fit")
        return SimpleNamespace(left=left)

    root = SimpleNamespace(trial=SimpleNamespace(left=BEFORE))
    return SimpleNamespace(criteria=DEFAULT, root=root, trials=SimpleNamespace(of=of))


NODE: Any = SimpleNamespace(members=(LEGS, STEPS))
ENOUGH = BEFORE - DEFAULT.explained_min * SHARE


@pytest.mark.usefixtures("explains_and_predicts")
@pytest.mark.parametrize("grade", ["effect", "ambiguous"])
@pytest.mark.parametrize(("left", "is_sure"), [(ENOUGH - 0.1, True), (ENOUGH + 0.1, False), (None, False)])
def test_causes_explain_enough_without_what_refines_them(grade: Grade, left: float | None, is_sure: bool) -> None:
    assert graded(searched(left), NODE, grade) == (grade if is_sure else "unknown")


@pytest.mark.usefixtures("explains_and_predicts")
def test_what_is_unknown_stays_so() -> None:
    assert graded(searched(None), NODE, "unknown") == "unknown"


@pytest.mark.parametrize(("beyond", "sure_of_it"), [(-0.1, True), (0.1, False)])
@pytest.mark.parametrize("excused", [True, False])
def test_one_effect_errs_by_no_more_than_it_explains(beyond: float, sure_of_it: bool, excused: bool) -> None:
    """Whether its form excuses it, or its formula nearly as it is leaves only noise."""
    form = Form(0.02, 0.5 * DEFAULT.form_exact, ())
    node: Any = SimpleNamespace(members=(LEGS,), trial=SimpleNamespace(left=1.0, forms=(form,)))
    search: Any = SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=BEFORE)),
        left_by_formulas=lambda trial: 1.0,
        checked=lambda node: SimpleNamespace(share=1.0, excused=excused, missed=DEFAULT.missed_bent + beyond),
    )
    assert is_for_sure(search, node) is sure_of_it
