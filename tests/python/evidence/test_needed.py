"""What a set of hypotheses needs, and when one set is better than another: on sets whose figures are stated."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.fit.trials import Trials
from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.linear.readings import Linear
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search import known_together
from hexdbb.evidence.search.needed import by_formulas_instead, is_better, needs, needs_all, rests_on_form
from hexdbb.evidence.verdict import exchange
from hexdbb.evidence.verdict.exchange import settled
from hexdbb.learned import Learned

DRIFT, GAIN = (Member(Known(name, ("1",), is_whole=True)) for name in ("bar_drift", "bar_gain"))
SCREW, PLAY = (Member(Known(name, ("1",))) for name in ("screw_thermal", "backlash"))


@pytest.fixture(autouse=True)
def looked_at_by_the_stub(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is found beside a set comes from the search that a test states."""
    monkeypatch.setattr(exchange, "expanded", lambda search, node, learns: search.expand(node, learns))


class Trialled:
    """Trials of sets whose mean square left is stated; those asked for first are remembered."""

    explained_before = 0.0

    def __init__(self, left: dict[frozenset[Member], float], fitted: set[frozenset[Member]]) -> None:
        self._left, self._fitted = left, fitted
        self.asked: list[frozenset[Member]] = []
        self.bends: dict[tuple[Member, ...], float] = {}
        self.forms: dict[Member, Form] = {}

    def bent(self, trial: Any) -> float:
        return self.bends.get(trial.members, 0.0)

    def has(self, members: tuple[Member, ...]) -> bool:
        return frozenset(members) in self._fitted

    def of_fewer(self, members: tuple[Member, ...], _: Any) -> Any:
        return self.of(members)

    def of(self, members: tuple[Member, ...]) -> Any:
        self.asked.append(frozenset(members))
        left = self._left[frozenset(members)]
        forms = tuple(self.forms.get(each) for each in members)
        return SimpleNamespace(members=members, left=left, log_evidence=-1000.0 * left, refused=(), forms=forms)

    def size(self, trial: Any, known: Known) -> float:
        return 3.0


@pytest.fixture(autouse=True)
def nothing_is_for_sure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exchange, "is_for_sure", lambda search, node: False)


def searched(
    left: dict[tuple[Member, ...], float],
    *fitted: tuple[Member, ...],
    excused: tuple[Member, ...] = (),
    missing: tuple[Member, ...] = (),
    missed: float = 1.0,
    by_formulas: dict[tuple[Member, ...], float] | None = None,
) -> Any:
    """Return a search whose empty set leaves 11 noise variances, and the node of the first set.

    One set may predict only so far that its form excuses it, one may miss what was left out; some may leave more
    without the functions of their forms.
    """
    trials = Trialled({frozenset(each): value for each, value in left.items()}, {frozenset(each) for each in fitted})
    node = node_of(trials.of(next(iter(left))))
    search = SimpleNamespace(
        criteria=DEFAULT,
        trials=trials,
        root=SimpleNamespace(trial=SimpleNamespace(left=11.0)),
        engine=SimpleNamespace(absent=SimpleNamespace(ports=lambda effect: {effect.partition("_")[0]})),
        nodes=[node],
        log_prior=lambda hypothesis: 0.0,
        left_by_formulas=lambda trial: (by_formulas or {}).get(trial.members, trial.left),
        checked_trial=lambda trial: SimpleNamespace(
            reasons=(), excused=trial.members == excused, missed=missed if trial.members in (excused, missing) else 0.3
        ),
        checked=lambda node: SimpleNamespace(
            reasons=(), excused=node.members == excused, missed=0.0, missed_at_least=0.0, heldout={}
        ),
        left_by_formula=lambda trial, form: trial.left,
        learns=True,
        expand=lambda node, learns: [],
        node=lambda members, near: node_of(trials.of(members)),
    )
    trials.asked.clear()
    return search, node


def node_of(trial: Any) -> Node:
    return Node(trial, trial.log_evidence)


@pytest.mark.parametrize(("left", "expected"), [(1.0, True), (1.19, False)])
def test_more_effects_are_better_where_they_explain_more(left: float, expected: bool) -> None:
    search, wider = searched({(DRIFT, GAIN): left, (SCREW,): 1.2})
    than = node_of(search.trials.of((SCREW,)))
    assert is_better(search, wider, than) is expected
    assert not is_better(search, than, wider)


