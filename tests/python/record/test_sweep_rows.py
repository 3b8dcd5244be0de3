"""Rows of sweeps: in the order in which sweeps begin, whatever their numbers, also where rows alternate."""

import numpy as np
import pytest

from hexdbb.record import rows_of_sweeps


@pytest.mark.parametrize("seed", range(3))
def test_each_row_belongs_to_the_sweep_that_it_states(seed: int) -> None:
    sweep = np.random.default_rng(seed).integers(0, 6, 200) * 7 - 3
    found = rows_of_sweeps(sweep)
    assert [int(sweep[rows[0]]) for rows in found] == list(dict.fromkeys(sweep.tolist()))
    for rows in found:
        np.testing.assert_array_equal(rows, np.flatnonzero(sweep == sweep[rows[0]]))


def test_no_rows_have_no_sweeps() -> None:
    assert rows_of_sweeps(np.zeros(0, np.int32)) == []
