"""Angles of the bar: in the platform, which may be turned, and in the base."""

from __future__ import annotations

import numpy as np

from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


def test_in_the_base_it_is_the_circles_angle_in_the_platform_it_is_turned_by_that() -> None:
    samples = Samples.of([case("none-calibrate-s1@standard").record()])
    azimuth = samples["bar_azimuth_rad"]
    assert np.cos(azimuth - samples["angle_rad"]).min() > 1.0 - 1e-9
    yaw = samples["platform_rpy_rad"][:, 2]
    assert np.ptp(yaw) > 0.4
    level = np.hypot(*samples["platform_rpy_rad"][:, :2].T) < 0.02
    assert np.cos(azimuth - yaw - samples["bar_angle_rad"])[level].min() > 1.0 - 1e-3
