"""What predicts, in place of what only fits."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.verdict import predicting

ONE = {"circle": 0.12, "feed": 0.2, "direction": 0.3}
SEVERAL = {"circle": 0.24, "feed": 0.32, "direction": 0.72, "arc": 0.04}


def node_of(count: int, left: float, errors: dict[str, float], reasons: tuple[str, ...] = ()) -> Any:
    """Return a set of so many hypotheses, and its errors over those without it by what was left out."""
    heldout = {
        grouping: SimpleNamespace(as_fitted=30.0 * error, after=30.0 * error, before=30.0, expected=1.0)
        for grouping, error in errors.items()
    }
    trial = SimpleNamespace(left=left, refused=())
    checked = SimpleNamespace(heldout=heldout, reasons=reasons)
    return SimpleNamespace(members=range(count), trial=trial, score=-left, checked=checked, is_known=True)


def answered(monkeypatch: pytest.MonkeyPatch, one: Any, several: Any, *, for_sure: bool = False) -> Any:
    """Return which of two sets is the answer where 901 noise variances are unexplained."""
    monkeypatch.setattr(predicting, "is_for_sure", lambda search, node: for_sure)
    root = SimpleNamespace(trial=SimpleNamespace(left=901.0))
    search: Any = SimpleNamespace(criteria=DEFAULT, root=root, nodes=[several, one], checked=lambda each: each.checked)
    return predicting.or_one_that_predicts(search, several)


def given_way(
    monkeypatch: pytest.MonkeyPatch,
    doubted: Any,
    other: Any,
    left: float,
    *,
    for_sure: bool = False,
    form_alone: bool = False,
) -> bool:
    """Return whether a doubted set gives way to another, where so many noise variances are unexplained."""
    monkeypatch.setattr(predicting, "has_form_alone", lambda search, node: form_alone)
    for each in (doubted, other):
        each.hypotheses, each.trial.is_free_in_time = (each,), False
    monkeypatch.setattr(predicting, "is_for_sure", lambda search, node: for_sure)
    monkeypatch.setattr(predicting, "is_doubtful", lambda search, node: node is doubted)
    search: Any = SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=left)),
        nodes=[doubted, other],
        checked=lambda each: each.checked,
        same_kind=lambda one, other: one is other,
    )
    answer = predicting.or_another_that_predicts(search, doubted)
    assert answer in (doubted, other)
    return answer is other


@pytest.mark.parametrize("form_alone", [False, True])
def test_nothing_gives_way_to_an_effect_that_is_form_alone(monkeypatch: pytest.MonkeyPatch, form_alone: bool) -> None:
    """A gauge's gain explained four hundredths of what it did beside a delay by its formula."""
    doubted, other = node_of(1, 2.4, SEVERAL), node_of(1, 1.1, ONE)
    assert given_way(monkeypatch, doubted, other, left=901.0, form_alone=form_alone) is not form_alone


def test_what_predicts_better_is_the_cause_though_it_leaves_more(monkeypatch: pytest.MonkeyPatch) -> None:
    one, several = node_of(1, 9.0, ONE), node_of(2, 1.1, SEVERAL)
    assert answered(monkeypatch, one, several) is one


@pytest.mark.parametrize(
    ("one", "for_sure"),
    [
        (node_of(1, 9.0, ONE), True),
        (node_of(1, 200.0, ONE), False),
        (node_of(1, 9.0, ONE | {"feed": 0.4}), False),
        (node_of(1, 9.0, {"feed": 0.1, "direction": 0.1, "arc": 0.1}), False),
        (node_of(1, 9.0, ONE, ("does not predict the other feed",)), False),
    ],
    ids=["the set is sure", "explains too little", "errs more on a feed", "claims no other circle", "refuted"],
)
def test_else_the_set_stays(monkeypatch: pytest.MonkeyPatch, one: Any, for_sure: bool) -> None:
    several = node_of(2, 1.1, SEVERAL)
    assert answered(monkeypatch, one, several, for_sure=for_sure) is several


@pytest.mark.parametrize(
    ("score", "for_sure", "gives_way"),
    [(-300.0, True, False), (-300.0, False, True), (300.0, True, True)],
    ids=["fits worse", "fits worse than one that is not sure", "fits better"],
)
def test_what_is_for_sure_gives_way_to_nothing_that_fits_worse(
    monkeypatch: pytest.MonkeyPatch, score: float, for_sure: bool, gives_way: bool
) -> None:
    """Circles that hardly hold geometry are predicted badly by a formula too, and by a free function as it expects."""
    formula, function = node_of(1, 1.0, ONE), node_of(1, 1.1, ONE)
    formula.score, function.score = 0.0, score
    assert given_way(monkeypatch, formula, function, 9.0, for_sure=for_sure) is gives_way


