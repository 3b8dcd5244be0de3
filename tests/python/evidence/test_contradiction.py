"""How much the readings left out contradict the others: about one by chance, however large an error geometry makes."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.linear.sums import Sums

VALUES = 6
DRAWS = 40


def of_circles(readings: Readings, residual: np.ndarray, table: np.ndarray) -> tuple[float, float]:
    """Return the contradiction of every circle with the others, and by how much its noise a fit to these errs there."""
    sums = Sums(Linear(residual, table, np.zeros(table.shape[1])), readings, ("circle",))
    contradicted = determined = worst = 0.0
    left = float(np.mean((residual - table @ sums.whole.own_values()) ** 2))
    for cells in sums.groups("circle"):
        training = sums.without(cells)
        squared, values = training.contradiction(sums, cells)
        contradicted += squared - float(sums.rows[cells].sum()) * left
        determined += values
        worst = max(worst, training.expected_error(sums, cells) / float(sums.rows[cells].sum()))
    return contradicted / determined, worst


def table_of(readings: Readings, hardly: float) -> np.ndarray:
    """Return columns of which one is hardly seen but on the first circle."""
    draw = np.random.default_rng(8)
    table = 3.0 * draw.normal(size=(len(readings), VALUES))
    table[readings.groups["circle"] > 0, 0] *= hardly
    return table


@pytest.mark.parametrize("hardly", [1.0, 1e-3])
def test_chance_contradicts_by_one_for_each_value(readings: Readings, hardly: float) -> None:
    draw, table = np.random.default_rng(9), table_of(readings, hardly)
    truths = draw.normal(size=(DRAWS, VALUES))
    found = [of_circles(readings, table @ truth + draw.normal(size=len(readings)), table) for truth in truths]
    assert np.mean([each for each, _ in found]) == pytest.approx(1.0, abs=0.35)
    assert (found[0][1] > 5.0) is (hardly < 1.0)


def test_circles_that_ask_for_other_values_contradict(readings: Readings) -> None:
    draw, table = np.random.default_rng(10), table_of(readings, 1e-3)
    truth, other = draw.normal(size=(2, VALUES))
    asked = np.where(readings.groups["circle"][:, None] == 1, other, truth)
    contradicted, _ = of_circles(readings, np.sum(table * asked, axis=1) + draw.normal(size=len(readings)), table)
    assert contradicted > 50.0
