"""A product of two states is called by the one that explains nearly all; one that needs both keeps its name."""

from __future__ import annotations

import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.verdict import Found, judge
from hexdbb.learned import Learned
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


def found_in(name: str) -> Found:
    """Return the one cause found in a case of which nothing is known but play."""
    samples = Samples.of([case(name).record()])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    verdict = judge(Search(Engine(samples, model, judging_noise(samples).noise), ("backlash",), DEFAULT))
    (found,) = verdict.found
    assert verdict.refined is not None
    assert verdict.refined.trial.left < DEFAULT.leaves_structure
    return found


@pytest.mark.long
def test_a_lag_that_differs_along_the_guideway_is_one_of_the_velocity() -> None:
    found = found_in("servo_lag-d10-x10-calibrate-s61")
    assert found.hypothesis.name == "learned:slider:5:velocity"
    assert "learned:slider:5:velocity_position" in found.refinements


@pytest.mark.long
def test_a_lag_that_the_load_makes_is_one_of_both() -> None:
    assert found_in("droops_when_pushed-d0-x10-calibrate-s61").hypothesis.name == "learned:slider:1:velocity_drive_load"


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("learned:slider:5:velocity_position", ("learned:slider:5:velocity", "learned:slider:5:position")),
        ("learned:reading:deflection_time", ("learned:reading:deflection", "learned:reading:time")),
        ("learned:cup:time_angle", ("learned:cup:time", "learned:cup:angle")),
        ("learned:leg:1:joint_angle_direction", ("learned:leg:1:joint_angle", "learned:leg:1:turning_rate")),
        # The sense in which the gauge moves is no variable of its own.
        ("learned:reading:deflection_direction_deflection", ("learned:reading:deflection",)),
        ("learned:leg:1:leg_force_lagged@12", ()),
        ("learned:slider:5:velocity", ()),
    ],
)
def test_parts_of_a_product_are_variables_of_its_place(name: str, parts: tuple[str, ...]) -> None:
    assert tuple(each.name for each in Learned.parse(name).parts) == parts