@pytest.mark.parametrize(
    ("errors", "gives_way"),
    [
        (ONE, True),
        (ONE | {"direction": 0.31}, False),
        (ONE | {"circle": 0.13}, True),
        ({"circle": 0.12, "feed": 0.2}, False),
    ],
    ids=["errs no more", "errs more where the set misses", "errs more elsewhere", "claims nothing there"],
)
def test_nothing_gives_way_to_what_errs_more_where_it_is_doubted(
    monkeypatch: pytest.MonkeyPatch, errors: dict[str, float], gives_way: bool
) -> None:
    """A gauge with hysteresis, 2,000 nats ahead of a joint that only expects to err in the direction left out."""
    gauge, joint = node_of(1, 1.1, ONE), node_of(1, 9.0, errors)
    assert given_way(monkeypatch, gauge, joint, 101.0) is gives_way


@pytest.mark.parametrize(
    ("left", "left_by_other", "is_known", "gives_way"),
    [(1.2, 9.0, False, False), (1.2, 9.0, True, True), (1.2, 1.25, False, True), (4.0, 9.0, False, True)],
    ids=["leaves none", "a known effect by its form", "neither leaves any", "leaves some itself"],
)
def test_a_function_that_leaves_no_structure_gives_way_to_nothing_that_leaves_some(
    monkeypatch: pytest.MonkeyPatch, left: float, left_by_other: float, is_known: bool, gives_way: bool
) -> None:
    """A slider that lags, on circles that hardly hold geometry, and its leg, which leaves three times the noise."""
    slider, leg = node_of(1, left, ONE), node_of(1, left_by_other, ONE)
    slider.is_known = is_known
    assert given_way(monkeypatch, slider, leg, 185.0) is gives_way


@pytest.mark.parametrize(
    ("of_set", "of_other", "gives_way"),
    [(1.5, 2.0, False), (1.5, 1.2, True), (3.0, 4.0, True)],
    ids=["its formulas explain less", "its formulas explain more", "the set explains by its forms"],
)
def test_several_that_explain_by_formulas_give_way_to_none_that_explains_less_by_its_own(
    monkeypatch: pytest.MonkeyPatch, of_set: float, of_other: float, gives_way: bool
) -> None:
    """Functions of forms predict what they were fitted to; formulas that explain nearly all are what it is."""
    several, other = node_of(2, 1.0, ONE), node_of(2, 1.1, ONE)
    for each in (several, other):
        each.is_known, each.trial.is_free_in_time = True, False
    by_formulas = {id(several.trial): of_set, id(other.trial): of_other}
    monkeypatch.setattr(predicting, "is_for_sure", lambda search, node: False)
    monkeypatch.setattr(predicting, "is_doubtful", lambda search, node: node is several)
    monkeypatch.setattr(predicting, "has_form_alone", lambda search, node: False)
    search: Any = SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=9.0)),
        nodes=[several, other],
        checked=lambda each: each.checked,
        left_by_formulas=lambda trial: by_formulas[id(trial)],
    )
    assert predicting.or_another_that_predicts(search, several) is (other if gives_way else several)


def search_of(*sets: tuple[Any, float]) -> Any:
    """Return a search that has tried some sets; with each what its formulas leave."""
    by_formulas = {id(each.trial): left for each, left in sets}
    return SimpleNamespace(
        criteria=DEFAULT,
        root=SimpleNamespace(trial=SimpleNamespace(left=901.0)),
        nodes=[each for each, _ in sets],
        checked=lambda each: each.checked,
        left_by_formulas=lambda trial: by_formulas[id(trial)],
    )


@pytest.mark.parametrize(
    ("formulas", "errors", "left", "is_answer"),
    [
        (4.9, ONE, 5.0, True),
        (5.2, ONE, 5.0, False),
        (4.9, ONE | {"feed": 0.4}, 5.0, False),
        (4.9, ONE, 200.0, False),
    ],
    ids=["explains and predicts", "formulas explain less", "errs more on a feed", "explains too little"],
)
def test_fewer_effects_whose_formulas_explain_as_much_are_the_answer(
    formulas: float, errors: dict[str, float], left: float, is_answer: bool
) -> None:
    """A gauge that drifts and is read late, for a delay, a ball off its axis and six screws that warm."""
    fewer, several = node_of(2, left, errors), node_of(3, 1.8, SEVERAL)
    for each, faults in ((fewer, 2), (several, 8)):
        each.is_known, each.faults, each.trial.forms = True, faults, (None,)
    search = search_of((several, 5.1), (fewer, formulas))
    assert predicting.or_fewer_by_formulas(search, several) is (fewer if is_answer else several)


@pytest.mark.parametrize(
    ("of_fewer", "of_several", "is_answer"), [(False, True, True), (True, True, False), (False, False, False)]
)
def test_fewer_of_their_own_forms_stand_before_more_of_which_one_is_of_another(
    of_fewer: bool, of_several: bool, is_answer: bool
) -> None:
    """Two spikes for play of both sliders beside a lag, which errs a little less on one feed."""
    fewer, several = node_of(2, 5.0, ONE | {"feed": 0.4}), node_of(3, 1.8, SEVERAL)
    for each, faults, is_odd in ((fewer, 2, of_fewer), (several, 3, of_several)):
        each.is_known, each.faults = True, faults
        each.trial.forms = (None, SimpleNamespace(is_odd=is_odd))
    search = search_of((several, 5.1), (fewer, 4.9))
    assert predicting.or_fewer_by_formulas(search, several) is (fewer if is_answer else several)
