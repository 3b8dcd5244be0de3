"""How far the carriages of a guideway are apart, and a function of it that both share."""

from __future__ import annotations

import numpy as np

from hexdbb.learned import Learned
from hexdbb.samples import Samples
from hexdbb_truth.cases import case


def test_each_slider_is_as_far_from_the_other_as_that_from_it() -> None:
    samples = Samples.of([case("none-s1").record()])
    gap_mm, sliders_mm = samples["gap_mm"], samples["sliders_mm"]
    assert np.array_equal(gap_mm[:, 0], sliders_mm[:, 0] - sliders_mm[:, 1])
    assert np.array_equal(gap_mm[:, [1, 3, 5]], -gap_mm[:, [0, 2, 4]])
    rate_mm_s, velocity_mm_s = samples["gap_rate_mm_s"], samples["velocity_mm_s"]
    assert np.array_equal(rate_mm_s[:, 3], velocity_mm_s[:, 3] - velocity_mm_s[:, 2])


def test_bellows_push_both_by_one_function() -> None:
    learned = Learned.parse("learned:slider:3-4:gap")
    assert learned.variable.column == "gap_mm"
    assert learned.elements == (2, 3)
