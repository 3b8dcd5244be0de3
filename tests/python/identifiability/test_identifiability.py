"""What a plan can tell, before it is driven: rank, condition, indices, uncertainties, minimal set, and words for the
rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.identifiability import (
    Sensitivity,
    expected_covariance,
    expected_uncertainties,
    measured_sensitivity,
    minimal_set,
    null_directions,
    observability,
    pivots,
    plan_sensitivity,
    with_every_effect,
)
from hexdbb.identifiability.redundancy import sentences
from hexdbb.kinematics import inverse
from hexdbb.model import Model, new_model
from hexdbb.plan import Circle, Mount, Plan, load_plan
from hexdbb.record import SLIDER_COLUMNS, Record
from hexdbb.samples import Samples

RATE_HZ = 250.0
NOISE_MM = 0.5e-3
STANDARD = load_plan("standard")
MODEL = new_model(STANDARD.machine_file())
STRUCTURAL = [
    *(f"guideway_translation:{i} y is the same motion as slider_offset:{2 * i - 1}:{2 * i} offset" for i in (1, 2, 3)),
    *(
        f"guideway_rotation_centre:{i} angle is the same motion as slider_offset:{2 * i - 1}:{2 * i} offset"
        f" and guideway_rotation_xy:{i} angle"
        for i in (1, 2, 3)
    ),
]
RIGID = [
    f"a rigid {motion} of base and cup {along} {axis}"
    for motion, along in (("shift", "along"), ("turn", "about"))
    for axis in "xyz"
]


def freed(model: Model, *held: str) -> Model:
    return model.with_free(np.array([each.effect not in held for each in model.parameters()]))


def tilted(plan: Plan) -> Plan:
    """The plan with two circles more, their planes tilted 8 degrees about x and about y."""
    level = plan.circles[0]
    more = [(8.0, 0.0, 0.0), (0.0, 8.0, 0.0)]
    circles = [level.model_copy(update={"id": 7 + k, "plane_rpy_deg": rpy}) for k, rpy in enumerate(more)]
    return plan.model_copy(update={"circles": (*plan.circles, *circles)})


def sensitivity(plan: Plan = STANDARD, model: Model = MODEL) -> Sensitivity:
    return plan_sensitivity(plan, model, RATE_HZ)


@pytest.mark.parametrize(
    ("held", "rank", "condition"),
    [
        (("bar_length", "ball_offset"), 21, 438),
        (("bar_length",), 21, 506),
        ((), 21, 512),
        (("bar_length", "ball_offset", "cup_position"), 23, 2476),
    ],
)
def test_rank_and_condition_of_the_standard_plan(held: tuple[str, ...], rank: int, condition: float) -> None:
    found = observability(sensitivity(model=freed(MODEL, *held)))
    assert (found.rank, found.values) == (rank, 33)
    assert found.condition == pytest.approx(condition, rel=0.005)


def test_indices_follow_their_definitions_and_do_not_grow_with_patience() -> None:
    found = observability(sensitivity())
    seen = found.singular_values[: found.rank]
    assert found.o1 == pytest.approx(np.prod(seen) ** (1.0 / found.rank))
    assert found.o3 == seen.min()
    assert found.o4 == pytest.approx(found.o3 / found.condition)
    patient = observability(sensitivity(STANDARD.model_copy(update={"laps": 8})))
    assert (patient.o1, patient.o3, patient.o4) == pytest.approx((found.o1, found.o3, found.o4))


def test_readings_are_those_the_drive_takes() -> None:
    per_circle = 2 * 2 * 2 * np.pi * 100.0 * 60.0 * RATE_HZ * (1 / 753.98 + 1 / 3000.0)
    assert sensitivity().readings == pytest.approx(7 * per_circle)


def test_a_record_tells_what_its_plan_promised() -> None:
    """A record whose samples stand where the plan's rows do, each for one reading."""
    count = 180
    angle_rad = np.arange(count) * 2 * np.pi / count
    sliders = [
        inverse(MODEL.machine, each.poses(angle_rad, STANDARD.mounts[0].cup_mm), each.platform_rpy_rad)[0]
        for each in STANDARD.circles
    ]
    rows = count * len(sliders)
    columns = {name: np.zeros(rows) for name in ("lap", "reading_um")}
    columns |= {"t_s": np.arange(rows) / RATE_HZ, "direction": np.ones(rows), "feed_mm_min": np.full(rows, 753.98)}
    columns |= {name: np.repeat(np.arange(len(sliders)), count) for name in ("circle", "sweep")}
    columns |= {"angle_deg": np.degrees(np.tile(angle_rad, len(sliders)))}
    columns |= dict(zip(SLIDER_COLUMNS, np.vstack(sliders).T, strict=True))
    record = Record(columns, STANDARD.gauge, STANDARD.mounts, STANDARD.circles, MODEL.machine, {})
    planned, taken = observability(sensitivity()), measured_sensitivity(Samples.of([record]), MODEL)
    assert taken.readings == rows
    np.testing.assert_allclose(observability(taken).singular_values, planned.singular_values, atol=1e-12)
    assert observability(taken).unidentifiable == planned.unidentifiable


