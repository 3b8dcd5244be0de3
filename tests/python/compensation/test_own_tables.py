"""Users' effects as tables: corrected where their push is a function of one variable, else left out with the reason."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.python.compensation.driven import MACHINE, errors_mm, nominal_table, targets_of

from hexdbb import _core
from hexdbb.compensation import make_compensation
from hexdbb.effects import UserEffect, effect
from hexdbb.model import Model, Shape, new_model, new_term


def model_of(own: UserEffect, values: list[float]) -> Model:
    """A model with one user's effect at these values."""
    known = new_model(MACHINE, []).knowing_effects([own])
    return replace(known, terms=(replace(new_term(own.name, len(values)), values=np.array(values)),))


def declared(function: Callable[..., Any], port: str = "slider", elements: int = 6, **more: Any) -> UserEffect:
    return effect(port=port, unit="mm", prior_sigma=0.01, elements=elements, name="mine", **more)(function)


def tables_of(own: UserEffect, values: list[float]) -> list[_core.CompensationTable]:
    data = make_compensation(model_of(own, values))
    assert not data.left_out, data.left_out
    return data.tables


def bump(state: Any) -> Any:
    return np.exp(-(((state.sliders_mm - 250.0) / 20.0) ** 2))


def test_a_function_of_the_sliders_position_is_corrected() -> None:
    model = model_of(declared(bump), [0.01, -0.02, 0.0, 0.005, 0.0, 0.01])
    remaining, _ = errors_mm(model, targets_of(model))
    uncorrected, _ = errors_mm(model, nominal_table()["sliders_mm"])
    assert uncorrected.max() > 3e-3
    assert remaining.max() < 1e-4
    assert [table.pushes for table in make_compensation(model).tables] == [[(k, k, 1.0)] for k in (0, 1, 3, 5)]


def test_few_knots_are_kept() -> None:
    (table, *_) = tables_of(declared(bump), [0.01] * 6)
    assert 20 < len(table.knots) < 400
    at = np.linspace(*MACHINE.sliders.travel_mm, 5001)
    expected = 0.01 * np.exp(-(((at - 250.0) / 20.0) ** 2))
    np.testing.assert_allclose(np.interp(at, table.knots, table.values_mm), expected, atol=1.1e-5)


def test_a_guideway_shares_its_value() -> None:
    def dent(samples: Any) -> Any:
        dip = np.exp(-0.5 * ((samples["sliders_mm"] - 250.0) / 10.0) ** 2)
        return dip[..., np.newaxis] * np.array([0.0, 0.0, -1.0])

    tables = tables_of(declared(dent, port="slider_joint", elements=3), [0.03, 0.0, -0.01])
    assert [table.pushes for table in tables] == [[(k, 3 * k + 2, 1.0)] for k in (0, 1, 4, 5)]
    assert min(tables[0].values_mm) == pytest.approx(-0.03, abs=1e-5)
    assert max(tables[3].values_mm) == pytest.approx(0.01, abs=1e-5)


def test_a_shape_stands_at_its_value() -> None:
    def dent(state: Any, centre: float) -> Any:
        return np.exp(-(((state.sliders_mm - centre) / 20.0) ** 2))

    own = declared(dent, elements=1, shapes={"centre": Shape(400.0, prior_sigma=50.0)})
    (table, *_) = tables_of(own, [0.01, 300.0])
    assert abs(table.knots[int(np.argmax(table.values_mm))] - 300.0) < 1.0
    assert max(table.values_mm) == pytest.approx(0.01, rel=1e-3)


def test_a_direction_of_travel_may_multiply() -> None:
    own = declared(lambda state: np.sign(state.travel_direction) * state.sliders_mm / 800.0 + 1.0)
    tables = tables_of(own, [0.01, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert [(table.variable, table.times) for table in tables] == [
        ("sliders_mm", ""),
        ("sliders_mm", "travel_direction"),
    ]
    np.testing.assert_allclose(tables[0].values_mm, 0.01)
    np.testing.assert_allclose(tables[1].values_mm, 0.01 * np.array(tables[1].knots) / 800.0, atol=1e-12)


def test_a_place_in_three_directions_belongs_to_its_leg() -> None:
    own = declared(lambda s: s.slider_joint_angle_rad[:, :, None] * np.array([0.0, 0.0, 1.0]), port="slider_joint")
    tables = tables_of(own, [0.01] * 6)
    assert [table.pushes for table in tables] == [[(k, 3 * k + 2, 1.0)] for k in range(6)]
    assert tables[0].variable == "slider_joint_angle_rad"


def test_travel_since_a_reversal_is_spread_by_its_logarithm() -> None:
    """Lost motion over within 20 µm, of a travel of 0.8 m."""
    own = declared(lambda state: np.exp(-state.since_reversal_mm / 0.02) * state.travel_direction)
    tables = tables_of(own, [0.01] * 6)
    assert {(table.variable, table.times) for table in tables} == {("since_reversal_mm", "travel_direction")}
    at = np.geomspace(1e-3, 500.0, 2001)
    np.testing.assert_allclose(
        np.interp(at, tables[0].knots, tables[0].values_mm), 0.01 * np.exp(-at / 0.02), atol=1.1e-5
    )


def test_an_acceleration_is_known() -> None:
    tables = tables_of(declared(lambda state: state.acceleration_mm_s2 / 1000.0), [0.01] * 6)
    assert {(table.variable, table.times) for table in tables} == {("acceleration_mm_s2", "")}
    assert len(tables[0].knots) == 2


@pytest.mark.parametrize(
    ("function", "port", "reason"),
    [
        (lambda s: (np.abs(s.sliders_mm - 300.0) < 5.0) * 1.0, "slider", "jumps at sliders_mm = 2"),
        (lambda s: np.sign(s.velocity_mm_s), "slider", "jumps at velocity_mm_s = "),
        (lambda s: 10.0 * np.sin(s.sliders_mm), "slider", "changes by more than 0.05 mm per mm"),
        (lambda s: s.jerk_mm_s3, "leg", "depends on jerk_mm_s3, which is not known"),
        (lambda s: (s.since_reversal_mm < 0.01) * 1.0, "slider", "jumps at since_reversal_mm = 0.0099"),
        (lambda s: np.gradient(s.sliders_mm, axis=0), "leg", "depends on other samples of a record"),
        (lambda s: s.sliders_mm[:, ::-1] / 800.0, "leg", "depends on sliders_mm of several sliders"),
        (lambda s: np.sin(s.sliders_mm * s.leg_force), "leg", "depends on sliders_mm and leg_force together"),
        (lambda s: s.sliders_mm * s.leg_force * s.velocity_mm_s, "leg", "depends on sliders_mm, leg_force, velocity"),
        (lambda s: np.log(-s.sliders_mm - 900.0), "leg", "fails in states that were not measured"),
        (lambda s: 0.0 * s.sliders_mm, "leg", "pushes nothing at its values"),
    ],
)
def test_what_is_no_table_is_left_out(function: Callable[..., Any], port: str, reason: str) -> None:
    data = make_compensation(model_of(declared(function, port), [0.01] * 6))
    ((name, why),) = data.left_out
    assert name == "mine"
    assert why.startswith(reason), why
    assert not data.tables


def test_what_pushes_the_measurement_is_left_out() -> None:
    own = declared(lambda s: np.sin(s.leg_force[:, 0]), "reading", elements=1)
    assert make_compensation(model_of(own, [0.01])).left_out == [("mine", "pushes the reading, not the machine")]