@pytest.mark.parametrize(("bent", "expected"), [(0.4, True), (0.01, False)])
def test_geometry_bent_beyond_its_priors_counts_as_unexplained(bent: float, expected: bool) -> None:
    """A bow of three times the noise beside spikes left a half of the noise's variance, and geometry far off."""
    search, wider = searched({(DRIFT, GAIN): 1.05, (DRIFT,): 1.4, (GAIN,): 8.0, (SCREW,): 1.06})
    search.trials.bends = {(DRIFT,): bent, (SCREW,): bent}
    search.trials.size = lambda trial, known: 0.2
    assert needs(search, wider, GAIN) is expected
    assert is_better(search, wider, node_of(search.trials.of((SCREW,)))) is expected


@pytest.mark.parametrize(("part", "expected"), [(0.15, True), (0.05, False)])
def test_an_effect_of_which_its_form_explains_nearly_all_is_not_there(part: float, expected: bool) -> None:
    """A drift beside a delay that changes over the test: functions of time explain what the delay leaves."""
    search, both = searched({(GAIN, DRIFT): 1.0, (GAIN,): 3.0})
    form = Form(0.4, 0.1, ("learned:reading:fine_time",), columns=9)
    search.trials.forms = {DRIFT: form}
    search.left_by_formula = lambda trial, each: 3.0 - part * 2.0 if each is form else trial.left
    assert needs(search, node_of(search.trials.of(both.members)), DRIFT) is expected


@pytest.mark.parametrize(("left", "expected"), [(1.3, True), (8.0, False)])
def test_beside_an_effect_that_lives_in_its_form_a_small_one_counts_by_its_own_formula(
    left: float, expected: bool
) -> None:
    """A joint's friction of three times the noise, beside a bow of thirty that geometry imitates but for its form: the
    formulas of both leave more than those of the bow, which leave most, and it was dropped.
    """
    formulas = {(GAIN,): 154.0, (GAIN, DRIFT): 333.0}
    search, both = searched({(GAIN, DRIFT): 1.0, (GAIN,): 9.8}, by_formulas=formulas)
    search.root.trial.left = 249.0
    search.trials.size = lambda trial, known: 0.2
    form = Form(0.4, 0.1, ("learned:leg:5:turning_rate",), columns=9)
    search.trials.forms = {DRIFT: form}
    search.left_by_formula = lambda trial, each: left if each is form else trial.left
    assert needs(search, node_of(search.trials.of(both.members)), DRIFT) is expected


@pytest.mark.parametrize(
    ("excused", "missing", "missed", "expected"),
    [((DRIFT,), (), 1.0, True), ((), (DRIFT,), 1.0, True), ((), (DRIFT,), 0.6, True), ((), (DRIFT,), 0.4, False)],
    ids=["excused", "misses most", "misses so much that it is not for sure", "predicts"],
)
def test_two_effects_that_predict_are_better_than_one_that_does_not(
    excused: tuple[Member, ...], missing: tuple[Member, ...], missed: float, expected: bool
) -> None:
    """The functions of the one effect's form explain all but a hundredth of what the two do."""
    left = {(DRIFT, GAIN): 1.0, (DRIFT,): 1.01, (GAIN,): 8.0}
    search, both = searched(left, excused=excused, missing=missing, missed=missed)
    alone = node_of(search.trials.of((DRIFT,)))
    assert is_better(search, both, alone) is expected
    assert needs_all(search, both) is expected


@pytest.mark.parametrize("ports", [{"slider"}, set()], ids=["of its element", "of another port"])
def test_what_makes_one_effect_predict_is_no_second_one_of_its_element(ports: set[str]) -> None:
    """Play of a slider says how its stiction dies away otherwise than by its formula."""
    left = {(SCREW, PLAY): 1.0, (SCREW,): 1.01, (PLAY,): 8.0}
    search, both = searched(left, missing=(SCREW,), missed=2.0)
    search.engine.absent.ports = lambda effect: ports or {effect}
    assert is_better(search, both, node_of(search.trials.of((SCREW,)))) is not bool(ports)
    assert needs_all(search, both) is not bool(ports)


FORM = DEFAULT.secondary * DEFAULT.form_sigma**2 * 10.0
"""What a form explains at most, of ten noise variances."""


