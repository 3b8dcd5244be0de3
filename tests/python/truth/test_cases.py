"""Truth with forms: a case is its name; records are as `hexdbb-run` writes them."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from hexdbb.errors import InputError
from hexdbb.record import read_record
from hexdbb_truth.forms import plans
from hexdbb_truth.forms.cases import (
    case,
)
from hexdbb_truth.forms.lists import alone, clean, combined, outside
from hexdbb_truth.forms.outside import ANYWHERE, BY_NAME_ONLY, EVERY_OUTSIDE, OUTSIDE


def test_names_tell_cases():
    some = [
        *itertools.islice(alone("judge"), 300),
        *itertools.islice(outside("calibrate"), 200),
        *combined("judge"),
        *combined("judge", 3, count=5),
        *clean("calibrate"),
    ]
    for each in some:
        assert case(each.name) == each
    assert {len(each.kinds) for each in some} == {0, 1, 2, 3}


def test_kinds_by_name_only_are_in_a_list_only_where_it_is_told_so():
    assert set(EVERY_OUTSIDE) == set(OUTSIDE) | set(BY_NAME_ONLY) | set(ANYWHERE)
    assert not set(OUTSIDE) & set(BY_NAME_ONLY)
    assert {kind for each in outside("judge") for kind in each.kinds} == set(OUTSIDE)
    asked = list(outside("judge", (3.0, 10.0), [0], BY_NAME_ONLY))
    assert [each.name for each in asked[:1]] == ["table_of_other_axis-d0-x3-judge-s0"]
    assert {case(each.name).kinds[0] for each in asked} == set(BY_NAME_ONLY)
    assert len(asked) == 2 * len(BY_NAME_ONLY)


@pytest.mark.parametrize(
    "name",
    [
        "backlash",
        "backlash-d10-x3-s1",
        "gremlin-d10-x3-judge-s1",
        "backlash-d10-x3-train-s1",
        "none-judge-s1@nowhere",
        "none-d10-x3-judge-s1",
        "backlash+bar_drift-d10-x3,10,30-judge-s1",
        "backlash+bar_drift-d10-x3,-judge-s1",
    ],
)
def test_a_name_that_tells_no_case_is_refused(name):
    with pytest.raises(InputError, match=r"^case "):
        case(name)


def test_a_case_is_its_name_and_the_halves_are_other_machines():
    one, again = case("pitch_cyclic-d10-x3-judge-s3"), case("pitch_cyclic-d10-x3-judge-s3")
    np.testing.assert_array_equal(one.record().columns["reading_um"], again.record().columns["reading_um"])
    other = case("pitch_cyclic-d10-x3-calibrate-s3")
    assert other.truth != one.truth
    assert other.hidden[0].form in {"pitch_third", "pitch_fading"}
    assert one.hidden[0].form in {"pitch_wandering", "pitch_sharp"}
    assert one.deviations()[0] == pytest.approx(0.1, rel=1e-6)
    assert case("pitch_cyclic+bar_drift-d10-x3-judge-s3").catalogued
    assert not case("pitch_cyclic+dent-d10-x3-judge-s3").catalogued


def test_a_record_has_noise_rounding_and_a_thermometer_in_every_second_seed():
    one = case("leg_thermal-d5-x3-judge-s1")
    record, clean_um = one.record(), 1e3 * one.readings_mm()
    assert 9000 < len(record) < 11000
    reading = record.columns["reading_um"]
    assert np.std(reading - clean_um) == pytest.approx(0.5, rel=0.03)
    np.testing.assert_allclose(reading / 0.1, np.round(reading / 0.1), atol=1e-6)
    np.testing.assert_allclose(record.sliders_mm * 1e4, np.round(record.sliders_mm * 1e4), atol=1e-6)
    assert record.columns["temperature_c"].max() > 20.5
    assert "temperature_c" not in case("none-judge-s2").record().columns
    assert {"sweep", "lap", "direction", "feed_mm_min"} <= set(record.columns)


def test_every_plan_is_driven_with_as_many_readings(tmp_path):
    for name in plans.PLANS:
        one = case(f"none-judge-s4@{name}")
        record = one.record()
        assert 9000 < len(record) < 11000
        low, high = record.machine.sliders.travel_mm
        assert low < record.sliders_mm.min() < record.sliders_mm.max() < high
        gaps = record.sliders_mm[:, 1::2] - record.sliders_mm[:, ::2]
        assert gaps.min() > record.machine.sliders.min_gap_mm
    written = one.write(tmp_path)
    np.testing.assert_array_equal(read_record(written).columns["reading_um"], record.columns["reading_um"])


def test_faults_of_one_machine_may_be_of_sizes_of_their_own():
    name = "backlash+servo_lag-d10-x30,3-judge-s3"
    one, same, large = case(name), case("backlash+servo_lag-d10-x3-judge-s3"), case("backlash-d10-x30-judge-s3")
    assert one.name == name and one.times_noise == 30.0
    assert [each.size for each in one.hidden] == [large.hidden[0].size, same.hidden[1].size]