def test_what_the_standard_plan_cannot_tell_is_named_by_structure() -> None:
    assert list(observability(sensitivity()).unidentifiable) == [
        *STRUCTURAL,
        *RIGID,
        "cup_position:1 z changes no reading",
    ]


def test_tilted_circle_planes_see_the_height_of_the_cup() -> None:
    assert list(observability(sensitivity(tilted(STANDARD))).unidentifiable) == [*STRUCTURAL, *RIGID]


def test_rigid_motions_of_base_and_cup_take_all_cups_along() -> None:
    second = Mount(id=1, cup_mm=(10.0, -5.0, 330.0))
    circles = [each.model_copy(update={"mount": each.id % 2}) for each in tilted(STANDARD).circles]
    plan = STANDARD.model_copy(update={"mounts": (STANDARD.mounts[0], second), "circles": tuple(circles)})
    assert list(observability(sensitivity(plan)).unidentifiable)[:12] == [*STRUCTURAL, *RIGID]


def test_with_a_known_cup_only_turns_about_it_are_rigid_motions() -> None:
    """The base may turn about the cup's centre unseen; shifts of it are seen."""
    found = observability(sensitivity(tilted(STANDARD), freed(MODEL, "bar_length", "ball_offset", "cup_position")))
    assert found.rank == 24
    assert list(found.unidentifiable) == [*STRUCTURAL, *RIGID[3:]]


def test_a_redundancy_is_named_only_where_its_values_are_free() -> None:
    found = observability(sensitivity(model=freed(MODEL, "slider_offset", "bar_length", "guideway_rotation_centre")))
    assert [each for each in found.unidentifiable if each in STRUCTURAL] == []
    assert set(RIGID) <= set(found.unidentifiable)


def test_every_null_direction_is_told_once_and_holds_at_a_machine_with_errors() -> None:
    taken = sensitivity()
    null = null_directions(taken)
    parameters, displaced = taken.where(taken.free), taken.displacements.of_values(taken.free)
    rng = np.random.default_rng(3)
    turned, _ = np.linalg.qr(null @ rng.normal(size=(null.shape[1],) * 2) + 1e-4 * rng.normal(size=null.shape))
    assert sentences(turned, parameters, displaced) == sentences(null, parameters, displaced)
    assert len(sentences(null, parameters, displaced)) == null.shape[1]
    assert np.abs(taken.scaled(taken.free) @ null).max() < 1e-9


def test_what_one_level_circle_confounds_is_told_alike_in_every_basis() -> None:
    """Which unknowns are told by which others must not depend on rounding, which differs between computers."""
    taken = sensitivity(load_plan("thesis"))
    null = null_directions(taken)
    parameters, displaced = taken.where(taken.free), taken.displacements.of_values(taken.free)
    said = sentences(null, parameters, displaced)
    assert sum("confounded" in each for each in said) > 5
    rng = np.random.default_rng(4)
    for _ in range(5):
        turned, _ = np.linalg.qr(null @ rng.normal(size=(null.shape[1],) * 2) + 1e-9 * rng.normal(size=null.shape))
        assert sentences(turned, parameters, displaced) == said


