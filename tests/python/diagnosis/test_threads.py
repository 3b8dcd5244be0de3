"""The engine's threads limited: the same sums, up to the order of their terms."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.model import new_model
from hexdbb.rig.truth import random_truth
from hexdbb.samples import Samples, normal_equations
from hexdbb_truth.plans import discovery_plan
from hexdbb_truth.simulate import Pace, simulate


@pytest.fixture(autouse=True)
def restored() -> Iterator[None]:
    yield
    _core.limit_threads(0)


def test_sums_of_one_thread_are_those_of_many() -> None:
    """5,000 readings: enough for two threads."""
    record = simulate(random_truth(3), discovery_plan(), pace=Pace(2.8, 1, 1.0))
    samples = Samples.of([record])
    assert len(samples) > 2 * 2048
    model = new_model(record.machine).with_mounts(samples.mounts)
    sums = {}
    for most in (1, 2, 3):
        _core.limit_threads(most)
        sums[most] = normal_equations(samples, model)
        again = normal_equations(samples, model)
        assert (again.information == sums[most].information).all()
    for most in (2, 3):
        np.testing.assert_allclose(sums[most].information, sums[1].information, rtol=1e-9, atol=1e-9)
        assert sums[most].squared == pytest.approx(sums[1].squared, rel=1e-12)
    assert (sums[2].information != sums[1].information).any()  # it was another number of threads


def test_a_negative_number_is_refused() -> None:
    with pytest.raises(ValueError, match=r"threads: -1 \(expected 0 or more\)"):
        _core.limit_threads(-1)
