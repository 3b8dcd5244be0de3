"""What is calibrated, and off: fitted where readings contradict it, and no fault of the machine."""

from __future__ import annotations

from collections.abc import Callable

from tests.foreign_records import found_in, samples_of

from hexdbb.diagnosis import diagnose
from hexdbb.discovery import Discovery, discover, discover_all, likely_cause
from hexdbb.discovery.calibrated import Calibrated
from hexdbb.effects.words import effect_clause
from hexdbb.model import Choice, Size, new_model
from hexdbb.record import Record
from hexdbb.samples import Samples, predict

LONGER = "clean-with-a-longer-bar"
"""No fault; a bar of 150 mm, 9.2 µm longer than stated, noise 0.15 µm."""


def test_a_clean_machine_is_clean_with_a_longer_bar() -> None:
    """It was a gauge that reads by the platform's yaw, with sides of the platform longer by 1.5 to 1.9 mm."""
    found = found_in(LONGER)
    assert found.verdict == "none"
    assert found.calibrated == ("bar_length",)
    assert not found.sufficiency.matters
    said = found.remarks[0]
    assert said.startswith("the bar is 9.")
    assert said.endswith("hexdbb add bar_length puts it into the model")
    parameters = found.base.parameters()
    place = next(k for k, each in enumerate(parameters) if each.effect == "bar_length")
    assert found.base.free[place]
    assert abs(found.base.values[place] - 9.2e-3) < 0.5e-3


def test_it_is_asked_for_in_place_of_the_least_of_sure_causes() -> None:
    """The bar is 6.5 µm longer than stated; for sure were a drive that lags, and a guideway bowed by 94 µm."""
    found = found_in("lag-with-a-longer-bar")
    assert [each.choice for each in found.causes] == ["servo_lag:3"]
    assert found.calibrated == ("bar_length",)
    assert found.remarks[0].startswith("the bar is 6.")


def test_it_is_asked_for_in_place_of_a_cause_that_is_not_for_sure() -> None:
    """A gauge read 9.2 ms late, and a bar 3.1 µm shorter than stated: all six screws had one lead besides."""
    found = found_in("late-gauge-shorter-bar")
    assert [each.choice for each in found.causes] == ["sample_delay"]
    assert found.calibrated == ("bar_length",)


def test_it_is_added_first_and_not_again() -> None:
    samples = samples_of(LONGER)
    step, last = discover_all(samples, new_model(samples.machine))
    assert not isinstance(step, Discovery)
    assert (step.what, step.choice) == ("add", "bar_length")
    assert isinstance(last, Discovery)
    assert (last.verdict, last.calibrated) == ("none", ())


def test_a_bar_as_long_as_stated_stays_so(measured: Callable[[str], Record]) -> None:
    record = measured("backlash-x3-s1")
    found = discover(Samples.of([record]), new_model(record.machine))
    assert [each.choice for each in found.causes] == ["backlash:4"]
    assert found.calibrated == ()
    assert not any("bar" in each for each in found.remarks)


def test_what_a_model_fits_already_is_not_asked_for() -> None:
    model = new_model(samples_of(LONGER).machine)
    assert Calibrated.of(model).names == ("bar_length",)
    assert Calibrated.of(model.with_effect(Choice.parse("bar_length"))).names == ()


def test_a_comparison_leads_with_it() -> None:
    samples = samples_of(LONGER)
    model = new_model(samples.machine).with_mounts(samples.mounts)
    fitted = diagnose(samples, model, check_held_out=False).model
    cause = likely_cause(samples, fitted, predict(samples, fitted).residual_mm)
    assert cause is not None
    assert cause.sentence.startswith("likely cause: the bar is 9.")
    assert cause.choices == ("bar_length",)


def test_a_bar_that_is_shorter_is_said_to_be() -> None:
    info = new_model(samples_of(LONGER).machine).info("bar_length")
    for value, sense in ((9.21, "longer"), (-9.21, "shorter")):
        clause = effect_clause(info, [Size("1", "longer", value, 0.3, "um")])
        assert clause == f"the bar is 9.2 ± 0.3 µm {sense} than its calibration says"
