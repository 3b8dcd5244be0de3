"""What a diagnosis can be told and what it says of itself: chosen values, glitches, minimal sets, the ball's place."""

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.cli.diagnose import choose_free, hold_redundant
from hexdbb.diagnosis import diagnose, noise_of
from hexdbb.errors import InputError
from hexdbb.kinematics import inverse
from hexdbb.model import new_model
from hexdbb.plan import Plan
from hexdbb.rig.truth import random_truth
from hexdbb.samples import Samples
from hexdbb.studies.file import load_study
from hexdbb.studies.measured import place_errors
from hexdbb.studies.setting import setting_of
from hexdbb_truth.simulate import simulate

SEED = 77
SETTING = setting_of(load_study("standard"))
"""Seven circles at 3000 mm/min, one lap each way, 40 readings per second."""
PACE = SETTING.pace


def study_plan() -> Plan:
    return SETTING.plan


@pytest.fixture(scope="module")
def record():
    return simulate(random_truth(SEED), study_plan(), SEED, PACE)


@pytest.fixture(scope="module")
def found(record):
    return diagnose(Samples.of([record]), new_model(record.machine), check_held_out=False)


def test_free_holds_the_machines_other_effects(record):
    model = choose_free(new_model(record.machine), "leg_length,slider_offset:2", "leg_length:6")
    free = {parameter.label for parameter, is_free in zip(model.parameters(), model.free, strict=True) if is_free}
    assert {label for label in free if label.startswith("leg_length")} == {
        f"leg_length:{k} longer" for k in range(1, 6)
    }
    assert {label for label in free if label.startswith("slider_offset")} == {"slider_offset:2 offset"}
    assert "cup_position:1 x" in free
    assert not any(label.startswith("guideway") for label in free)


@pytest.mark.parametrize(
    ("free", "fix", "named"),
    [
        ("leg_length:3", "leg_length:3", "leave nothing to fit"),
        ("leg_lenght", None, '"leg_lenght" is not in the model'),
        (None, "leg_length:7", 'leg_length has no element "7"'),
    ],
)
def test_choices_that_make_no_sense(record, free, fix, named):
    with pytest.raises(InputError, match=named):
        choose_free(new_model(record.machine), free, fix)


def test_an_effect_that_acts_nowhere_is_named(record):
    # Sliders exactly where the nominal machine has them: nothing for a wrong gauge scale to scale.
    circles = [record.circle(int(each)) for each in record.columns["circle"]]
    angle = np.radians(record.columns["angle_deg"])
    rows = [
        inverse(record.machine, circle.poses(at, record.mounts[0].cup_mm), circle.platform_rpy_rad)[0][0]
        for circle, at in zip(circles[:600], angle[:600], strict=True)
    ]
    part = record.part(np.arange(len(angle)) < 600)
    exact = replace(part, columns={**part.columns, **{f"s{k + 1}_mm": np.array(rows)[:, k] for k in range(6)}})
    with pytest.raises(InputError, match="bar_gain acts nowhere"):
        diagnose(Samples.of([exact]), new_model(record.machine, ["leg_length", "bar_gain"]), check_held_out=False)


def test_glitches_do_not_bend_a_robust_fit(record, found):
    random = np.random.default_rng(SEED)
    glitched = record.columns["reading_um"].copy()
    hit = random.choice(len(glitched), len(glitched) // 100, replace=False)
    glitched[hit] += 200.0
    worse = replace(record, columns={**record.columns, "reading_um": glitched})
    known = ~np.isnan(found.model.sigma)

    def moved(robust: bool) -> float:
        again = diagnose(Samples.of([worse]), new_model(record.machine), robust=robust, check_held_out=False)
        return float(np.abs((again.model.values - found.model.values)[known] / found.model.sigma[known]).max())

    assert moved(robust=True) < 1.5
    assert moved(robust=False) > 5.0 * moved(robust=True)


def test_minimal_set_explains_as_much_with_as_many_values_as_the_rank(record, found):
    model = hold_redundant(Samples.of([record]), new_model(record.machine))
    machine = [not parameter.is_set_up for parameter in model.parameters()]
    assert int((model.free & machine).sum()) == found.rank
    minimal = diagnose(Samples.of([record]), model, check_held_out=False)
    assert minimal.rank == found.rank
    assert minimal.rms_after_um == pytest.approx(found.rms_after_um, rel=0.01)


def test_noise_comes_from_laps_where_there_are_two(record):
    plan = study_plan().model_copy(update={"laps": 2})
    twice = simulate(random_truth(SEED), plan, SEED, PACE)
    assert noise_of(Samples.of([record])).source == "stated"
    assert noise_of(Samples.of([twice])).source == "repeated laps"
    assert noise_of(Samples.of([twice])).sigma_mm == pytest.approx(0.5e-3, rel=0.08)


def test_place_is_known_as_well_as_it_is_said(found):
    places = found.place
    error_um = place_errors(random_truth(SEED), SETTING, found).after_um
    assert 0.3 < error_um / places.median_um < 2.5
    assert places.median_um < places.worst_um < 5.0 * places.median_um


def test_a_record_counts_once(record):
    with pytest.raises(InputError, match="the same readings as"):
        diagnose(Samples.of([record, record]), new_model(record.machine), check_held_out=False)


def test_two_records_tell_more_than_one(record, found):
    other = simulate(random_truth(SEED), study_plan(), SEED + 1, PACE)
    both = diagnose(Samples.of([record, other]), new_model(record.machine), check_held_out=False)
    assert both.rank == found.rank
    assert len(both.model.mounts) == 2
    assert both.rms_after_um == pytest.approx(0.5, rel=0.03)
    legs = [each.effect == "leg_length" for each in both.model.parameters() if each.effect == "leg_length"]
    assert (both.model.sigma[: len(legs)] < found.model.sigma[: len(legs)]).all()
