"""Which learned hypotheses a search looks at."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.readings import State
from hexdbb.evidence.proposals.learnable import Learnable
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


@pytest.mark.parametrize(("circles", "is_asked"), [((0, 5, 6), False), ((0, 1, 2, 3), True)])
def test_on_concentric_circles_the_platform_s_position_is_the_angle(circles: tuple[int, ...], is_asked: bool) -> None:
    """Circles 1 to 4 of the standard plan stand an eighth of their radius off the middle, 0, 5 and 6 on it."""
    record = case("none-calibrate-s1@standard").record()
    samples = Samples.of([record.part(np.isin(record.columns["circle"], circles))])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    readings = Engine(samples, model, judging_noise(samples).noise).readings
    further = Learnable(readings, learns=True).further
    assert "learned:cup:angle" in further
    assert ("learned:cup:position_along@45" in further) is is_asked


def test_forms_alone_are_of_joints_that_reverse_of_warmth_and_of_circles() -> None:
    samples = Samples.of([case("none-calibrate-s1@two_mounts").record()])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    learnable = Learnable(Engine(samples, model, judging_noise(samples).noise).readings, learns=True)
    names = {each.name.partition("@")[0] for each in learnable.of_forms}
    assert {"learned:leg:3:joint_since_reversal", "learned:slider:2:warming_position", "learned:ball:step"} <= names
    # A function of the reading can describe any error of the gauge, circle by circle.
    assert "learned:reading:reading" not in names
    assert names.isdisjoint(each.name for each in (*learnable.simple, *learnable.products))


@pytest.mark.parametrize(
    ("from_circle", "from_platform", "is_asked"),
    [(0.0, 0.3, False), (0.3, 0.0, False), (0.3, 0.2, True)],
    ids=["level circles", "a platform that is not turned", "neither"],
)
def test_the_bars_angle_in_the_base_is_asked_where_it_says_more(
    from_circle: float, from_platform: float, is_asked: bool
) -> None:
    record = case("none-calibrate-s1@standard").record()
    samples = Samples.of([record.part(record.columns["circle"] == 0)])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    readings = Engine(samples, model, judging_noise(samples).noise).readings
    state = _Turned(readings.state, from_circle, from_platform)
    names = {each.name for each in Learnable(replace(readings, state=state), learns=True).simple}
    assert ("learned:reading:bar_azimuth" in names) is is_asked


class _Turned(State):
    """A state whose bar's angle in the base is another than those of the circle and in the platform."""

    def __init__(self, state: State, from_circle: float, from_platform: float) -> None:
        super().__init__(state, state.machine, state.unmeasured)
        angle = state["angle_rad"]
        wave = np.sqrt(2.0) * np.sin(3.0 * angle)
        self._known |= {
            "bar_azimuth_rad": angle + from_circle * wave,
            "bar_angle_rad": angle + (from_circle - from_platform) * wave,
        }
