"""Sums over cells against the same by brute force."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.linear.sums import Sums, squared_error

Port = Callable[[str], np.ndarray]


def _joint(linear: Linear, signature: np.ndarray, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Own values and coefficients (with no prior of their own) that fit some rows best, at once."""
    design = np.hstack([linear.own, signature])[rows]
    penalty = np.zeros(design.shape[1])
    penalty[: linear.own.shape[1]] = 1.0
    right = design.T @ linear.residual[rows]
    right[: linear.own.shape[1]] -= linear.standing
    found = np.linalg.solve(design.T @ design + np.diag(penalty), right)
    return found[: linear.own.shape[1]], found[linear.own.shape[1] :]


@pytest.mark.parametrize("grouping", ["circle", "feed", "direction", "lap"])
def test_a_group_left_out_is_predicted_as_by_a_fit_without_its_rows(
    linear: Linear, readings: Readings, port: Port, grouping: str
) -> None:
    signature = port("slider")[:, :2] * np.sin(readings.state["sliders_mm"][:, :2])
    sums = Sums(linear, readings)
    block = sums.block(signature)
    for number, cells in enumerate(sums.groups(grouping)):
        training = sums.without(cells)
        projected = training.project(block)
        coefficients = np.linalg.solve(projected.information, projected.gradient)
        own = training.own_values(projected, coefficients)
        inside = readings.groups[grouping] == number
        expected = _joint(linear, signature, ~inside)
        assert own == pytest.approx(expected[0], rel=1e-8)
        assert coefficients == pytest.approx(expected[1], rel=1e-8)
        error = (linear.residual - linear.own @ own - signature @ coefficients)[inside]
        assert squared_error(sums, cells, own, block, coefficients) == pytest.approx(float(error @ error), rel=1e-8)


def test_one_cell_holds_the_sums_of_all_cells(linear: Linear, readings: Readings, port: Port) -> None:
    signature = port("ball")
    one, many = (Sums(linear, readings, groupings) for groupings in ((), ("circle", "lap")))
    assert one.block(signature).cross[0] == pytest.approx(many.block(signature).cross.sum(axis=0))
    assert one.whole.own_values() == pytest.approx(many.whole.own_values())


def test_the_error_expected_is_that_of_noise(linear: Linear, readings: Readings) -> None:
    sums = Sums(linear, readings)
    cells = sums.groups("circle")[0]
    training = sums.without(cells)
    inside = readings.groups["circle"] == 0
    covariance = np.linalg.inv(linear.own[~inside].T @ linear.own[~inside] + np.eye(5))
    expected = inside.sum() + np.trace(linear.own[inside] @ covariance @ linear.own[inside].T)
    assert training.expected_error(sums, cells) == pytest.approx(float(expected))


def test_values_held_at_zero_are_fitted_without_their_columns(linear: Linear, readings: Readings) -> None:
    standing = np.array([0.3, -0.2, 0.5, 0.0, 0.1])
    sums = Sums(replace(linear, standing=standing), readings)
    cells, dropped = sums.groups("circle")[1], np.array([1, 4])
    found = sums.without(cells).own_values_without(sums, dropped)
    assert found[dropped] == pytest.approx(-standing[dropped])
    others, outside = np.array([0, 2, 3]), readings.groups["circle"] != 1
    own = linear.own[outside]
    residual = linear.residual[outside] + own[:, dropped] @ standing[dropped]
    design = own[:, others]
    expected = np.linalg.solve(design.T @ design + np.eye(3), design.T @ residual - standing[others])
    assert found[others] == pytest.approx(expected, rel=1e-8)
