"""What only goes with the likely cause is named last; what the cause does not explain stays where it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.comparison import Comparison, compare, compare_readings
from hexdbb.comparison.tables import comparison_text
from hexdbb.diagnosis import diagnose
from hexdbb.discovery import LikelyCause
from hexdbb.files.plain_text import plain_text
from hexdbb.model import new_model
from hexdbb.samples import Samples, predict
from hexdbb_truth.cases import case


@pytest.fixture(scope="module")
def comparison() -> Comparison:
    """Compare a machine whose slider 4 has play with a model of its geometry."""
    record = case("backlash-x3-s1").record()
    samples = Samples.of([record])
    return compare(samples, diagnose(samples, new_model(record.machine), check_held_out=False).model)


def test_the_first_line_names_the_cause(comparison: Comparison) -> None:
    said = " ".join(plain_text(comparison_text(comparison)).split())
    assert said.startswith("Likely cause: slider 4 has ")
    assert list(comparison.to_json()["cause"]["choices"]) == ["backlash:4"]
    assert comparison._repr_html_().startswith("<p><b>Likely cause: slider 4 has ")


def test_other_sliders_are_named_after_all_others_and_as_bystanders(comparison: Comparison) -> None:
    marks = [each.is_bystander for each in comparison.predictors]
    assert marks == sorted(marks) and any(marks)
    own = {each.subject for each in comparison.predictors if not each.is_bystander}
    beside = {each.subject for each in comparison.predictors if each.is_bystander}
    assert "slider 4" in own and "angle" in own
    assert {f"slider {k}" for k in (1, 2, 3, 5, 6)} <= beside
    lines = plain_text(comparison_text(comparison)).splitlines()
    first = next(k for k, line in enumerate(lines) if line.startswith("Going with the likely cause"))
    named = [line for line in lines[:first] if "slider" in line and "%  " in line]
    assert named and all("slider 4" in line for line in named)


def test_circumstances_of_other_sliders_are_left_out(comparison: Comparison) -> None:
    assert not [
        each.what for each in comparison.worst_samples.common if "slider" in each.what and "slider 4" not in each.what
    ]


def test_nothing_is_a_bystander_without_a_cause(comparison: Comparison) -> None:
    samples = comparison.samples
    bare = compare_readings(samples, comparison.predicted_mm)
    assert bare.cause is None and bare.to_json()["cause"] is None
    assert not any(each.is_bystander for each in bare.predictors)
    assert bare.worst_samples.bystanders == ()


def test_what_the_cause_leaves_is_no_bystander(comparison: Comparison) -> None:
    """A cause that explains a tenth of the residual has no company."""
    assert comparison.cause is not None
    little = replace(comparison.cause, residual_mm=0.95 * comparison.residual_mm, is_all=False)
    same = compare_readings(comparison.samples, comparison.predicted_mm, cause=little)
    assert not [each.variable for each in same.predictors if each.is_bystander and each.share > 0.1]
    assert same.worst_samples.bystanders == ()


def test_the_cause_is_looked_for_only_when_asked() -> None:
    record = case("backlash-x3-s1").record().part(np.arange(3000))
    samples = Samples.of([record])
    model = new_model(record.machine).with_mounts(samples.mounts)
    assert compare(samples, model, find_cause=False).cause is None
    assert isinstance(compare(samples, model).cause, LikelyCause)
    assert predict(samples, model).rms_um > 1.0
