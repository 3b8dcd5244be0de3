"""The expected error of held-out circles is what is found; a cross-validation error that means little is flagged."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from hexdbb.diagnosis import Diagnosis, diagnose
from hexdbb.diagnosis.extrapolation import ExpectedError, expected_error
from hexdbb.ledger import add_effect
from hexdbb.model import new_model
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE

FEW = (0, 3)


@lru_cache
def measured(name: str, circles: tuple[int, ...] | None = None) -> Record:
    record = case(name, replace(PACE, rate_hz=0.25 * PACE.rate_hz)).record()
    return record if circles is None else record.part(np.isin(record.columns["circle"], circles))


@lru_cache
def diagnosed(name: str, circles: tuple[int, ...] | None = None) -> Diagnosis:
    record = measured(name, circles)
    return diagnose(Samples.of([record]), new_model(record.machine))


def expectation(name: str, circles: tuple[int, ...] | None = None) -> ExpectedError:
    found = diagnosed(name, circles)
    told = expected_error(Samples.of([measured(name, circles)]), found.model, found.noise_um)
    assert told is not None
    return told


@pytest.mark.parametrize("seed", range(1, 4))
def test_seven_circles_tell_each_other_and_the_error_is_as_expected(seed: int) -> None:
    told, checked = expectation(f"none-s{seed}"), diagnosed(f"none-s{seed}").held_out
    assert checked is not None
    assert not told.extrapolates
    assert checked.after_um == pytest.approx(told.expected_um, rel=0.1)


def test_two_circles_do_not_tell_each_other_and_that_is_said() -> None:
    told, found = expectation("none-s1", FEW), diagnosed("none-s1", FEW)
    assert told.extrapolates and told.expected_um > 20.0 * told.noise_um
    assert found.held_out is not None and found.held_out.after_um > 2.0 * told.noise_um
    assert found.rms_after_um < 1.1 * told.noise_um
    (said,) = [each for each in found.warnings if "held-out" in each]
    assert said.startswith("held-out circles are extrapolated: without circle")
    assert "measure more circles" in said


def test_with_few_circles_the_addition_says_why_the_held_out_error_is_large() -> None:
    record = measured("backlash-x3-s1", FEW)
    found = add_effect(Samples.of([record]), diagnosed("backlash-x3-s1", FEW).model, "backlash:4")
    model = found.model
    step = model.ledger[-1]
    assert step.heldout_after_um is not None and step.heldout_after_um > 5.0 * step.rms_after_um
    assert [each for each in found.warnings if each.startswith("held-out circles are extrapolated")]
    assert not [each for each in found.warnings if "does not hold elsewhere" in each]


def test_one_circle_cannot_be_left_out() -> None:
    found = diagnosed("none-s1", (0,))
    assert expected_error(Samples.of([measured("none-s1", (0,))]), found.model, 0.5) is None
    assert not [each for each in found.warnings if "held-out" in each]


def test_values_that_go_together_are_told_in_one_line() -> None:
    record = measured("backlash-x3-s1")
    found = add_effect(Samples.of([record]), diagnosed("backlash-x3-s1").model, "backlash:4")
    (said,) = [each for each in found.warnings if "correlated" in each]
    assert "leg_length:1:2 longer (+1.000); leg_length:3:4 longer (+1.000); leg_length:5:6 longer (+1.000)" in said
