"""Time since a circle was begun, over all its sweeps."""

from __future__ import annotations

import numpy as np

from hexdbb.samples import Samples
from hexdbb.samples.swing import _in_circle_s
from hexdbb_truth.cases import case


def test_time_counts_from_the_first_sample_of_the_circle_over_all_its_sweeps() -> None:
    samples = Samples.of([case("none-s1").record()])
    time_s, since_s, circle = samples["time_s"], samples["time_in_circle_s"], samples["set_up"]
    for each in np.unique(circle):
        here = circle == each
        assert len(np.unique(samples["sweep"][here])) > 1
        np.testing.assert_allclose(since_s[here], time_s[here] - time_s[here].min())


def test_one_circle_or_one_sweep_of_each_says_nothing_that_other_times_do_not() -> None:
    time_s = np.arange(6.0)
    one = np.zeros(6, np.int32)
    sweeps = np.repeat(np.arange(3, dtype=np.int32), 2)
    assert np.isnan(_in_circle_s(time_s, one, sweeps)).all()
    assert np.isnan(_in_circle_s(time_s, sweeps, sweeps)).all()
    circles = np.array([0, 0, 0, 0, 1, 1], np.int32)
    assert _in_circle_s(time_s, circles, sweeps).tolist() == [0.0, 1.0, 2.0, 3.0, 0.0, 1.0]
