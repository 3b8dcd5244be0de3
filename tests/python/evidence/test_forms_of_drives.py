"""Forms of what drives and screws do: by the next derivative, over time, along the screw."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.forms.homes import Homes
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.evidence.proposals.learnable import Learnable
from hexdbb.kinematics.screw import turns
from hexdbb.learned import Learned
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


@pytest.fixture(scope="module")
def engine() -> Engine:
    samples = Samples.of([case("none-calibrate-s1@standard").record()])
    return Engine(samples, new_model(samples.machine).with_mounts(samples.mounts), judging_noise(samples).noise)


def around(engine: Engine, effect: str, element: str) -> set[str]:
    """Return the names of functions in which the form of an effect may be wrong."""
    learnable = Learnable(engine.readings, learns=True)
    linear = engine.linearised(engine.start).linear
    words = (*learnable.simple, *learnable.products)
    homes = Homes(linear, Thinned(engine.readings), words, engine.criteria, learnable.of_forms)
    table, whose = engine.absent.signatures(engine.start, [effect])
    columns = [place for place, (_, own, *_) in enumerate(whose) if own == element]
    return {home.hypothesis.name for found in homes.around_each(table[:, columns]) for home in found}


def test_a_screw_has_turned_by_its_position() -> None:
    cos, sin = turns(np.array([[0.0, 1.25, 2.5, 3.75, 5.0, 12.5]]), 5.0).values()
    assert cos[0] == pytest.approx([1.0, 0.0, -1.0, 0.0, 1.0, -1.0])
    assert sin[0] == pytest.approx([0.0, 1.0, 0.0, -1.0, 0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize(
    ("effect", "element", "expected"),
    [
        ("pitch_cyclic", "3", {"learned:slider:3:screw_cos_position", "learned:slider:3:screw_sin_position"}),
        ("sample_delay", "1", {"learned:slider:all:velocity_over_time"}),
        ("servo_lag", "2", {"learned:slider:2:velocity_over_time"}),
    ],
)
def test_a_form_may_change_along_the_screw_or_over_the_test(
    engine: Engine, effect: str, element: str, expected: set[str]
) -> None:
    found = around(engine, effect, element)
    assert expected <= found
    others = {f"learned:slider:{each}:{next(iter(expected)).rpartition(':')[2]}" for each in (1, 4, 5, 6)}
    assert found.isdisjoint(others)


def test_they_are_no_causes(engine: Engine) -> None:
    learnable = Learnable(engine.readings, learns=True)
    causes = {each.variable.name for each in (*learnable.simple, *learnable.products, *learnable.further.values())}
    of_forms = ("screw_cos_position", "screw_sin_position", "velocity_over_time", "velocity_by_feed")
    assert causes.isdisjoint({*of_forms, "position_over_time"})


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("learned:slider:all:velocity", ["acceleration", "velocity_by_feed"]),
        ("learned:leg:4:velocity", ["acceleration"]),
        ("learned:slider:2:since_reversal_time", ["since_reversal_time_alike", "since_reversal_travel"]),
        ("learned:leg:2:since_reversal_travel", ["since_reversal_travel_alike", "since_reversal_time"]),
        ("learned:slider:2:time_position", ["time_position_bent", "position_over_time"]),
        ("learned:leg:2:time_position", []),
        ("learned:platform_joint:2:joint_angle", ["joint_since_reversal", "joint_angle_direction"]),
        ("learned:platform_joint:2:swing_angle", []),
        ("learned:leg:2:joint_angle", []),
        ("learned:ball:time", ["time_since_fixing"]),
        ("learned:slider:2:position", []),
    ],
)
def test_functions_of_other_variables_stand_beside_a_form(name: str, expected: list[str]) -> None:
    at, _, _ = name.rpartition(":")
    assert [each.name for each in Learned.parse(name).of_its_form] == [f"{at}:{each}" for each in expected]
