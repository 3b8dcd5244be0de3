"""What ends a search: nothing less simple is looked at beside it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.settling import missed, settles
from hexdbb.learned import Learned


def searched(left: float, *, by_formulas: float = 0.0, error: float = 1.0, known: bool = False) -> tuple[Any, Any]:
    """Return a search in which nine noise variances are missing, and one hypothesis that leaves so much of them.

    Parameters
    ----------
    left, by_formulas : float
        Mean square left, and what formulas alone leave, in noise variances.
    error : float
        On circles left out, over what is expected.
    known : bool
        Whether it is a known effect.
    """
    heldout = {"circle": SimpleNamespace(after=error, expected=1.0, before=9.0)}
    checked = SimpleNamespace(reasons=(), excused=False, missed=0.1, missed_at_least=0.1, heldout=heldout)
    search = SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=10.0)),
        trials=SimpleNamespace(explained_before=0.0),
        nodes=[],
        checked=lambda node: checked,
        left_by_formulas=lambda trial: by_formulas or left,
    )
    trial = SimpleNamespace(left=left, refused=(), is_of_time=False)
    return search, SimpleNamespace(trial=trial, members=(0,), is_known=known)


@pytest.mark.parametrize("known", [True, False])
def test_what_explains_all_and_predicts_ends_it(known: bool) -> None:
    assert settles(*searched(1.01, known=known))


def test_a_free_function_of_time_never_does() -> None:
    search, node = searched(1.0)
    node.trial.is_of_time = True
    assert not settles(search, node)


def test_a_function_does_not_that_errs_more_on_other_circles_than_its_fit_expects() -> None:
    assert not settles(*searched(1.02, error=1.9))
    assert settles(*searched(1.02, error=1.9, known=True))


def test_an_effect_does_not_that_explains_half_by_its_form() -> None:
    assert settles(*searched(1.01, by_formulas=1.3, known=True))
    assert not settles(*searched(1.01, by_formulas=5.0, known=True))


LEAD, ALONG = Known("lead_error", ("5",)), Learned.parse("learned:slider:5:position")


@pytest.mark.parametrize(
    ("by_formulas", "error", "expected"),
    [(1.5, 1.4, 0.1), (1.5, 1.6, 2.0), (3.0, 1.4, 2.0)],
    ids=["as expected", "errs by more", "by its form"],
)
def test_what_a_formula_predicts_that_explains_nearly_all_counts(
    by_formulas: float, error: float, expected: float
) -> None:
    """Play that differs along the guideway missed other circles by the functions of its form, not by its formula."""
    search, node = searched(1.01, by_formulas=by_formulas, error=error, known=True)
    search.checked(node).missed = 2.0
    assert missed(search, node) == expected


@pytest.mark.parametrize(
    ("name", "by_formulas", "left", "expected"),
    [
        (ALONG.name, 3.0, 1.0, 0.03),
        (ALONG.name, 5.0, 1.0, 2.0),
        (ALONG.name, 3.0, 0.5, 2.0),
        ("learned:slider:6:position", 3.0, 1.0, 2.0),
    ],
    ids=["contains it", "its formula explains too little", "explains more", "elsewhere"],
)
def test_so_does_what_a_function_predicts_that_contains_an_effect(
    name: str, by_formulas: float, left: float, expected: float
) -> None:
    """A lead error 3 % off its formula, of which geometry takes most: the screw's function predicted every circle."""
    search, node = searched(1.01, by_formulas=by_formulas, known=True)
    function = Learned.parse(name)
    other = SimpleNamespace(trial=SimpleNamespace(left=left, is_of_time=False), members=(0,), hypotheses=(function,))
    of_effect, of_function = (SimpleNamespace(missed=each, heldout={}) for each in (2.0, 0.03))
    search.nodes, node.hypotheses = [other], (LEAD,)
    search.checked = lambda each: of_function if each is other else of_effect
    search.kin = {LEAD.name: {ALONG.name}}
    search.learnable = SimpleNamespace(by_name={ALONG.name: ALONG})
    search.engine = SimpleNamespace(absent=SimpleNamespace(ports=lambda effect: {"slider"}))
    assert missed(search, node) == expected
