"""A relay: +1 once a column has risen to one number, -1 once it has fallen to a lower one."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.plan import load_plan
from hexdbb.samples import Samples
from hexdbb.samples.two_states import relay_column, two_states

PLAN = load_plan("thesis")


def one_by_one(values: np.ndarray, low: float, high: float) -> np.ndarray:
    """Return the states, sample by sample; before the first change the other state."""
    states, state = np.zeros(len(values)), 0.0
    for row, value in enumerate(values):
        changed = 1.0 if value >= high else -1.0 if value <= low else state
        if state == 0.0 and changed:
            states[:row] = -changed
        states[row] = state = changed
    return states


@pytest.mark.parametrize(("low", "high"), [(-0.3, 0.5), (0.2, 0.25), (-2.0, 0.9), (-2.0, 2.0)])
def test_states_are_those_of_a_relay_followed_sample_by_sample(low: float, high: float) -> None:
    values = np.sin(np.linspace(0.3, 40.0, 2000)) * np.linspace(0.4, 1.0, 2000)
    assert np.array_equal(two_states(values[:, None], low, high)[:, 0], one_by_one(values, low, high))


def test_many_pairs_of_numbers_at_once() -> None:
    values = np.sin(np.linspace(0.0, 40.0, 2000))
    low, high = np.array([-0.5, 0.0, 0.3]), np.array([0.5, 0.1, 0.9])
    every = two_states(values[:, None], low, high)
    for column, pair in enumerate(zip(low, high, strict=True)):
        assert np.array_equal(every[:, column], one_by_one(values, *pair))


def test_the_state_goes_on_from_sweep_to_sweep() -> None:
    time_s = np.concatenate([np.linspace(0.0, 10.0, 100), np.linspace(12.0, 20.0, 100)])
    column = np.concatenate([np.linspace(0.0, 1.0, 100), np.linspace(0.9, 0.1, 100)])
    found = relay_column(0.2, 0.95, column, time_s, np.repeat([0, 1], 100), np.zeros(200))
    assert np.array_equal(found[100:], np.where(column[100:] > 0.2, 1.0, -1.0))
    assert np.array_equal(found[:100], np.where(column[:100] >= 0.95, 1.0, -1.0))


def test_each_record_begins_anew() -> None:
    time_s, column = np.tile(np.linspace(0.0, 10.0, 100), 2), np.tile(np.linspace(0.0, 1.0, 100), 2)
    found = relay_column(0.2, 0.95, column, time_s, np.repeat([0, 1], 100), np.zeros(200))
    assert np.array_equal(found[:100], found[100:])


def test_samples_have_the_column_by_its_name() -> None:
    samples = Samples.planned(PLAN.machine_file(), PLAN.runs(), np.arange(180) * (2.0 * np.pi / 180), 100.0)
    sliders = samples["sliders_mm"]
    low, high = np.quantile(sliders[:, 2], [0.3, 0.7])
    found = samples[f"sliders_mm.relay@{low:.6g}/{high:.6g}"]
    assert found.shape == sliders.shape
    assert set(np.unique(found[:, 2])) == {-1.0, 1.0}
    assert np.all(found[sliders[:, 2] > high + 1e-2, 2] == 1.0)
    assert np.all(found[sliders[:, 2] < low - 1e-2, 2] == -1.0)


def test_a_vectors_part_along_a_direction_has_states_too() -> None:
    samples = Samples.planned(PLAN.machine_file(), PLAN.runs(), np.arange(180) * (2.0 * np.pi / 180), 100.0)
    part = samples["position_mm"][:, :2] @ [np.cos(np.radians(35.0)), np.sin(np.radians(35.0))]
    low, high = np.quantile(part, [0.3, 0.7])
    found = samples[f"position_mm.along@35.relay@{low:.6g}/{high:.6g}"]
    assert np.all(found[part > high + 1e-2] == 1.0)
    assert np.all(found[part < low - 1e-2] == -1.0)
    between = (part > low + 1e-2) & (part < high - 1e-2)
    assert set(np.unique(found[between])) == {-1.0, 1.0}
