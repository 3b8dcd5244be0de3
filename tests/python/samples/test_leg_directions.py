"""Where each leg points: against the engine's angles at its two ends, and the dimensions of the machine at home."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.machine import home_heights_mm
from hexdbb.machine.home import home_legs
from hexdbb.plan import load_plan
from hexdbb.samples import Samples
from hexdbb.samples.leg_columns import leg_columns
from hexdbb.samples.leg_directions import LEG_DIRECTIONS


@pytest.fixture(scope="module")
def planned() -> Samples:
    plan = load_plan("standard")
    return Samples.planned(plan.machine_file(), plan.runs()[::5], np.linspace(0.0, 6.0, 40), 100.0)


def _parts(planned: Samples, frame: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the parts of the unit vectors along the direction at home, aside of it, and across both."""
    aside, tilt = planned[f"leg_aside_in_{frame}"], planned[f"leg_tilt_in_{frame}"]
    return np.sqrt(1.0 - aside**2 - tilt**2), aside, tilt


def _rise(planned: Samples) -> np.ndarray:
    """Return the upward part of each leg's direction at home."""
    height_mm = float(np.mean(home_heights_mm(planned.machine)))
    return height_mm / np.array(planned.machine.legs.lengths_mm)


@pytest.mark.parametrize(
    ("frame", "angle"), [("platform", "platform_joint_angle_rad"), ("base", "leg_inclination_rad")]
)
def test_upward_parts_are_those_of_the_angle_to_the_normal(planned: Samples, frame: str, angle: str) -> None:
    along, _, tilt = _parts(planned, frame)
    upward = _rise(planned)
    found = along * upward + tilt * np.sqrt(1.0 - upward**2)
    assert np.abs(found) == pytest.approx(np.abs(np.cos(planned[angle])), abs=1e-6)
    assert np.ptp(found) > 0.1


def test_parts_along_guideways_are_those_of_the_slider_s_joint(planned: Samples) -> None:
    along, aside, tilt = _parts(planned, "base")
    upward = _rise(planned)
    level = np.sqrt(1.0 - upward**2)
    legs = home_legs(planned.machine)
    inward = np.array([leg.aside_mm / leg.length_mm for leg in legs])
    ahead = np.sqrt(level**2 - inward**2) * np.array([1.0 if leg.is_first else -1.0 for leg in legs])
    found = along * ahead + aside * inward / level - tilt * ahead * upward / level
    assert np.abs(found) == pytest.approx(np.abs(np.cos(planned["slider_joint_angle_rad"])), abs=1e-6)
    assert np.ptp(aside) > 0.1


def test_at_home_nothing_is_across_and_squares_are_squares(planned: Samples) -> None:
    machine = planned.machine
    low_mm, high_mm = home_heights_mm(machine)
    height_mm = 0.5 * (low_mm + high_mm)
    spans_mm = [np.sqrt(leg.widest_mm**2 - height_mm**2) for leg in home_legs(machine)]
    sliders_mm = [leg.place_mm(span) for leg, span in zip(home_legs(machine), spans_mm, strict=True)]
    position_mm = [[0.0, 0.0, height_mm - machine.platform.joint_plane_height_mm]]
    found = leg_columns(machine, np.array(position_mm), np.zeros((1, 3)), np.array([sliders_mm]))
    assert all(np.abs(found[each]).max() < 1e-9 for each in LEG_DIRECTIONS)
    for name in LEG_DIRECTIONS:
        if name.endswith("_squared"):
            assert planned[name] == pytest.approx(planned[name.removesuffix("_squared")] ** 2)
