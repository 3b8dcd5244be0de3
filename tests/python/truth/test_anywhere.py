"""Faults that nobody chose: any place pushed by any state, by a function whose shape is drawn."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.rig.mechanisms import Push
from hexdbb.rig.truth import random_truth
from hexdbb_truth.forms import plans
from hexdbb_truth.forms.cases import case
from hexdbb_truth.forms.measure import Measured
from hexdbb_truth.forms.outside import ANYWHERE
from hexdbb_truth.forms.ports import Scene, add
from hexdbb_truth.forms.shapes import SHAPES, shape_of, shape_of_turn

EVENLY = np.linspace(-1.0, 1.0, 2001)


@pytest.fixture(scope="module")
def some() -> Scene:
    measured = Measured(random_truth(1), plans.history("varied"))
    return measured.scene(measured.history.samples[::11])


@pytest.mark.parametrize("number", range(len(SHAPES)))
def test_a_shape_is_of_the_order_of_one_and_drawn_anew_each_time(number: int) -> None:
    draws = [SHAPES[number](np.random.default_rng(seed))(EVENLY) for seed in range(8)]
    sizes = [float(np.std(each)) for each in draws]
    assert all(0.1 < each < 3.0 for each in sizes)
    assert len({round(each, 6) for each in sizes}) == len(sizes)


def test_shapes_of_a_turn_repeat_with_it() -> None:
    for seed in range(6):
        shape = shape_of_turn(np.random.default_rng(seed))
        np.testing.assert_allclose(shape(EVENLY), shape(EVENLY + 2.0 * np.pi), atol=1e-9)


def test_every_shape_is_drawn() -> None:
    draw = np.random.default_rng(0)
    assert len({shape_of(draw).__qualname__ for _ in range(60)}) == len(SHAPES)


@pytest.mark.parametrize("kind", list(ANYWHERE)[::4])
def test_a_state_pushes_one_element_of_its_place_and_is_drawn_the_same_again(kind: str, some: Scene) -> None:
    one = case(f"{kind}-d0-x3-judge-s1")
    fault, again = (ANYWHERE[kind].drawn(one._draw(kind)) for _ in range(2))
    values = fault.action.values(some, 10.0)
    np.testing.assert_array_equal(values, again.action.values(some, 10.0))
    assert np.all(np.isfinite(values))
    assert np.ptp(values) > 0.0
    push = Push(len(some.rows))
    add(fault.action, values, some, push)
    moved = [array for array in vars(push).values() if np.any(array)]
    assert len(moved) == 1
    if fault.action.elements:
        assert np.count_nonzero(np.any(moved[0].reshape(len(some.rows), 6, -1), axis=(0, 2))) == 1


def test_all_places_and_states_are_there() -> None:
    ports = {each.drawn(np.random.default_rng(0)).action.port for each in ANYWHERE.values()}
    assert ports == {"slider", "leg", "guideway", "platform_joint", "ball", "cup", "reading"}
    assert len({words for each in ANYWHERE.values() for words in each.variables}) >= 12
