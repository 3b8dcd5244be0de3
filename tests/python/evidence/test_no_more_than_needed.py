"""What is not looked at: what could explain no more than the set that was found, and what says the same more freely."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, NoReturn

import pytest
from tests.foreign_records import samples_of

from hexdbb.diagnosis import noise_of
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.search import expansion, known_together, last_resort
from hexdbb.evidence.search import search as search_module
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict import two_elements
from hexdbb.learned import Learned
from hexdbb.model import new_model
from hexdbb.samples.places import with_set_up_of

KNOWN = ("backlash", "bar_drift", "leg_thermal", "reversal_spike", "servo_lag", "straightness")


def search_in(name: str) -> Search:
    samples = samples_of(name)
    model = with_set_up_of(samples, new_model(samples.machine))
    return Search(Engine(samples, model, noise_of(samples)), KNOWN, DEFAULT)


def alone(search: Search, name: str) -> Node:
    (found,) = search.tried(search.root, [search.screen(search.root).scored(Learned.parse(name))])
    return found


def not_asked(*_: object) -> NoReturn:
    raise AssertionError("it was looked at")


def test_known_effects_that_are_what_they_are_ask_for_no_finer_functions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(expansion, "screened_further", not_asked)
    monkeypatch.setattr(search_module, "or_one_fine_enough", not_asked)
    found = search_in("drift-and-spike").run()
    assert {each.name for each in found.hypotheses} == {"bar_drift", "reversal_spike:6"}


def test_what_explains_all_is_no_reason_to_fit_pairs_that_explain_less(monkeypatch: pytest.MonkeyPatch) -> None:
    search = search_in("gauge-sticks")
    found = alone(search, "learned:reading:deflection_since_turn")
    assert not last_resort.needs_no_other(search, found)
    monkeypatch.setattr(two_elements, "_fitted", not_asked)
    assert two_elements.or_at_two_elements(search, found) is found


def test_known_effects_that_explain_a_part_are_not_fitted_together(monkeypatch: pytest.MonkeyPatch) -> None:
    search = search_in("bearing-and-legs")
    found = alone(search, "learned:slider:1:fine_position")
    monkeypatch.setattr(known_together, "_fitted", not_asked)
    assert known_together.or_known_together(search, found) is found


@pytest.mark.parametrize(
    ("name", "after", "expected", "enough"),
    [
        ("learned:leg:2:joint_angle", 1.1, 1.0, True),
        ("learned:leg:2:joint_angle", 1.5, 1.0, False),
        ("learned:leg:2:joint_angle", 3.4, 27.0, True),
        ("learned:leg:2:joint_angle", 5.0, 4.0, False),
        ("learned:ball:angle", 1.1, 1.0, True),
        ("learned:ball:angle", 3.4, 27.0, False),
    ],
)
def test_what_errs_no_more_than_its_fit_expects_along_one_axis_needs_no_other(
    monkeypatch: pytest.MonkeyPatch, name: str, after: float, expected: float, enough: bool
) -> None:
    held = SimpleNamespace(after=after, expected=expected)
    checked = SimpleNamespace(claimed=("circle",), heldout={"circle": held})
    search: Any = SimpleNamespace(criteria=DEFAULT, checked=lambda _: checked)
    monkeypatch.setattr(last_resort, "is_complete", lambda *_: True)
    best: Any = SimpleNamespace(
        is_known=False, trial=SimpleNamespace(left=1.02), members=[name], hypotheses=[Learned.parse(name)]
    )
    assert last_resort.needs_no_other(search, best) is enough
