"""Columns that remember: the lag of first order, exactly, across sweeps and steps of any length; what has turned."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from hexdbb.plan import load_plan
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb.samples.deflection import LEAST_TURN_MM
from hexdbb.samples.memory import lingering, remembered_column
from hexdbb.samples.since_turn import direction_and_travel

ONE_SWEEP, NOT_TURNED = np.zeros(400, np.int32), np.zeros(400)


def test_a_step_is_followed_as_by_a_capacitor() -> None:
    time_s = np.sort(np.random.default_rng(3).uniform(0.0, 40.0, 400))
    column = np.where(np.arange(400) < 100, 1.0, 3.0)
    lagged = remembered_column("lagged", 5.0, column, time_s, ONE_SWEEP, NOT_TURNED)
    assert lagged[:100] == pytest.approx(1.0)
    # Between its two samples the step is a ramp; from its end on all is exponential.
    expected = 3.0 + (lagged[100] - 3.0) * np.exp(-(time_s[100:] - time_s[100]) / 5.0)
    assert lagged[100:] == pytest.approx(expected, abs=1e-9)


def test_a_ramp_is_followed_a_time_constant_behind() -> None:
    time_s = np.linspace(0.0, 400.0, 400)
    lagged = remembered_column("lagged", 2.0, 7.0 * time_s, time_s, ONE_SWEEP, NOT_TURNED)
    assert lagged[200:] == pytest.approx(7.0 * (time_s[200:] - 2.0), rel=1e-9)


@pytest.mark.parametrize("constant_s", [1e-3, 1.0, 1e5])
def test_any_constant_gives_what_small_steps_give(constant_s: float) -> None:
    time_s = np.linspace(0.0, 60.0, 400)
    columns = np.column_stack([np.sin(time_s), np.cos(0.3 * time_s)])
    found = remembered_column("lagged", constant_s, columns, time_s, ONE_SWEEP, NOT_TURNED)
    state, expected = columns[0].copy(), [columns[0].copy()]
    part = (time_s[1] - time_s[0]) / constant_s / 200
    for before, after in pairwise(columns):
        for k in range(200):
            state = state + (before + (after - before) * (k + 0.5) / 200 - state) * -np.expm1(-part)
        expected.append(state)
    assert found == pytest.approx(np.array(expected), abs=3e-4)


def test_what_relaxes_is_the_column_less_its_lag() -> None:
    time_s = np.linspace(0.0, 60.0, 400)
    column = np.sin(time_s)
    parts = [remembered_column(how, 4.0, column, time_s, ONE_SWEEP, NOT_TURNED) for how in ("lagged", "relaxing")]
    assert sum(parts) == pytest.approx(column)


def test_between_sweeps_it_goes_evenly_to_where_the_next_begins() -> None:
    time_s = np.concatenate([np.linspace(0.0, 10.0, 200), np.linspace(17.0, 30.0, 200)])
    sweep = np.repeat(np.array([0, 1], np.int32), 200)
    column = np.where(sweep == 0, 1.0, 2.0)
    lagged = remembered_column("lagged", 5.0, column, time_s, sweep, NOT_TURNED)
    assert lagged[199] == pytest.approx(1.0)
    ramp = 1.0 + (7.0 - 5.0 * (1.0 - np.exp(-7.0 / 5.0))) / 7.0
    assert lagged[200] == pytest.approx(ramp)


def test_a_circle_is_run_up_to_as_it_comes_round_again() -> None:
    """From an eighth of a lap before: what a time constant of a fiftieth of a lap remembers is there by then."""
    angle = np.linspace(0.0, 4.0 * np.pi, 4001)
    lagged = remembered_column("lagged", 2.0 * np.pi / 50.0, np.sin(angle), angle, np.zeros(4001, np.int32), angle)
    assert lagged[0] == pytest.approx(lagged[2000], abs=1e-3)
    assert abs(lagged[0]) > 0.1


def test_with_every_record_it_begins_anew() -> None:
    time_s = np.tile(np.linspace(0.0, 10.0, 200), 2)
    sweep = np.repeat(np.array([0, 1], np.int32), 200)
    column = np.where(sweep == 0, 1.0, 2.0) * np.cos(time_s)
    lagged = remembered_column("lagged", 5.0, column, time_s, sweep, NOT_TURNED)
    assert lagged[200:] == pytest.approx(2.0 * lagged[:200])


def test_samples_know_such_columns_by_name(record: Record) -> None:
    samples = Samples.of([record])
    lagged, relaxing = (samples[f"sliders_mm.{how}@2.5"] for how in ("lagged", "relaxing"))
    assert lagged.shape == (len(samples), 6)
    assert lagged + relaxing == pytest.approx(samples["sliders_mm"])
    assert np.abs(relaxing).max() > 1e-3
    with pytest.raises(KeyError, match=r"no column 'weather\.lagged@2'"):
        samples["weather.lagged@2"]


def test_a_time_after_a_run_up_is_longer_by_what_the_run_up_took() -> None:
    """Two circles, the second at twice the rate and the other direction, from an angle of its own."""
    first, second = np.linspace(0.0, 20.0, 200), np.linspace(30.0, 40.0, 200)
    sweep = np.repeat(np.array([0, 1], np.int32), 200)
    angle = np.concatenate([np.pi / 10.0 * first, 1.0 - np.pi / 5.0 * (second - 30.0)])
    since = np.concatenate([first, second - 30.0])
    found = remembered_column("after", 90.0, since, np.concatenate([first, second]), sweep, angle)
    assert found - since == pytest.approx(np.repeat([5.0, 2.5], 200))


def test_samples_know_times_after_a_run_up_by_name(record: Record) -> None:
    samples = Samples.of([record])
    since, after = samples["time_in_sweep_s"], samples["time_in_sweep_s.after@45"]
    assert (after > since).all()
    assert len(np.unique(np.round(after - since, 9))) <= len(np.unique(samples["sweep"]))


def test_the_direction_of_a_gauge_turns_once_where_it_comes_back() -> None:
    """Encoders' steps of a tenth of a micrometre, and the flat top of a sine, turn nothing over."""
    time_s = np.linspace(0.0, 2.0, 4001)
    steps_mm = 1e-4 * np.random.default_rng(5).uniform(-1.0, 1.0, len(time_s))
    moved_mm = 0.05 * np.sin(2.0 * np.pi * time_s)
    sweep, no_lap_rad = np.zeros(len(time_s), np.int32), np.zeros(len(time_s))
    direction, since_mm = direction_and_travel(moved_mm + steps_mm, time_s, sweep, no_lap_rad, LEAST_TURN_MM)
    assert np.count_nonzero(np.diff(direction[100:])) == 4
    assert np.mean(direction == np.sign(np.cos(2.0 * np.pi * time_s))) > 0.95
    later = time_s > 0.3
    assert since_mm[later & (time_s < 0.7)] == pytest.approx(0.05 - moved_mm[later & (time_s < 0.7)], abs=3e-4)
    assert (since_mm[time_s < 0.24] == 1e6).all()


