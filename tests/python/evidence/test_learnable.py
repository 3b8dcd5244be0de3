"""Which learned hypotheses a search looks at."""

from __future__ import annotations

import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.engine import Engine
from hexdbb.evidence.learnable import Learnable
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


@pytest.mark.parametrize(("plan", "is_asked"), [("standard", False), ("varied", True)])
def test_about_one_cup_the_platform_s_position_is_the_angle(plan: str, is_asked: bool) -> None:
    samples = Samples.of([case(f"none-calibrate-s1@{plan}").record()])
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
