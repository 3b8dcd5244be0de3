"""The search for circles: information adds up as readings do, criteria follow their formulas, exchange finds best."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.identifiability import plan_sensitivity
from hexdbb.model import new_model
from hexdbb.plan import Plan, load_plan
from hexdbb.planning import Grid, RequiredClearances, planned_unknowns
from hexdbb.planning.candidates import CandidateCircle, grid_candidates, neighbours, other_radii
from hexdbb.planning.criteria import make_criterion
from hexdbb.planning.exchange import CircleExchange, is_better
from hexdbb.planning.information import Information, information_of

Floats = NDArray[np.float64]
RATE_HZ, NOISE_MM = 250.0, 0.5e-3
LIKE = load_plan("standard")
MACHINE = LIKE.machine_file()
MODEL = new_model(MACHINE)
UNKNOWNS = planned_unknowns(MODEL, None, NOISE_MM, RATE_HZ)
SMALL = Grid(heights=(-0.2, 0.0), places=(0.0,), tilts=(0.0, 12.0), yaws=(0.0, 15.0), plane_tilts=(0.0, 16.0))


def pools() -> list[list[CandidateCircle]]:
    return [pool for pool in grid_candidates(LIKE, MACHINE, RequiredClearances(), SMALL) if pool]


def plan_of(candidates: list[CandidateCircle]) -> Plan:
    cups = list(dict.fromkeys(each.cup_mm for each in candidates))
    mounts = tuple(LIKE.mounts[0].model_copy(update={"id": k, "cup_mm": cup}) for k, cup in enumerate(cups))
    circles = tuple(each.circle(LIKE, k, cups.index(each.cup_mm)) for k, each in enumerate(candidates))
    return LIKE.model_copy(update={"mounts": mounts, "circles": circles})


def random_information(circles: int, shared: int, seed: int) -> Information:
    rng = np.random.default_rng(seed)
    rows = rng.normal(size=(circles, 4, shared + 2))
    one, own = rows[:, :, :shared], rows[:, :, shared:]
    turned = np.swapaxes(one, 1, 2)
    return Information(turned @ one, turned @ own, np.swapaxes(own, 1, 2) @ own)


def test_information_of_circles_about_two_cups_is_that_of_the_whole_plan() -> None:
    """The Schur complement of mounts is the projection of the whole plan's Jacobian."""
    first, second = pools()[:2]
    chosen = [first[3], first[20], second[5], second[11]]
    total = sum(information_of(part, LIKE, UNKNOWNS).total(range(2)).marginal()[0] for part in (chosen[:2], chosen[2:]))
    taken = plan_sensitivity(plan_of(chosen), MODEL, RATE_HZ)
    cups = taken.whose(lambda each: each.effect == "cup_position")
    # The prior of the cups, as rows of readings of their own.
    own = np.vstack([taken.scaled(taken.free & cups) / NOISE_MM, np.eye(6)])
    rest = np.vstack([taken.scaled(taken.free & ~cups) / NOISE_MM, np.zeros((6, 36))])
    left = _core.project_out(rest, own)
    expected = left.T @ left
    np.testing.assert_allclose(total, expected, atol=1e-7 * np.abs(expected).max())


def test_candidates_keep_the_required_clearances_and_are_all_different() -> None:
    for pool in pools():
        assert len(set(pool)) == len(pool)
        assert len({each.cup_mm for each in pool}) == 1
    flat = [
        each for pool in grid_candidates(LIKE, MACHINE, RequiredClearances(bar_angle_deg=1.0), SMALL) for each in pool
    ]
    assert flat
    assert all(each.plane_rpy_deg[:2] == each.platform_rpy_deg[:2] == (0.0, 0.0) for each in flat)


def test_neighbours_change_one_thing() -> None:
    own = CandidateCircle((0.0, 0.0, 340.0), (0.0, 12.0, 0.0), (6.0, 0.0, -20.0), 100.0)
    near = list(neighbours(own, 3.0))
    assert len(set(near)) == 10
    for each in near:
        moved = np.subtract((*each.plane_rpy_deg, *each.platform_rpy_deg), (*own.plane_rpy_deg, *own.platform_rpy_deg))
        assert sorted(np.abs(moved)) == [0.0] * 5 + [3.0]
    assert [each.radius_mm for each in other_radii(own, LIKE)] == [99.6, 100.4]


