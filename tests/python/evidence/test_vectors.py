"""What goes by a vector: a joint that hangs back along the platform's course, a base rocked by the carriages."""

from __future__ import annotations

import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.verdict import judge
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case


@pytest.mark.parametrize(
    ("name", "cause"),
    [
        ("pair_joint_hangs_back-d0-x3-calibrate-s61", "learned:platform_joint:5-6:course"),
        ("machine_rocks-d0-x3-calibrate-s61", "learned:cup:acceleration_along@90"),
    ],
)
def test_it_is_found_at_its_place(name: str, cause: str) -> None:
    samples = Samples.of([case(name).record()])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    verdict = judge(Search(Engine(samples, model, judging_noise(samples).noise), ("backlash",), DEFAULT))
    assert [each.hypothesis.name for each in verdict.found] == [cause]
    assert verdict.node.trial.left < DEFAULT.leaves_structure
    assert verdict.checked is not None
    assert verdict.checked.heldout["circle"].after < 1.1
