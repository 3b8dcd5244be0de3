"""Numbers of two functions of one set stay apart: a set has each function once."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.search import number
from hexdbb.learned import Learned


def test_a_function_is_not_moved_to_the_number_of_another(monkeypatch: pytest.MonkeyPatch) -> None:
    one, other = (Learned.parse(f"learned:cup:acceleration_along@{each}") for each in ("120", "121"))
    trial: Any = SimpleNamespace(members=(Member(one), Member(other)), names=(one.name, other.name), log_evidence=0.0)
    monkeypatch.setattr(number, "best_number", lambda trials, trial, member: other)
    # A set with one function twice is not asked for: there is nothing that could fit it.
    search: Any = SimpleNamespace(trials=None, criteria=DEFAULT, count_as=lambda moved, hypothesis: None)
    assert number.with_best_number(search, trial, trial.members[0].hypothesis) is trial
