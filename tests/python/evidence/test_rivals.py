"""Which sets of hypotheses are other explanations of a cause."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.admissible import Checked
from hexdbb.evidence.fit.heldout import HeldOut
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.verdict.rivals import Rivals, rivals_of
from hexdbb.learned import Learned

CAUSE = Known("ball_eccentricity", ("2",))
TILT = Learned.parse("learned:ball:pitch")
SCREW = Learned.parse("learned:slider:6:screw_phase")
HOME, TURN = Learned.parse("learned:ball:time"), Learned.parse("learned:ball:yaw")
DRIFT, GAIN = Known("bar_drift", ("bar",), is_whole=True), Known("bar_gain", ("bar",), is_whole=True)
OTHER_LAG, OTHER_HOME = Known("servo_lag", ("5",)), Learned.parse("learned:slider:5:velocity")
CIRCLES, FEED = "does not predict other circles", "does not predict the other feed"
HELD = HeldOut(before=50.0, after=40.0, share=0.9, expected=1.0, as_fitted=40.0)
ERRS = Checked({"circle": HELD}, 1.0, (), missed=12.0, missed_at_least=12.0)
"""Of a cause that errs where left out by more than all that it explains."""


def node_of(score: float, *hypotheses: Known | Learned, left: float = 1.0) -> Node:
    names, members = tuple(each.name for each in hypotheses), tuple(map(Member, hypotheses))
    trial: Any = SimpleNamespace(
        members=members, refused=(), left=left, names=names, forms=(None,) * len(names), is_of_time=False
    )
    return Node(trial, score)


def rivalry(
    chosen: Checked,
    other: Checked,
    rival: Any,
    cause: Known = CAUSE,
    home: Learned = HOME,
    beside: tuple[Known, ...] = (),
    by_formulas: tuple[float, float] = (1.0, 1.0),
    left: float = 1.0,
    by_formula: float = 1.0,
) -> Rivals:
    """Return what rivals a cause, which has a score of 0 and lives in a learned function.

    Other causes may stand beside it; what the formulas of the set and the rival leave is stated, and what the set does,
    and what it leaves with the formula of one of its causes alone, where the others leave eleven noise variances.
    """
    node, root = node_of(0.0, cause, *beside, left=left), node_of(-1000.0, left=11.0)
    formulas = {id(node.trial): by_formulas[0], id(rival.trial): by_formulas[1]}
    checks = {id(node): chosen, id(rival): other}
    search: Any = SimpleNamespace(
        nodes=[root, node, rival],
        root=root,
        criteria=DEFAULT,
        checked=lambda each: checks[id(each)],
        same_kind=lambda one, two: one.name in (two.name, home.name),
        kin={cause.name: {home.name}, OTHER_LAG.name: {OTHER_HOME.name}},
        learnable=SimpleNamespace(by_name={each.name: each for each in (home, OTHER_HOME)}),
        left_by_formulas=lambda trial: formulas.get(id(trial), trial.left),
        left_by_formula=lambda trial, form: by_formula,
        trials=SimpleNamespace(
            explained_before=0.0, of=lambda members: SimpleNamespace(left=11.0), bent=lambda trial: 0.0
        ),
        engine=SimpleNamespace(
            absent=SimpleNamespace(ports=lambda effect: frozenset({"ball"})),
            base=SimpleNamespace(info=lambda effect: SimpleNamespace(is_set_up=True, element_kind="mount")),
        ),
    )
    return rivals_of(search, node, cause)


def rivals(*args: Any, **kwargs: Any) -> tuple[str, ...]:
    """Return the names of those of another kind alone."""
    return rivalry(*args, **kwargs).others


@pytest.mark.parametrize(
    ("score", "reasons", "is_rival"),
    [
        (50.0, (CIRCLES,), True),
        (50.0, (CIRCLES, FEED), False),
        (0.0, (CIRCLES,), False),
        (-50.0, (CIRCLES,), False),
    ],
    ids=["fits better", "misses more", "fits as well", "fits worse"],
)
def test_what_a_cause_is_excused_from_refutes_nothing_that_fits_better(
    score: float, reasons: tuple[str, ...], is_rival: bool
) -> None:
    excused = Checked({}, 1.0, (), excused_from=(CIRCLES,), missed=15.0)
    found = rivals(excused, Checked({}, 1.0, reasons, missed=25.0), node_of(score, TILT))
    assert found == ((TILT.name,) if is_rival else ())


def test_a_cause_that_predicts_has_no_rival_that_does_not() -> None:
    assert rivals(Checked({}, 1.0, ()), Checked({}, 1.0, (CIRCLES,)), node_of(50.0, TILT)) == ()


@pytest.mark.parametrize(
    ("score", "reasons", "is_named"),
    [
        (50.0, (CIRCLES,), True),
        (50.0, (CIRCLES, FEED), False),
        (0.0, (CIRCLES,), False),
    ],
    ids=["fits better", "misses a feed", "fits as well"],
)
def test_circles_that_geometry_does_not_predict_refute_no_other_element(
    score: float, reasons: tuple[str, ...], is_named: bool
) -> None:
    other = Known("ball_eccentricity", ("1",))
    checked = Checked({}, 1.0, reasons, missed=7.0, of_geometry=(CIRCLES,))
    found = rivalry(Checked({}, 1.0, ()), checked, node_of(score, other))
    assert found.alike == ((other.name,) if is_named else ())


@pytest.mark.parametrize(("reasons", "is_rival"), [((), True), ((FEED,), False)])
def test_more_causes_that_explain_as_much_are_a_rival_where_they_predict(
    reasons: tuple[str, ...], is_rival: bool
) -> None:
    found = rivals(Checked({}, 1.0, ()), Checked({}, 1.0, reasons), node_of(0.0, DRIFT, GAIN))
    assert found == (("bar_drift + bar_gain",) if is_rival else ())


@pytest.mark.parametrize(
    ("beside", "left", "is_rival"),
    [((DRIFT,), 0.99, False), ((DRIFT,), 0.5, True), ((), 0.99, True)],
    ids=["explains no more", "explains more", "beside one alone"],
)
def test_more_causes_with_functions_are_a_rival_of_several_effects_where_they_explain_more(
    beside: tuple[Known, ...], left: float, is_rival: bool
) -> None:
    """Legs that warm, beside play: a screw that does and a guideway's function explained half a hundredth more."""
    more = node_of(150.0, *beside, GAIN, TURN, left=left)
    assert bool(rivals(Checked({}, 1.0, ()), Checked({}, 1.0, ()), more, beside=beside, left=1.0)) is is_rival


