"""What is hidden is named with its element, a clean machine is left alone, what nobody knows is called unknown."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from hexdbb.discovery import Discovery, discover
from hexdbb.errors import InputError
from hexdbb.model import new_model
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE
from hexdbb_truth.simulate import simulate


@pytest.mark.parametrize("name", ["backlash-x3-s1", "pitch_cyclic-x3-s3", "gravity_sag-x3-s2"])
def test_the_hidden_effect_is_found(
    measured: Callable[[str], Record], found_in: Callable[[str], Discovery], name: str
) -> None:
    (hidden,) = case(name).hidden
    record, found = measured(name), found_in(name)
    assert found.verdict == "effect"
    assert found.best is not None
    assert found.best.effect == hidden.kind
    assert found.best.elements == (str(hidden.element or 1),)
    assert found.rms_before_um > 1.0 > 0.7 > found.rms_after_um
    assert found.heldout_before_um is not None and found.heldout_after_um is not None
    assert found.heldout_after_um < 1.2 * record.gauge.noise_um < found.heldout_before_um


@pytest.mark.parametrize("name", ["none-s1", "none-s2"])
def test_a_clean_machine_lacks_nothing(measured: Callable[[str], Record], name: str) -> None:
    record = measured(name)
    found = discover(Samples.of([record]), new_model(record.machine))
    assert found.verdict == "none"
    assert found.sentence.startswith(("nothing is missing: what is left is noise", "nothing that matters is missing"))
    assert (found.best, found.causes, found.next_test, found.structure, found.remarks) == (None, (), None, (), ())


@pytest.mark.parametrize(
    ("name", "places", "carrier"),
    [
        ("dent-x3-s1", ("learned:vertical:3:", "learned:lateral:3:"), "guideway 3 position (vertical)"),
        ("mains_pickup-x10-s1", ("learned:reading:time", ""), "time, repeating"),
    ],
    ids=["dent", "mains"],
)
def test_a_fault_outside_the_catalogue_is_unknown(
    measured: Callable[[str], Record], name: str, places: tuple[str, ...], carrier: str
) -> None:
    record = measured(name)
    found = discover(Samples.of([record]), new_model(record.machine))
    assert found.verdict == "unknown"
    assert found.best is None
    assert (found.causes[0].choice if found.causes else "").startswith(places)
    first = found.structure[0]
    assert first.variable == carrier and first.sentence.startswith(carrier)
    assert (first.place is None) == (first.period is not None)
    shares = [each.share for each in found.structure]
    assert all(0.0 < share <= 1.0 for share in shares) and shares == sorted(shares, reverse=True)


def test_a_gauge_noisier_than_stated_is_no_fault_of_the_machine() -> None:
    hidden = case("backlash-x3-s1", replace(PACE, rate_hz=4.0))
    gauge = hidden.truth.gauge.model_copy(update={"noise_um": 2.0})
    record = simulate(hidden.truth.model_copy(update={"gauge": gauge}), hidden.plan, pace=hidden.pace)
    assert record.gauge.noise_um == 0.5
    found = discover(Samples.of([record]), new_model(record.machine))
    assert found.best is not None and found.best.choice == "backlash:4"
    assert found.lack_of_fit.noise_um == pytest.approx(2.0, rel=0.05)
    (remark,) = found.remarks
    assert "the gauge is stated to have 0.50 µm: it is noisier than stated" in remark
    assert discover(Samples.of([record]), found.model).verdict == "none"


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "truth"),
    [("loose_cup-x3-s0", "learned:cup:"), ("guideway_bend-x3-s2", "learned:vertical:2:time_position")],
)
def test_what_fits_but_does_not_predict_is_not_named(measured: Callable[[str], Record], name: str, truth: str) -> None:
    record = measured(name)
    found = discover(Samples.of([record]), new_model(record.machine))
    named = [each.choice for each in found.causes] + [rival for each in found.causes for rival in each.rivals]
    assert found.verdict in ("unknown", "ambiguous")
    assert any(truth in each for each in named)
    assert not [each for each in found.causes if each.verdict == "effect" and each is found.causes[0]]


@pytest.mark.long
def test_what_errs_elsewhere_by_more_than_it_explains_is_a_lead_alone(measured: Callable[[str], Record]) -> None:
    """A guideway bends with time and place; legs that grow by laws of their own fit as well, on these circles."""
    record = measured("guideway_bend-x3-s2")
    found = discover(Samples.of([record]), new_model(record.machine))
    assert found.verdict == "unknown"
    assert found.causes and {each.verdict for each in found.causes} == {"unknown"}


def test_two_faults_are_found_with_their_elements(measured: Callable[[str], Record]) -> None:
    name = "backlash+servo_lag-x3-s4"
    record = measured(name)
    found = discover(Samples.of([record]), new_model(record.machine))
    assert {each.choice for each in found.causes} == {f"{each.kind}:{each.element}" for each in case(name).hidden}
    assert found.verdict == "effect" and {each.verdict for each in found.causes} == {"effect"}
    assert "together they explain" in found.sentence
    assert found.heldout_after_um is not None and found.heldout_after_um < 1.2 * record.gauge.noise_um
    assert discover(Samples.of([record]), found.model).verdict == "none"


def test_the_sentence_is_one_a_fitter_understands(found_in: Callable[[str], Discovery]) -> None:
    found = found_in("backlash-x3-s1")
    pattern = (
        r"Slider 4 has \d+\.\d+ ± 0\.\d+ µm of play between drive and carriage; it explains"
        r" (more than )?\d+ % of what the model missed, on circles, feeds, directions( and laps)? not used to find it"
    )
    assert re.fullmatch(pattern, found.sentence)


def test_what_matters_is_the_users_to_say(measured: Callable[[str], Record]) -> None:
    record = measured("backlash-x3-s1")
    samples = Samples.of([record])
    found = discover(samples, new_model(record.machine), matters_um=50.0)
    assert found.verdict == "none" and found.sufficiency.is_significant
    assert re.fullmatch(
        r"nothing that matters is missing: \d+\.\d\d µm unexplained, significant \(p < 1e-16\),"
        r" below the 50.00 µm that matter here",
        found.sentence,
    )
    with pytest.raises(InputError, match=r"matters: -1 µm \(expected a length, 0 or larger\)"):
        discover(samples, new_model(record.machine), matters_um=-1.0)


def test_a_candidate_that_is_not_known_is_refused(measured: Callable[[str], Record]) -> None:
    record = measured("none-s3")
    with pytest.raises(InputError, match=r"candidate blacklash: not a known effect \(expected one of backlash, "):
        discover(Samples.of([record]), new_model(record.machine), ["blacklash"])


def test_two_circles_are_enough_where_they_tell_it(measured: Callable[[str], Record]) -> None:
    record = measured("backlash-x3-s1")
    few = record.part(record.columns["circle"] < 2)
    found = discover(Samples.of([few]), new_model(record.machine))
    assert found.best is not None and found.best.choice == "backlash:4"


def test_too_few_to_judge_is_said(measured: Callable[[str], Record]) -> None:
    record = measured("none-s3")
    model = new_model(record.machine)
    one_sweep = np.isin(np.arange(len(record)), max(record.sweeps(), key=len))
    repeated = record.part(one_sweep)
    with pytest.raises(InputError, match=r"100 readings are too few to judge \(expected 200 at least\)"):
        discover(Samples.of([record.part(np.arange(len(record)) < 100)]), model)
    with pytest.raises(InputError, match=r"1 sweep is too few to judge \(expected 2 at least"):
        discover(Samples.of([repeated]), model)
    with pytest.raises(InputError, match=r"no record \(expected at least one\)"):
        discover(Samples.of([]), model)
