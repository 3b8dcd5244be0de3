"""A known effect beside a learned function that is a cause at its own place is a lead; it is told by its own size."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.discovery import causes
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.verdict import verdict
from hexdbb.evidence.verdict.verdict import Found
from hexdbb.learned import Learned

PLAY = Known("backlash", ("3",))
GIVES = Learned.parse("learned:leg:3:leg_force")
ELSEWHERE = Learned.parse("learned:slider:5:velocity")


@pytest.mark.parametrize(
    ("beside", "left_without", "by_form", "grade"),
    [
        (GIVES, 50.0, False, "unknown"),
        (ELSEWHERE, 50.0, False, "effect"),
        (ELSEWHERE, 50.0, True, "unknown"),
        (ELSEWHERE, 10.0, False, "unknown"),
        (PLAY, 50.0, True, "effect"),
        (PLAY, 10.0, False, "effect"),
    ],
    ids=[
        *("at its place", "elsewhere", "elsewhere, by its form", "elsewhere, which leaves as much"),
        *("known, by its form", "known, which leaves as much"),
    ],
)
def test_it_is_a_lead_beside_a_function_of_its_place_or_one_that_may_leave_as_much(
    monkeypatch: pytest.MonkeyPatch, beside: Known | Learned, left_without: float, by_form: bool, grade: str
) -> None:
    monkeypatch.setattr(verdict, "left_without", lambda search, node, each: left_without)
    monkeypatch.setattr(verdict, "of_forms", lambda search, trial: 20.0)
    monkeypatch.setattr(verdict, "is_by_form", lambda *_: by_form)
    node: Any = SimpleNamespace(trial=SimpleNamespace(left=1.0), hypotheses=(PLAY, beside), members=(PLAY, beside))
    by_name: dict[str, Any] = {each.name: each for each in (GIVES, ELSEWHERE)}
    search: Any = SimpleNamespace(
        learnable=SimpleNamespace(by_name=by_name), kin={PLAY.name: {GIVES.name}, GIVES.name: set()}
    )
    is_lead = verdict._is_lead(search, node, [PLAY, beside], PLAY)
    assert Found(PLAY, (), 0.0, is_lead=is_lead).grade == grade
    assert not verdict._is_lead(search, node, [PLAY, GIVES], GIVES)


@pytest.mark.parametrize(
    ("own", "share", "size", "expected_um"),
    [(PLAY, 0.01, 49.0, 3.5), (PLAY, 0.81, 49.0, 4.5), (GIVES, 0.01, 49.0, 0.5)],
)
def test_a_known_effect_is_as_large_as_what_it_pushes(
    own: Known | Learned, share: float, size: float, expected_um: float
) -> None:
    """The noise is 0.5 µm, and 100 times its variance is unexplained."""
    search: Any = SimpleNamespace(
        engine=SimpleNamespace(row_noise_mm=[5e-4]),
        root=SimpleNamespace(trial=SimpleNamespace(left=101.0)),
        trials=SimpleNamespace(size=lambda trial, known: size),
    )
    node: Any = SimpleNamespace(trial=None)
    assert causes._own_size_um(search, node, Found(own, (), 0.0), {own: share}) == pytest.approx(expected_um)