def test_volume_reduction_is_the_gain_of_information_on_the_values_of_interest() -> None:
    information = random_information(1, 5, 1).marginal()
    of_interest = np.array([True, True, False, True, False])
    covariance = np.linalg.inv(information[0] + np.eye(5))[np.ix_(of_interest, of_interest)]
    score = make_criterion("D", of_interest, information[0])(information)
    assert score[0] == pytest.approx(-np.linalg.slogdet(covariance)[1])


def test_minmax_is_the_smallest_singular_value_of_what_is_determined() -> None:
    """Two values that no circle separates count as one direction."""
    rng = np.random.default_rng(2)
    rows = 1e3 * rng.normal(size=(40, 4))
    rows = np.column_stack([rows, rows[:, 0]])
    of_interest = np.array([True, True, True, False, True])
    information = rows.T @ rows
    nuisance = rows[:, [3]]
    left = rows[:, of_interest] - nuisance @ np.linalg.lstsq(nuisance, rows[:, of_interest], rcond=None)[0]
    values = np.linalg.svd(left, compute_uv=False)
    assert values[3] < 1e-9 * values[0]
    assert make_criterion("minmax", of_interest, information)(information[None])[0] == pytest.approx(
        values[2], rel=1e-5
    )


def test_an_unknown_criterion_is_named() -> None:
    with pytest.raises(InputError, match=r"^criterion E: not known \(expected one of D, minmax\)$"):
        make_criterion("E", np.ones(1, bool), np.eye(1))


@pytest.mark.parametrize("name", ["D", "minmax"])
@pytest.mark.parametrize("seed", [3, 4, 5])
def test_exchange_comes_to_the_best_of_all_choices_or_near_it(name: str, seed: int) -> None:
    information = [random_information(12, 4, seed)]
    whole = information[0].total(range(12)).marginal()[0]
    score_by, start = (make_criterion(each, np.ones(4, bool), whole) for each in (name, "D"))
    exchange = CircleExchange(information, score_by)
    best = exchange.rounds(3, 1, start, lambda _: None)[0][0]
    every = sorted(exchange.score([(0, place) for place in places]) for places in combinations(range(12), 3))
    assert best.score == pytest.approx(exchange.score(best.circles))
    assert len(set(best.circles)) == 3
    assert best.score >= every[-5]  # of 220
    for place in range(3):  # no single exchange betters it
        rest = [each for number, each in enumerate(best.circles) if number != place]
        options = [exchange.score([*rest, (0, other)]) for other in range(12) if (0, other) not in rest]
        assert not is_better(max(options), best.score)


def test_another_cup_position_is_taken_only_where_it_is_allowed_and_better() -> None:
    information = [random_information(5, 4, seed) for seed in range(3)]
    whole = np.sum([each.total(range(5)).marginal()[0] for each in information], axis=0)
    score_by = make_criterion("D", np.ones(4, bool), whole)
    exchange = CircleExchange(information, score_by)
    one, two = (exchange.rounds(4, mounts, score_by, lambda _: None)[-1][0] for mounts in (1, 2))
    assert len({mount for mount, _ in one.circles}) == 1
    assert len({mount for mount, _ in two.circles}) <= 2
    assert two.score >= one.score


def test_too_many_circles_are_refused() -> None:
    score_by = make_criterion("D", np.ones(4, bool), np.eye(4))
    with pytest.raises(InputError, match=r"^circles 6: fewer candidates about 1 cup position\(s\)"):
        CircleExchange([random_information(5, 4, 0)], score_by).rounds(6, 1, score_by, lambda _: None)


@pytest.mark.parametrize(
    ("aim", "message"),
    [("bar_lenth", 'no effect has the name "bar_lenth"'), ("cup_position", "cup_position: belongs to each mount")],
)
def test_an_aim_that_no_plan_can_have_is_named(aim: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        planned_unknowns(MODEL, aim, NOISE_MM, RATE_HZ)
