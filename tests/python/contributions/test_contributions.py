"""Contributions to the circular deviation, on a machine whose errors are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.comparison.circles import compare_circles
from hexdbb.contributions import Contributions, RecordContributions, groups_of, rank_contributions
from hexdbb.ledger import add_effect, fit_model
from hexdbb.model import Model, new_model
from hexdbb.record import Record
from hexdbb.rig.mechanisms import MECHANISMS
from hexdbb.rig.truth import GaugeTruth, random_truth
from hexdbb.samples import Samples, predict
from hexdbb_truth.plans import discovery_plan
from hexdbb_truth.simulate import Pace, simulate

SLIDER = 4
PLAY = MECHANISMS["backlash"].model_validate({"kind": "backlash", "slider": SLIDER, "width_um": 15.0})
TRUTH = random_truth(11).model_copy(update={"mechanism": (PLAY,)})
PLAN = discovery_plan().model_copy(update={"laps": 1})
PACE = Pace(rate_hz=2.0, instants_per_sample=8, travel_s=1.0)
G_B = "bidirectional_circular_deviation"


@pytest.fixture(scope="module")
def record() -> Record:
    return simulate(TRUTH, PLAN, pace=PACE)


@pytest.fixture(scope="module")
def samples(record: Record) -> Samples:
    return Samples.of([record])


@pytest.fixture(scope="module")
def without(samples: Samples) -> Model:
    return fit_model(samples, new_model(samples.machine)).model


@pytest.fixture(scope="module")
def model(samples: Samples, without: Model) -> Model:
    return add_effect(samples, without, f"backlash:{SLIDER}").model


@pytest.fixture(scope="module")
def found(samples: Samples, model: Model) -> Contributions:
    return rank_contributions(samples, model)


@pytest.fixture(scope="module")
def table(found: Contributions) -> RecordContributions:
    return found.records[0]


def test_the_measured_deviation_is_that_of_the_iso_table(
    samples: Samples, model: Model, table: RecordContributions
) -> None:
    circles = compare_circles(samples, predict(samples, model).reading_mm)
    iso_mm = [each.directions[0].measured_quantities[G_B] for each in circles]
    assert table.measured_by_circle_um == pytest.approx([1e3 * (each or 0.0) for each in iso_mm], abs=0.02)
    assert table.circles == tuple((each.circle.id, each.feed_mm_min) for each in circles)


def test_rows_are_ranked_by_what_they_do_alone(table: RecordContributions) -> None:
    alone = [each.circular_deviation_um for each in table.rows]
    assert alone == sorted(alone, reverse=True)
    assert {part.effect for each in table.rows for part in each.parts}.isdisjoint(
        part.effect for each in table.set_up for part in each.parts
    )


def true_deviation_um() -> float:
    """Return the circular deviation that the play makes in the same machine, by the simulator, without noise."""
    with_play, perfect = (
        simulate(truth.model_copy(update={"gauge": GaugeTruth(noise_um=0.0, resolution_um=0.0)}), PLAN, pace=PACE)
        for truth in (TRUTH, TRUTH.model_copy(update={"mechanism": ()}))
    )
    only = with_play.columns["reading_um"] - perfect.columns["reading_um"]
    made = Samples.of([replace(with_play, columns=with_play.columns | {"reading_um": only})])
    each = [circle.directions[0].measured_quantities[G_B] for circle in compare_circles(made, made.reading_mm)]
    return float(np.mean([1e3 * (width or 0.0) for width in each]))


def test_the_play_hidden_in_one_slider_has_the_size_it_truly_makes(table: RecordContributions) -> None:
    play = next(each for each in table.rows if each.label == f"backlash of slider {SLIDER}")
    assert play.circular_deviation_um == pytest.approx(true_deviation_um(), rel=0.02)
    assert play.is_known
    assert 0.0 < play.sigma_um < 0.2
    assert play.without_um < table.measured_um


def test_what_only_the_sum_is_known_of_is_one_row(table: RecordContributions) -> None:
    """Guideways and home positions move the same joints; legs and the platform's sides are known on their own."""
    joined = [each for each in table.rows if len(each.parts) > 1]
    assert len(joined) == 1
    effects = {part.effect for part in joined[0].parts}
    assert {"slider_offset", "guideway_translation", "guideway_rotation_xy"} <= effects
    assert joined[0].is_known
    assert joined[0].sigma_um < 0.1 * max(part.sigma_um for part in joined[0].parts)
    alone = {each.label for each in table.rows if len(each.parts) == 1}
    assert {"leg_length", "platform_side"} <= alone


def test_the_set_up_does_next_to_nothing_to_the_circular_deviation(table: RecordContributions) -> None:
    assert table.set_up
    assert all(each.percent < 2.0 for each in table.set_up)


def test_taking_out_everything_leaves_what_is_not_explained(table: RecordContributions) -> None:
    left = table.not_explained
    assert left is not None
    assert left.rms_um == pytest.approx(0.5, rel=0.15)  # the gauge's noise
    assert left.percent < 15.0


def test_what_the_model_lacks_stands_among_the_rest(samples: Samples, without: Model) -> None:
    left = rank_contributions(samples, without).records[0].not_explained
    assert left is not None
    assert left.rms_um > 1.2


def test_a_covariance_that_is_given_is_used(samples: Samples, model: Model, found: Contributions) -> None:
    exact = rank_contributions(samples, model, covariance=np.zeros((len(model.values),) * 2))
    assert all(each.sigma_um == 0.0 for each in exact.records[0].rows)
    assert all(len(each.parts) == 1 for each in exact.records[0].rows)
    assert any(each.sigma_um > 0.0 for each in found.records[0].rows)


def test_a_model_that_is_taken_as_exact(samples: Samples, model: Model) -> None:
    held = model.with_free(np.zeros(len(model.values), bool))
    assert all(each.sigma_um == 0.0 for each in rank_contributions(samples, held).records[0].rows)


def test_two_records_have_a_table_each(record: Record, model: Model) -> None:
    later = replace(record, columns={**record.columns, "reading_um": record.columns["reading_um"] + 0.1}, metadata={})
    both = rank_contributions(Samples.of([record, later]), model)
    assert len(both.records) == 2
    one, other = (each.rows[0] for each in both.records)
    assert one.circular_deviation_um == pytest.approx(other.circular_deviation_um, abs=0.5)


def test_a_compensated_record_has_no_rows_but_the_reason(record: Record, model: Model) -> None:
    driven = replace(record, metadata={"compensation": {"file": "sp120.hexcomp"}})
    found = rank_contributions(Samples.of([driven]), model).records[0]
    assert not found.rows
    assert "sp120.hexcomp" in found.note
    assert "sp120.hexcomp" in str(Contributions((found,)))


def test_text_json_and_frame_say_the_same(found: Contributions, table: RecordContributions) -> None:
    shown, first = found.to_json(), table.rows[0]
    row = shown["records"][0]["contributions"][0]
    assert (row["label"], row["circular_deviation_um"]) == (first.label, first.circular_deviation_um)
    frame = found.to_frame()
    assert frame["contribution"][0] == first.label
    assert len(frame) == len(table.rows) + 1 + len(table.set_up)
    assert f"{first.circular_deviation_um:.2f}" in str(found)
    assert "known only together" in str(found)
    assert first.label in found._repr_html_()


def test_an_effect_added_is_one_group_an_element_and_geometry_one_in_all(model: Model) -> None:
    labels = [each.label for each in groups_of(model)]
    assert f"backlash of slider {SLIDER}" in labels
    assert "leg_length" in labels
    assert len(labels) == len(set(labels))
