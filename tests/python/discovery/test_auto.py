"""Several missing effects, one after another; an earlier choice that has become needless is taken out again."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace

import pytest
from tests.foreign_records import samples_of

from hexdbb.diagnosis import noise_of
from hexdbb.discovery import (
    AutoStep,
    Discovery,
    closing_sentence,
    discover_all,
    is_needed,
    predicts_better,
    without_needless,
)
from hexdbb.ledger import add_effect
from hexdbb.model import new_model
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb_truth.cases import case

PAIR = "lead_error+pitch_cyclic-x3-s5"
ASKED = ["backlash", "lead_error", "pitch_cyclic", "servo_lag", "gravity_sag"]
"""Of the catalogue, for the sake of time."""


def test_a_pair_is_found_one_after_the_other(measured: Callable[[str], Record]) -> None:
    record = measured(PAIR)
    *steps, last = discover_all(Samples.of([record]), new_model(record.machine), ASKED)
    assert all(isinstance(each, AutoStep) and each.what == "add" for each in steps)
    effects = {each.choice.partition(":")[0] for each in steps if isinstance(each, AutoStep)}
    assert effects == {hidden.kind for hidden in case(PAIR).hidden}
    assert isinstance(last, Discovery) and last.verdict == "none"
    assert last.rms_before_um < 0.7
    closing = closing_sentence([each for each in steps if isinstance(each, AutoStep)], last)
    assert closing.startswith("found and added: ") and all(effect in closing for effect in effects)
    falls = [each.diagnosis.model.ledger[-1] for each in steps if isinstance(each, AutoStep)]
    assert falls[0].rms_before_um > falls[1].rms_before_um > falls[1].rms_after_um


@pytest.mark.long
def test_what_forms_leave_is_added_on_demand_and_the_error_falls_to_the_noise() -> None:
    """Legs that grow unequally beside a play and a pitch error: with their formulas alone 5.8 µm of 13.4 stayed."""
    samples = samples_of("play-beside-growth")
    noise_um = 1e3 * noise_of(samples).sigma_mm
    *steps, last = discover_all(samples, new_model(samples.machine), forms=True)
    assert isinstance(last, Discovery) and last.verdict == "none"
    assert last.rms_before_um < 1.1 * noise_um
    known = [each.choice for each in steps if isinstance(each, AutoStep) and not each.choice.startswith("learned:")]
    assert sorted(known) == ["backlash:4", "leg_thermal", "pitch_cyclic:6"]  # none of them taken out again
    functions = [each for each in steps if isinstance(each, AutoStep) and each.choice.startswith("learned:")]
    assert any(each.choice.startswith("learned:leg:each:growth_settling@") for each in functions)
    assert all(predicts_better(each.diagnosis.model) for each in functions)


def test_a_function_that_the_model_has_is_not_added_again(
    measured: Callable[[str], Record], monkeypatch: pytest.MonkeyPatch
) -> None:
    samples = Samples.of([measured("backlash-x3-s1")])
    name = "learned:slider:4:position"
    model = add_effect(samples, new_model(samples.machine), name).model
    look = SimpleNamespace(verdict="none", causes=(), calibrated=(), refinements=(name, name))
    monkeypatch.setattr("hexdbb.discovery.auto.discover", lambda *_, **__: look)
    assert [*discover_all(samples, model, forms=True)] == [look]


def test_a_machine_that_lacks_nothing_gets_nothing(measured: Callable[[str], Record]) -> None:
    record = measured("none-s2")
    (last,) = discover_all(Samples.of([record]), new_model(record.machine))
    assert isinstance(last, Discovery) and last.verdict == "none"


def test_what_nobody_knows_is_not_added(measured: Callable[[str], Record]) -> None:
    record = measured("mains_pickup-x10-s1")
    (last,) = discover_all(Samples.of([record]), new_model(record.machine), ["backlash", "pitch_cyclic", "servo_lag"])
    assert isinstance(last, Discovery) and last.verdict == "unknown"


def test_what_is_needless_is_taken_out_and_what_is_needed_stays(measured: Callable[[str], Record]) -> None:
    record = measured("backlash-x3-s1")
    model = add_effect(Samples.of([record]), new_model(record.machine), "reversal_spike:2").model
    model = add_effect(Samples.of([record]), model, "backlash:4").model
    assert not is_needed(Samples.of([record]), model, "reversal_spike:2")
    assert is_needed(Samples.of([record]), model, "backlash:4")
    (step,) = without_needless(Samples.of([record]), model, ["reversal_spike:2", "backlash:4"])
    assert (step.what, step.choice) == ("remove", "reversal_spike:2")
    left = step.diagnosis.model
    assert [each.what for each in left.ledger] == ["add", "add", "remove"]
    assert [term.effect for term in left.terms if term.effect in ("backlash", "reversal_spike")] == ["backlash"]
