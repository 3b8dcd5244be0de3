"""Readings without slider positions: the fault is found all the same, and nothing is judged that needs encoders."""

from __future__ import annotations

import pytest
from tests.imports.make import PACE
from tests.python.importing.conftest import imported

from hexdbb.diagnosis import diagnose
from hexdbb.discovery import Discovery, discover
from hexdbb.errors import InputError
from hexdbb.evidence.linear.readings import State
from hexdbb.learned import Learned
from hexdbb.ledger import add_effect
from hexdbb.model import Choice, Model, new_model
from hexdbb.plan import load_plan
from hexdbb.predictors import rank_predictors
from hexdbb.record import Record
from hexdbb.samples import Samples, predict
from hexdbb.samples.unmeasured import unmeasured_columns
from hexdbb_truth.cases import case
from hexdbb_truth.simulate import simulate

SERVO = {"servo_lag", "sample_delay", "reversal_spike"}
TIMED = {"bar_drift", "leg_thermal", "screw_thermal"}


@pytest.fixture(scope="module")
def record() -> Record:
    return imported("german.csv")


@pytest.fixture(scope="module")
def samples(record: Record) -> Samples:
    return Samples.of([record])


@pytest.fixture(scope="module")
def model(record: Record) -> Model:
    return new_model(record.machine)


@pytest.fixture(scope="module")
def found(samples: Samples, model: Model) -> Discovery:
    return discover(samples, model)


def test_the_fault_is_found_with_its_size(found: Discovery) -> None:
    (hidden,) = case("backlash-x10-s3").hidden
    (cause,) = found.causes
    assert cause.choice == f"backlash:{hidden.mechanism.slider}"
    (size,) = cause.values
    assert size.value == pytest.approx(hidden.mechanism.width_um, abs=3.0 * size.sigma)


def test_the_verdict_says_what_was_not_measured(found: Discovery) -> None:
    sliders, time = found.remarks[-2:]
    assert "slider positions are not measured but computed (nominal inverse kinematics" in sliders
    assert sliders.endswith("no candidates: reversal_spike, sample_delay, servo_lag")
    assert time.endswith("no candidates: bar_drift, leg_thermal, screw_thermal")


def test_no_hypothesis_needs_what_was_not_measured(found: Discovery) -> None:
    names = {name for each in found.candidates for name in each.names}
    assert names
    assert not {name.partition(":")[0] for name in names} & (SERVO | TIMED)
    unmeasured = unmeasured_columns(found.samples.records)
    assert unmeasured >= {"velocity_mm_s", "time_s"}
    learned = [Learned.parse(name) for name in names if name.startswith("learned:")]
    assert learned
    assert not any(each.variable.needs & unmeasured for each in learned)


def test_functions_of_unmeasured_variables_are_no_hypotheses(samples: Samples) -> None:
    state = State(samples, samples.machine, samples.unmeasured)
    state.space(Learned.parse("learned:slider:3:position"))
    timed = ("learned:reading:time", "learned:slider:3:since_reversal_time")
    for name in ("learned:slider:3:velocity", "learned:leg:3:turning_rate", "learned:leg:3:swing_rate", *timed):
        with pytest.raises(InputError, match="was not measured"):
            state.space(Learned.parse(name))


def test_no_predictor_follows_what_was_not_measured(samples: Samples, model: Model) -> None:
    residual_mm = predict(samples, model).residual_mm
    names = {each.variable for each in rank_predictors(samples, residual_mm)}
    assert any("position" in name for name in names)
    assert not any("velocity" in name or "time" in name or "shift" in name for name in names)


@pytest.mark.parametrize("effect", [*sorted(SERVO), *sorted(TIMED), "learned:slider:3:velocity"])
def test_effects_that_need_it_are_refused(samples: Samples, model: Model, effect: str) -> None:
    with pytest.raises(InputError, match=f"{effect} needs .* which this record computes"):
        add_effect(samples, model, effect)


def test_their_values_are_held_in_a_fit_that_says_so(samples: Samples, model: Model) -> None:
    with_lag = model.with_effect(Choice.parse("servo_lag"))
    fitted = diagnose(samples, with_lag, check_held_out=False)
    lag = [each.effect == "servo_lag" for each in fitted.model.parameters()]
    assert any(lag)
    assert (fitted.model.values[lag] == 0.0).all()
    assert not fitted.model.free[lag].any()
    assert fitted.warnings[0].startswith("slider positions are not measured but computed")


def test_a_record_of_encoders_is_judged_by_all() -> None:
    hidden = case("none-s3")
    measured = Samples.of([simulate(hidden.truth, load_plan("thesis"), 3, PACE)])
    assert measured.unmeasured == frozenset()
    assert not measured.records[0].not_measured
