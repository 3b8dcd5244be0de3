"""A gauge that drifts by a form of its own drifts: in triangles as heating switches, in steps as a door is opened."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.verdict.verdict import judge
from hexdbb.learned import Learned
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.cases import PACE, case

Floats = np.ndarray
DRIFT_UM = 60.0
"""Drift over the whole test, far beyond the noise."""
PART = 0.1
"""Amplitude of what is not linear in it."""


def triangle(elapsed: Floats) -> Floats:
    return 4.0 * np.abs((4.3 * elapsed + 0.2) % 1.0 - 0.5) - 1.0


def steps(elapsed: Floats) -> Floats:
    return np.tanh((elapsed - 0.3) / 0.02) - np.tanh((elapsed - 0.52) / 0.02) + np.tanh((elapsed - 0.8) / 0.02)


@pytest.mark.parametrize("form", [triangle, steps])
def test_a_drift_of_another_form_is_a_drift(form: Callable[[Floats], Floats]) -> None:
    record = case("none-s4", replace(PACE, rate_hz=0.5 * PACE.rate_hz)).record()
    time_s, reading_um = record.columns["t_s"], record.columns["reading_um"]
    elapsed = (time_s - time_s[0]) / np.ptp(time_s)
    drifted_um = reading_um + DRIFT_UM * (elapsed + PART * form(elapsed))
    samples = Samples.of([replace(record, columns={**record.columns, "reading_um": drifted_um})])
    model = new_model(samples.machine).with_mounts(samples.mounts)
    search = Search(Engine(samples, model, judging_noise(samples).noise), ("bar_drift", "backlash"), DEFAULT)
    verdict = judge(search)
    assert [each.hypothesis.name for each in verdict.found] == ["bar_drift"]
    assert verdict.grade == "effect"
    assert verdict.node.trial.left < DEFAULT.leaves_structure
    (drift,) = verdict.node.hypotheses
    alike = [
        search.same_kind(drift, Learned.parse(f"learned:{place}:step@60/300")) for place in ("reading", "slider:2")
    ]
    assert alike == [True, False]
