"""Distance of the platform from the machine's axis, and functions of it."""

from __future__ import annotations

import numpy as np

from hexdbb.learned import Learned
from hexdbb.samples import Samples
from hexdbb_truth.cases import case


def test_radius_is_the_distance_from_the_axis() -> None:
    samples = Samples.of([case("none-s1").record()])
    position = samples["position_mm"]
    np.testing.assert_allclose(samples["radius_mm"], np.hypot(position[:, 0], position[:, 1]), rtol=1e-15)


def test_a_hose_may_pull_a_leg_the_farther_out_the_platform_is() -> None:
    assert Learned.parse("learned:leg:1:platform_radius").variable.needs == {"radius_mm"}
