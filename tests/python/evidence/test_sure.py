"""What may be said for sure: known causes that explain enough without the functions that refine them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.errors import RunError
from hexdbb.evidence import sure
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.screen import Known
from hexdbb.evidence.sure import Grade, graded
from hexdbb.evidence.trial import Member
from hexdbb.learned import Learned

LEGS = Member(Known("leg_thermal", ("all",), is_whole=True))
STEPS = Member(Learned.parse("learned:leg:4:time"))
BEFORE, SHARE = 25.0, 24.0


@pytest.fixture(autouse=True)
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


@pytest.mark.parametrize("grade", ["effect", "ambiguous"])
@pytest.mark.parametrize(("left", "is_sure"), [(ENOUGH - 0.1, True), (ENOUGH + 0.1, False), (None, False)])
def test_causes_explain_enough_without_what_refines_them(grade: Grade, left: float | None, is_sure: bool) -> None:
    assert graded(searched(left), NODE, grade) == (grade if is_sure else "unknown")


def test_what_is_unknown_stays_so() -> None:
    assert graded(searched(None), NODE, "unknown") == "unknown"
