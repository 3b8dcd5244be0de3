"""Friction that turns over gradually, and functions that are right once they are fine enough; tables that tip."""

from __future__ import annotations

import pytest

from hexdbb import _core
from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.verdict import judge
from hexdbb.learned import Learned, number_of
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "cause", "number", "within"),
    [
        # A seal that runs in drags by tanh of its velocity over 0.2 mm/s, a law that the estimator does not have.
        ("seal_runs_in-d0-x30-calibrate-s46", "learned:slider:6:direction_time_turning", 0.2, 0.06),
        # A joint that binds near one angle, within 0.005 rad/s: at once, the other leg of the pair has more evidence
        # than this leg, and friction there describes what it leaves.
        ("joint_sticks-d0-x30-calibrate-s46", "learned:leg:2:joint_angle_direction_turning", 0.005, 0.0015),
        # The circles are of one cup and nearly concentric: functions of their angle explain 97 %.
        ("stand_tips-d0-x10-calibrate-s47", "learned:cup:position_along", 29.0, 2.0),
    ],
)
def test_the_number_is_found_and_other_circles_predicted(name: str, cause: str, number: float, within: float) -> None:
    samples = Samples.of([case(name).record()])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    verdict = judge(
        Search(Engine(samples, model, judging_noise(samples).noise), _core.effect_names("catalogue"), DEFAULT)
    )
    (found,) = verdict.found
    learned = found.hypothesis
    assert isinstance(learned, Learned)
    assert learned.name.startswith(f"{cause}@")
    assert number_of(learned.variable) == pytest.approx(number, abs=within)
    assert verdict.checked is not None
    assert verdict.checked.heldout["circle"].after < 1.3