def test_a_gauge_that_rests_has_no_direction() -> None:
    sweep, no_lap_rad = np.zeros(50, np.int32), np.zeros(50)
    direction, since_mm = direction_and_travel(np.full(50, 0.02), np.arange(50.0), sweep, no_lap_rad, LEAST_TURN_MM)
    assert not direction.any() and (since_mm == 1e6).all()


def test_the_travel_of_a_gauge_begins_anew_with_each_sweep() -> None:
    time_s, sweep = np.arange(8.0), np.repeat(np.array([3, 4], np.int32), 4)
    moved_mm = np.array([0.0, 0.1, 0.04, 0.0, 0.5, 0.4, 0.3, 0.35])
    direction, since_mm = direction_and_travel(moved_mm, time_s, sweep, np.zeros(8), LEAST_TURN_MM)
    assert direction.tolist() == [0.0, 1.0, -1.0, -1.0, 0.0, -1.0, -1.0, 1.0]
    assert since_mm == pytest.approx([1e6, 1e6, 0.06, 0.1, 1e6, 1e6, 1e6, 0.05])


def test_what_slips_yields_so_far_and_no_farther() -> None:
    rng = np.random.default_rng(7)
    columns = np.cumsum(rng.normal(size=(400, 3)), axis=0)
    found = remembered_column("slipping", 1.5, columns, np.arange(400.0), ONE_SWEEP, NOT_TURNED)
    state, expected = np.zeros(3), [np.zeros(3)]
    for before, after in pairwise(columns):
        state = np.clip(state + after - before, -1.5, 1.5)
        expected.append(state)
    assert found == pytest.approx(np.array(expected), abs=1e-9)


