"""Slopes, groups and outliers: what is there is found, and chance is named no more often than stated."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.fleet.growth import DAYS_PER_YEAR, grown, significant
from hexdbb.fleet.observed import Observed, Series, ValueName
from hexdbb.fleet.shared import SharedCause, shared_causes, shared_values

PLAY = ValueName("backlash", "4", "play", "um")


def series(values: np.ndarray, sigma: float, machine: str = "m0", name: ValueName = PLAY) -> Series:
    days = 20000.0 + np.linspace(0.0, DAYS_PER_YEAR, len(values))
    sources = tuple(f"{machine}/{number}" for number in range(len(values)))
    return Series(machine, name, days, values, np.full(len(values), sigma), sources)


def observed(found: list[Series], batches: dict[str, str], causes: tuple[tuple[str, str], ...] = ()) -> Observed:
    return Observed((), tuple(found), causes, frozenset(batches), (), (), {"batch": batches, "type": {}})


@pytest.mark.parametrize("stated", [0.5, np.nan, 0.1], ids=["known", "not known", "stated too small"])
def test_intervals_of_slopes_cover_the_truth(stated: float) -> None:
    """95 % of 400 lines: 380 of them, with a standard deviation of 4.4."""
    draw = np.random.default_rng(3)
    years = np.linspace(0.0, 1.0, 12)
    lines = grown([series(2.0 + 3.0 * years + draw.normal(0.0, 0.5, 12), stated) for _ in range(400)])
    assert 360 <= sum(line.low <= 3.0 <= line.high for line in lines) <= 395
    assert abs(np.mean([line.change for line in lines]) - 3.0) < 0.1


def test_chance_is_hardly_ever_called_growth_and_growth_is() -> None:
    draw = np.random.default_rng(4)
    steady = [series(draw.normal(5.0, 0.5, 12), 0.5, f"m{number}") for number in range(1000)]
    assert significant(grown(steady)) == []
    growing = series(5.0 + 4.0 * np.linspace(0.0, 1.0, 12) + draw.normal(0.0, 0.5, 12), 0.5, "grows")
    assert [line.series.machine for line in significant(grown([*steady, growing]))] == ["grows"]


def test_a_point_far_off_is_told_and_does_not_bend_the_line() -> None:
    draw = np.random.default_rng(5)
    values = 5.0 + draw.normal(0.0, 0.3, 12)
    values[7] += 9.0
    (line,) = grown([series(values, 0.3)])
    assert list(np.flatnonzero(line.outliers)) == [7]
    assert line.low < 0.0 < line.high
    assert not any(each.outliers.any() for each in grown([series(draw.normal(5.0, 0.3, 12), 0.3) for _ in range(500)]))


def test_two_points_far_off_do_not_hide_one_another() -> None:
    draw = np.random.default_rng(8)
    values = 5.0 + draw.normal(0.0, 0.2, 12)
    values[[3, 4]] += 8.0
    (line,) = grown([series(values, np.nan)])
    assert list(np.flatnonzero(line.outliers)) == [3, 4]


def test_too_few_points_and_one_day_have_no_line() -> None:
    (few,) = grown([series(np.array([1.0, 2.0, 3.0]), 0.1)])
    same = series(np.arange(5.0), 0.1)
    (one_day,) = grown([Series("m0", PLAY, np.full(5, 20000.0), same.value, same.sigma, same.sources)])
    for line in (few, one_day):
        assert np.isnan(line.slope)
        assert line.p == 1.0
    assert significant([few, one_day]) == []


def test_what_a_batch_has_in_common_is_found_and_nothing_else() -> None:
    draw = np.random.default_rng(6)
    batches = {f"m{number}": "ABC"[number % 3] for number in range(12)}
    found = []
    for machine, batch in batches.items():
        for slider in range(1, 7):
            name = ValueName("backlash", str(slider), "play", "um")
            true = 2.0 + draw.normal(0.0, 0.5) + 6.0 * (batch == "B" and slider == 4)
            found.append(series(draw.normal(true, 0.3, 5), 0.3, machine, name))
    shared = {each.value_name.words: each for each in shared_values(observed(found, batches))}
    assert set(shared) == {"backlash:4 play", "backlash play"}
    one = shared["backlash:4 play"]
    assert (one.group, one.machines, one.others) == ("B", 4, 8)
    assert one.low < 6.0 < one.high
    assert shared["backlash play"].low < 1.0 < shared["backlash play"].high
    clean = {machine: "AB"[number % 2] for number, machine in enumerate(batches)}
    assert shared_values(observed([each for each in found if each.value_name != PLAY], clean)) == []


def test_causes_of_a_batch_are_counted_exactly() -> None:
    batches = {f"m{number}": "B" if number < 6 else "A" for number in range(20)}
    causes = (*((f"m{number}", "backlash") for number in range(6)), ("m9", "servo_lag"))
    (found,) = shared_causes(observed([], batches, causes))
    p = 1.0 / 38760.0  # of 20 machines six, all of the batch
    assert found == SharedCause("batch", "B", "backlash", 6, 6, 0, 14, pytest.approx(p))