def test_no_null_direction_no_sentence() -> None:
    taken = sensitivity()
    displaced = taken.displacements.of_values(taken.free)
    assert sentences(np.zeros((int(taken.free.sum()), 0)), taken.where(taken.free), displaced) == []


def test_minimal_set_explains_all_that_readings_can_tell() -> None:
    taken = sensitivity()
    kept, held = minimal_set(taken)
    assert (len(kept), len(held)) == (21, 12)
    chosen = np.array([each in kept for each in taken.parameters])
    alone = replace(taken, model=taken.model.with_free(chosen | (taken.free & taken.is_set_up)))
    found = observability(alone)
    assert found.rank == found.values == 21
    assert [each for each in found.unidentifiable if "cup_position" not in each] == []


def test_pivots_stop_at_the_rank_and_take_the_first_of_equal_columns() -> None:
    columns: NDArray[np.float64] = np.array([[1.0, 1.0, 0.0, 1.0], [0.0, 0.0, 0.5, 0.5], [0.0, 0.0, 0.0, 0.0]])
    assert pivots(columns) == [3, 0]
    assert pivots(columns[:, [0, 1]]) == [0]
    assert pivots(np.zeros((3, 2))) == []


def test_expected_uncertainty_is_the_posterior_of_repeated_fits() -> None:
    """Linear fits with prior to simulated noise and values drawn from the prior scatter as stated."""
    taken = sensitivity(model=freed(MODEL, "bar_length"))
    # The triangular factor answers to values as all readings do, in as many rows as there are values.
    _, scaled = np.linalg.qr(taken.scaled(taken.free) / NOISE_MM)
    rng = np.random.default_rng(11)
    count = 4000
    truth = rng.normal(size=(scaled.shape[1], count))
    gain = np.linalg.solve(scaled.T @ scaled + np.eye(scaled.shape[1]), scaled.T)
    errors = gain @ (scaled @ truth + rng.normal(size=(len(scaled), count))) - truth
    stated = np.sqrt(np.diag(expected_covariance(taken, NOISE_MM)))[taken.free] / taken.prior_sigma[taken.free]
    np.testing.assert_allclose(errors.std(axis=1), stated, rtol=0.06)


def test_uncertainty_falls_with_noise_and_what_is_entangled_has_none() -> None:
    fine, coarse = (expected_uncertainties(sensitivity(), noise) for noise in (NOISE_MM, 10 * NOISE_MM))
    by_name = {each.parameter.label: each for each in fine}
    assert by_name["platform_side:12 longer"].identifiable
    assert 0 < by_name["platform_side:12 longer"].sigma < 1e-3
    assert not by_name["guideway_translation:1 y"].identifiable
    assert np.isnan(by_name["guideway_translation:1 y"].sigma)
    for one, other in zip(fine, coarse, strict=True):
        assert not other.identifiable or other.sigma > one.sigma


def test_every_effect_of_the_catalogue_stands_beside_and_is_not_free() -> None:
    bare = new_model(MODEL.machine, ["leg_length"])
    whole = with_every_effect(bare)
    assert {term.effect for term in whole.terms} >= {term.effect for term in MODEL.terms}
    assert whole.free.sum() == bare.free.sum() == 6


def test_a_circle_out_of_reach_is_named_with_its_angle() -> None:
    circle = Circle(id=4, mount=0, radius_mm=100.0, ball_offset_mm=(0.0, 0.0, 60.0), platform_rpy_deg=(60.0, 0.0, 0.0))
    plan = STANDARD.model_copy(update={"circles": (circle,)})
    with pytest.raises(InputError, match=r"^far\.toml: circle 4 at \d+ deg: "):
        plan_sensitivity(plan, MODEL, RATE_HZ, "far.toml")