@pytest.mark.parametrize(("how", "knows"), [("slipping", False), ("slipping180", True)])
def test_half_a_circle_of_run_up_tells_how_a_contact_is_strained_where_a_sweep_begins(how: str, knows: bool) -> None:
    angle_rad = np.linspace(0.0, 4.0 * np.pi, 401)[:-1] + 0.3
    column = np.cos(angle_rad)
    found = remembered_column(how, 0.5, column, np.arange(400.0), ONE_SWEEP, angle_rad)
    # A lap later it has forgotten where it began: half a circle from 1 to -1 strains it by four times its most.
    assert (found[0] == pytest.approx(found[200], abs=1e-3)) == knows


def test_what_lingers_dies_away_while_the_machine_waits() -> None:
    """A nut is heated by the square of its velocity: it cools where the machine stands between two sweeps."""
    time_s = np.concatenate([np.linspace(0.0, 50.0, 200), np.linspace(80.0, 130.0, 200)])
    sweep = np.repeat(np.array([0, 1], np.int32), 200)
    heat = np.full(400, 4.0)
    found = lingering(heat, 20.0, np.zeros(1), time_s, sweep, NOT_TURNED)
    assert found[:200] == pytest.approx(4.0)
    assert found[200] == pytest.approx(4.0 * np.exp(-30.0 / 20.0), rel=1e-3)
    assert found[-1] == pytest.approx(4.0 - (4.0 - found[200]) * np.exp(-50.0 / 20.0), rel=1e-6)
    cold = lingering(heat, 20.0, np.zeros(1), time_s, sweep, NOT_TURNED, from_standing=True)
    assert cold[:200] == pytest.approx(4.0 * -np.expm1(-time_s[:200] / 20.0))
    assert cold[200] == pytest.approx(cold[199] * np.exp(-30.0 / 20.0), rel=1e-3)


def test_what_its_motion_heats_is_warm_by_its_speed_whichever_way_it_goes(record: Record) -> None:
    """Within a time constant far above the test's it is the way travelled, over that constant."""
    samples = Samples.of([record])
    velocity_mm_s, time_s, sweep = (samples[each] for each in ("velocity_mm_s", "time_s", "sweep"))
    found = samples["velocity_mm_s.heated@1e6"]
    assert found.shape == velocity_mm_s.shape and found[0] == pytest.approx(0.0, abs=1e-4)
    first = np.flatnonzero(sweep == sweep[0])
    speed = np.abs(velocity_mm_s[first])
    steps = np.diff(time_s[first])[:, None] * 0.5 * (speed[1:] + speed[:-1])
    travelled_mm = 1e6 * (found[first] - found[first[0]])[1:]
    assert travelled_mm == pytest.approx(np.cumsum(steps, axis=0), rel=1e-3)


def test_where_nothing_is_said_of_waiting_it_waits_where_the_next_sweep_begins() -> None:
    time_s = np.concatenate([np.linspace(0.0, 10.0, 200), np.linspace(17.0, 30.0, 200)])
    sweep = np.repeat(np.array([0, 1], np.int32), 200)
    columns = np.column_stack([np.where(sweep == 0, 1.0, 2.0), np.where(sweep == 0, 5.0, 3.0)])
    found = lingering(columns, 5.0, None, time_s, sweep, NOT_TURNED)
    left = np.exp(-7.0 / 5.0)
    assert found[199] == pytest.approx([1.0, 5.0])
    assert found[200] == pytest.approx([2.0 - left, 3.0 + 2.0 * left], rel=1e-3)


def test_a_part_of_a_table_has_what_lingers_in_the_whole() -> None:
    plan = load_plan("standard")
    planned = Samples.planned(plan.machine_file(), plan.runs()[:3], np.linspace(0.0, 6.0, 60), 100.0)

    def function(samples: Samples) -> np.ndarray:
        return np.cos(samples["angle_rad"])

    whole = planned.lingering(function, 4.0)
    rows = np.arange(5, len(planned), 7)
    assert planned.part(rows).lingering(function, 4.0) == pytest.approx(whole[rows], abs=0.0)
