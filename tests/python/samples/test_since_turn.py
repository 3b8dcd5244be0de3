"""How a load changes since it turned: what a bolted joint remembers."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.learned import Learned, Space
from hexdbb.samples import Samples
from hexdbb_truth.cases import case

LOADS = ("leg_force", "drive_load", "carriage_load")


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of([case("none-s1").record()])


@pytest.mark.parametrize("load", LOADS)
def test_a_load_has_the_direction_in_which_it_changes(load: str, samples: Samples) -> None:
    values, direction = samples[load], samples[f"{load}_direction"]
    inside = np.diff(samples["sweep"]) == 0
    changed = np.diff(values, axis=0)
    large = inside[:, None] & (np.abs(changed) > 2e-4)
    assert np.count_nonzero(large) > 1000
    np.testing.assert_array_equal(direction[1:][large], np.sign(changed[large]))


@pytest.mark.parametrize("load", LOADS)
def test_the_change_since_a_load_turned_is_small_after_each_turn(load: str, samples: Samples) -> None:
    since, direction = samples[f"{load}_since_turn"], samples[f"{load}_direction"]
    known = since < 1e5
    assert 0.3 < np.mean(known) < 1.0  # not yet turned at the beginning of each sweep
    turned = known[1:] & (np.diff(direction, axis=0) != 0.0) & (direction[:-1] != 0.0)
    assert np.all(since[1:][turned] < 0.1 * np.ptp(samples[load]))


def test_hysteresis_of_a_force_is_a_function_that_can_be_named(samples: Samples) -> None:
    learned = Learned.parse("learned:leg:3:leg_force_since_turn")
    assert learned.variable.needs == {"leg_force_since_turn", "leg_force_direction"}
    space = Space.of(learned, samples, samples.machine.sliders.screw_lead_mm)
    functions = space.design(samples, 2)
    # The functions add up to the sense in which the force changes.
    np.testing.assert_allclose(functions.sum(axis=1), samples["leg_force_direction"][:, 2], atol=1e-9)


@pytest.mark.parametrize("place", ["ball", "cup", "reading"])
def test_what_is_loose_along_one_axis_has_a_step_where_the_velocity_turns(place: str, samples: Samples) -> None:
    learned = Learned.parse(f"learned:{place}:velocity_along@30")
    assert learned.variable.signed
    along = np.array([np.cos(np.radians(30.0)), np.sin(np.radians(30.0))])
    np.testing.assert_allclose(samples[learned.variable.column], samples["platform_velocity_mm_s"][:, :2] @ along)