@pytest.mark.parametrize(
    ("one", "two", "expected"),
    [(2.0, 1.0, True), (1.0 + 0.9 * FORM, 1.0, False), (2.0, 2.0 - 0.9 * FORM, False), (5.0, 2.0, False)],
    ids=["explain by formulas", "a form 20 % off", "rest on their forms too", "leave more than a form"],
)
def test_formulas_of_two_are_better_than_the_form_of_one(one: float, two: float, expected: bool) -> None:
    """With the functions of its form the one effect explains all but a hundredth of what the two do."""
    formulas = {(DRIFT,): one, (DRIFT, GAIN): two}
    search, both = searched({(DRIFT, GAIN): 1.0, (DRIFT,): 1.01, (GAIN,): 8.0}, by_formulas=formulas)
    alone = node_of(search.trials.of((DRIFT,)))
    assert rests_on_form(search, alone.trial) is (one - 1.01 >= FORM * 9.99 / 10.0)
    assert by_formulas_instead(search, both, alone.trial) is expected
    assert is_better(search, both, alone) is expected
    assert needs_all(search, both) is expected


def test_of_as_many_effects_those_that_explain_by_formulas_are_better() -> None:
    """Functions of forms hold what geometry leaves of a slow drift: evidence does not tell which drift it is."""
    left = {(DRIFT, GAIN): 1.02, (DRIFT, SCREW): 1.0}
    search, true = searched(left, by_formulas={(DRIFT, GAIN): 1.1, (DRIFT, SCREW): 4.0})
    other = node_of(search.trials.of((DRIFT, SCREW)))
    assert other.score > true.score
    assert is_better(search, true, other)
    assert not is_better(search, other, true)


def test_sets_that_are_fitted_already_are_asked_first() -> None:
    """The third of them is needless beside the two that are fitted: no other set is."""
    search, node = searched({(DRIFT, GAIN, SCREW): 1.0, (DRIFT, GAIN): 1.0}, (DRIFT, GAIN))
    assert not needs_all(search, node)
    assert search.trials.asked == [frozenset((DRIFT, GAIN))]


def test_an_effect_that_stood_in_for_what_came_later_is_left_out() -> None:
    search, node = searched({(SCREW, DRIFT, GAIN): 1.0, (DRIFT, GAIN): 1.01, (SCREW, GAIN): 5.0, (SCREW, DRIFT): 6.0})
    search.trials._left |= {frozenset((DRIFT,)): 7.0, frozenset((GAIN,)): 7.0}
    assert settled(search, node).members == (DRIFT, GAIN)


@pytest.mark.parametrize(
    ("by_formulas", "one_alone", "looked_at"),
    [(1.1, 1.1, False), (3.0, 1.1, True), (1.1, 3.0, True)],
    ids=["by their formulas", "together by forms", "one by its form"],
)
def test_effects_that_explain_nearly_all_by_their_formulas_are_not_looked_at_again(
    by_formulas: float, one_alone: float, looked_at: bool
) -> None:
    left = {(DRIFT, GAIN): 1.0, (DRIFT,): 6.0, (GAIN,): 6.0}
    search, node = searched(left, by_formulas={(DRIFT, GAIN): by_formulas})
    search.left_by_formula = lambda trial, form: one_alone
    expanded: list[Node] = []
    search.expand = lambda each, learns: expanded.append(each) or []
    assert settled(search, node) is node
    assert bool(expanded) is looked_at


@pytest.mark.parametrize("is_sure", [True, False])
def test_beside_known_effects_for_sure_only_known_ones_are_looked_at_again(
    monkeypatch: pytest.MonkeyPatch, is_sure: bool
) -> None:
    """Each explains most of what it does by its own formula, not nearly all."""
    search, node = searched({(DRIFT, GAIN): 1.0, (DRIFT,): 6.0, (GAIN,): 6.0}, by_formulas={(DRIFT, GAIN): 1.5})
    search.left_by_formula = lambda trial, form: 1.8
    monkeypatch.setattr(exchange, "is_for_sure", lambda search, node: is_sure)
    asked: list[bool] = []
    search.expand = lambda each, learns: asked.append(learns) or []
    assert settled(search, node) is node
    assert asked == [not is_sure, not is_sure]


@pytest.mark.parametrize(
    ("is_sure", "by_formulas", "left_instead", "stays"),
    [(True, 1.5, 1.2, True), (False, 1.5, 1.2, False), (True, 4.0, 1.2, False), (True, 1.5, 1.1, False)],
    ids=["for sure by formulas", "not for sure", "by forms", "left far less"],
)
def test_known_effects_for_sure_by_formulas_are_given_up_for_no_function(
    monkeypatch: pytest.MonkeyPatch, is_sure: bool, by_formulas: float, left_instead: float, stays: bool
) -> None:
    """What the reading does since each circle began says what a slider's reversals do, with a little more evidence."""
    since = Member(Learned.parse("learned:reading:time_in_sweep"))
    left = {(DRIFT, GAIN): 1.3, (DRIFT, since): left_instead, (DRIFT,): 6.0, (GAIN,): 6.0, (since,): 6.0}
    search, node = searched(left, by_formulas={(DRIFT, GAIN): by_formulas})
    monkeypatch.setattr(exchange, "at_its_place", lambda search, cause, learned: False)
    search.nodes.append(node_of(search.trials.of((DRIFT, since))))
    search.same_kind = lambda one, other: one == other
    monkeypatch.setattr(exchange, "is_for_sure", lambda search, node: is_sure and since not in node.members)
    monkeypatch.setattr(exchange, "in_known_words", lambda search, node: node)
    assert settled(search, node).members == ((DRIFT, GAIN) if stays else (DRIFT, since))


