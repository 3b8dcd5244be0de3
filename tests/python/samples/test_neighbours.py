"""Motion of the other slider on the guideway, and functions that it multiplies."""

from __future__ import annotations

import numpy as np

from hexdbb.learned import Learned, Space
from hexdbb.samples import Samples
from hexdbb_truth.cases import case


def test_neighbours_are_the_sliders_of_one_guideway() -> None:
    samples = Samples.of([case("none-s1").record()])
    own, other = samples["velocity_mm_s"], samples["neighbour_velocity_mm_s"]
    assert np.array_equal(other[:, [1, 0, 3, 2, 5, 4]], own)
    assert np.array_equal(samples["neighbour_travel_direction"][:, 2], samples["travel_direction"][:, 3])


def test_a_function_of_one_slider_is_multiplied_by_what_the_other_does() -> None:
    samples = Samples.of([case("none-s1").record()])
    learned = Learned.parse("learned:slider:3:neighbour_velocity_velocity")
    assert learned.elements == (2,)
    space = Space.of(learned, samples, samples.machine.sliders.screw_lead_mm)
    alone = space.functions(samples["velocity_mm_s"][:, 2])
    np.testing.assert_array_equal(space.design(samples, 2), samples["velocity_mm_s"][:, 3, None] * alone)