def errs_by(error: float, share: float = 1.0) -> Checked:
    held = HeldOut(before=50.0, after=error, share=0.9, expected=error, as_fitted=error)
    return Checked({"circle": held}, share, ())


@pytest.mark.parametrize(
    ("score", "error", "is_rival"),
    [(50.0, 3.9, True), (50.0, 4.1, False), (3.0, 3.9, False)],
    ids=["errs less", "errs more", "fits no better"],
)
def test_what_fits_better_and_errs_less_is_a_rival_though_not_for_sure_itself(
    score: float, error: float, is_rival: bool
) -> None:
    """A ball that sits otherwise beside legs that warm, for a screw: a guideway that bows fits better everywhere."""
    found = rivals(errs_by(4.0), errs_by(error, share=0.5), node_of(score, SCREW))
    assert found == ((SCREW.name,) if is_rival else ())


@pytest.mark.parametrize("gives_way", [True, False])
def test_what_gives_way_to_fewer_effects_by_their_formulas_is_no_rival_of_them(
    gives_way: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("hexdbb.evidence.verdict.rivals.stand_before", lambda search, fewer, more: gives_way)
    found = rivals(Checked({}, 1.0, ()), Checked({}, 1.0, ()), node_of(50.0, DRIFT, GAIN))
    assert found == (() if gives_way else ("bar_drift + bar_gain",))


def test_several_functions_at_the_place_of_a_cause_describe_its_form() -> None:
    assert rivals(Checked({}, 1.0, ()), Checked({}, 1.0, ()), node_of(50.0, TILT, TURN)) == ()


@pytest.mark.parametrize(("variable", "is_rival"), [("screw_phase", False), ("position", True)])
def test_two_sliders_together_and_one_alone_are_the_other_in_other_words(variable: str, is_rival: bool) -> None:
    """What a pitch error of slider 6 does, a function of sliders 5 and 6 and one of slider 5 do between them."""
    both, one = (Learned.parse(f"learned:slider:{element}:{variable}") for element in ("5-6", "5"))
    cause = Known("pitch_cyclic", ("6",))
    found = rivals(Checked({}, 1.0, ()), Checked({}, 1.0, ()), node_of(50.0, both, one), cause, SCREW)
    assert bool(found) is is_rival


@pytest.mark.parametrize(
    ("state", "is_rival"), [("velocity", False), ("velocity_turning@6.7", False), ("acceleration", True)]
)
def test_six_sliders_that_lag_are_no_rival_of_one_that_does(state: str, is_rival: bool) -> None:
    six = Learned.parse(f"learned:slider:each:{state}")
    found = rivals(Checked({}, 1.0, ()), Checked({}, 1.0, ()), node_of(50.0, six), OTHER_LAG, OTHER_HOME)
    assert bool(found) is is_rival


@pytest.mark.parametrize(
    ("of_node", "of_rival", "is_rival"),
    [(1.3, 1.1, True), (1.1, 1.3, False), (4.0, 3.0, False)],
    ids=["explains more by formulas", "explains less", "rests on its forms too"],
)
def test_as_many_effects_that_explain_more_by_their_formulas_are_a_rival(
    of_node: float, of_rival: float, is_rival: bool
) -> None:
    """Functions of forms hold what geometry leaves of a drift: evidence alone does not tell which it is."""
    rival, checked = node_of(-500.0, DRIFT, GAIN), Checked({}, 1.0, ())
    other = Known("screw_thermal", ("3",))
    found = rivals(checked, checked, rival, beside=(other,), by_formulas=(of_node, of_rival))
    assert found == (("bar_drift + bar_gain",) if is_rival else ())


@pytest.mark.parametrize(("of_rival", "is_rival"), [(0.96, True), (1.04, False)])
def test_sets_that_both_leave_less_than_the_noise_explain_as_much(of_rival: float, is_rival: bool) -> None:
    """Where the stated noise is too large, a freer form leaves less without explaining more."""
    rival, checked = node_of(-500.0, DRIFT, GAIN, left=of_rival), Checked({}, 1.0, ())
    found = rivals(checked, checked, rival, beside=(Known("screw_thermal", ("3",)),), by_formulas=(1.3, 1.1), left=0.8)
    assert bool(found) is is_rival


@pytest.mark.parametrize(
    ("by_formula", "left", "missed", "is_named"),
    [(5.0, 1.02, 1.2, True), (1.5, 1.02, 1.2, False), (5.0, 1.05, 1.2, False), (5.0, 1.02, 1.6, False)],
    ids=["by forms", "by formulas", "it leaves something", "it errs where left out"],
)
def test_one_that_leaves_only_noise_is_named_beside_several_that_explain_by_forms(
    by_formula: float, left: float, missed: float, is_named: bool
) -> None:
    """A ball with lobes in a leg's joint read as two other effects whose forms made up for their formulas."""
    other = node_of(-200.0, SCREW, left=left)
    checked = Checked({}, 1.0, (), missed=missed)
    found = rivals(Checked({}, 1.0, ()), checked, other, beside=(Known("backlash", ("3",)),), by_formula=by_formula)
    assert found == ((SCREW.name,) if is_named else ())


def test_a_function_that_two_sliders_share_is_no_rival_of_an_effect_of_both() -> None:
    """Of two drives that lag, with friction besides, it says the same and is free to follow the friction."""
    home, lag = Learned.parse("learned:slider:6:velocity"), Known("servo_lag", ("6",))
    shared, other = Learned.parse("learned:slider:5-6:velocity"), Learned.parse("learned:leg:5-6:velocity")
    checked = Checked({}, 1.0, (), missed=0.6)
    for function, expected in ((shared, ()), (other, (other.name,))):
        rival = node_of(50.0, function, left=1.1)
        assert rivals(checked, checked, rival, lag, home, beside=(OTHER_LAG,), by_formula=5.0) == expected


@pytest.mark.parametrize(("of_node", "is_rival"), [(1.5, False), (3.0, True)])
def test_what_explains_less_than_a_formula_is_no_better_lead(of_node: float, is_rival: bool) -> None:
    """A cause that errs by more than all that it explains is a lead: what explains less by far is none beside it."""
    checked, rival = Checked({}, 1.0, (), missed=2.0), node_of(-500.0, TILT, left=2.0)
    assert bool(rivals(ERRS, checked, rival, by_formulas=(of_node, 2.0))) is is_rival


@pytest.mark.parametrize(("effect", "is_rival"), [("ball_eccentricity", False), ("joint_offset", True)])
def test_the_same_effect_at_another_element_beside_others_is_no_rival_that_errs_less(
    effect: str, is_rival: bool
) -> None:
    """Of two set-ups the ball may sit otherwise in either: the one says what the other does."""
    checked, rival = Checked({}, 1.0, (), missed=2.0), node_of(-500.0, Known(effect, ("1",)), DRIFT)
    assert bool(rivals(ERRS, checked, rival)) is is_rival