class BesideLater:
    """Forms of which the first is too large for its effect until the second stands beside it."""

    def __init__(self, deviation: float) -> None:
        self.deviation = deviation

    def with_columns(self, linear: Linear, form: Form) -> Linear:
        return replace(linear, own=np.hstack([linear.own, np.ones((len(linear.own), form.columns))]))

    def beside(self, linear: Linear, fitted: Any, known: Known) -> tuple[Linear, Form]:
        first = linear.own.shape[1]
        if known.effect == "bar_drift" and first == 1:
            return linear, Form(0.0, 0.0, ())
        wider = replace(linear, own=np.hstack([linear.own, np.ones((len(linear.own), 2))]))
        return wider, Form(0.1, self.deviation, ("learned:reading:time",), 2, first)


@pytest.mark.parametrize(("deviation", "firsts"), [(0.1, [3, 1]), (0.2, [1, 3])], ids=["as most are", "larger"])
def test_a_form_too_large_at_first_is_asked_for_again_beside_the_others(deviation: float, firsts: list[int]) -> None:
    """So is one larger than most, beside which it was."""
    trials = Trials.__new__(Trials)
    trials.forms = BesideLater(deviation)  # type: ignore[assignment]
    trials.criteria = DEFAULT
    linear = Linear(np.zeros(4), np.ones((4, 1)), np.zeros(1))
    known = [DRIFT.hypothesis, GAIN.hypothesis]
    wider, found = trials._with_forms(linear, None, known)  # type: ignore[arg-type]
    assert wider.own.shape[1] == 5
    assert [found[each].first for each in known] == firsts


@pytest.mark.parametrize(
    ("left_in_words", "is_there", "stays"),
    [(1.04, False, True), (1.0, True, True), (1.0, False, False)],
    ids=["leaves as much", "at the same place", "elsewhere"],
)
def test_the_same_causes_in_words_of_learned_functions_are_no_better_set(
    monkeypatch: pytest.MonkeyPatch, left_in_words: float, is_there: bool, stays: bool
) -> None:
    """A base that tips over one foot is contained by a bow, and leaves less than half of what that does."""
    monkeypatch.setattr(exchange, "at_its_place", lambda search, cause, learned: is_there)
    monkeypatch.setattr(exchange, "in_known_words", lambda search, node: node)
    time, bend = (Member(Learned.parse(f"learned:reading:{name}")) for name in ("time", "deflection"))
    left = {(DRIFT, bend): 1.05, (time, bend): left_in_words, (DRIFT,): 5.0, (time,): 5.0, (bend,): 6.0}
    search, node = searched(left)
    search.nodes.append(node_of(search.trials.of((time, bend))))
    search.same_kind = lambda one, other: one == other or {one, other} == {DRIFT.hypothesis, time.hypothesis}
    assert settled(search, node).members == ((DRIFT, bend) if stays else (time, bend))


def test_a_set_with_one_too_many_is_known_by_what_it_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    """The two that are missing stand in no set of their size: a third takes the little that geometry bends."""
    left = {(DRIFT, GAIN, SCREW): 1.0, (DRIFT, GAIN): 1.01, (DRIFT, SCREW): 5.0, (GAIN, SCREW): 6.0}
    search, node = searched(left | {(DRIFT,): 7.0, (GAIN,): 7.0, (SCREW,): 10.0})
    search.nodes.clear()
    members = [SimpleNamespace(known=each.hypothesis) for each in node.members]
    screened = SimpleNamespace(members=members, effects=[], log_evidence=1.0)
    monkeypatch.setattr(known_together, "known_sets", lambda search, most: [screened])
    monkeypatch.setattr(known_together, "as_much_as", lambda search, node, part: 0.0)
    best = node_of(search.trials.of((DRIFT,)))
    for each in (node, best):
        each.trial.refused = ()
    assert known_together.or_known_together(search, best).members == (DRIFT, GAIN)
