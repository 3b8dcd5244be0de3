"""Tables of compensated targets: reversals within the drives' limits, no jump anywhere, the right place at the ball."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.truth.closing import silent

from hexdbb import _core
from hexdbb.compensation import CompensatedTargets, make_compensation, smooth_changes, travel_directions
from hexdbb.compensation import targets as targets_module
from hexdbb.compensation.reversals import Travel
from hexdbb.errors import InputError
from hexdbb.kinematics import inverse
from hexdbb.machine import shipped_machine
from hexdbb.model import Model, new_model
from hexdbb.plan import Plan, load_plan
from hexdbb.rig.mechanisms import MECHANISMS
from hexdbb.rig.truth import TruthFile
from hexdbb.trajectory import Programme, approach, plan_programme
from hexdbb.trajectory import programme as programme_module
from hexdbb_truth.simulate import Pace, simulate

Floats = NDArray[np.float64]

MACHINE = shipped_machine()
LIMITS = MACHINE.can_setup.limits
CYCLE_S = 0.004
PACE = Pace(rate_hz=50.0, instants_per_sample=5)
"""An instant each 4 ms."""


def model_of(**values: Floats | list[float]) -> Model:
    """A model with these values (engine units) of these effects."""
    model = new_model(MACHINE, list(values))
    stated = np.concatenate([np.asarray(each, dtype=float) for each in values.values()])
    return model.with_values(stated, np.full(len(stated), np.nan), np.ones(len(stated), bool))


def targets_of(model: Model, **options: float) -> CompensatedTargets:
    return CompensatedTargets(make_compensation(model, **options), LIMITS, "sp120.hexcomp")


def fast_plan(feed_mm_min: float = 3000.0, **circle: object) -> Plan:
    plan = load_plan("standard")
    some = (plan.circles[0].model_copy(update=circle), plan.circles[2])
    return plan.model_copy(update={"circles": some, "feeds_mm_min": (feed_mm_min,), "laps": 1})


def programme_of(targets: CompensatedTargets, plan: Plan | None = None) -> Programme:
    return plan_programme(plan or fast_plan(), MACHINE, CYCLE_S, "plan", targets)


WORN = {
    "leg_length": [0.05, -0.08, 0.02, 0.06, -0.03, 0.01],
    "backlash": [0.012, 0.02, 0.03, 0.015, 0.008, 0.1],
    "servo_lag": [1e-3, 0.0, 2e-3, 0.0, 0.0, 1e-3],
}


def settling_of(values_mm: list[float], slider: int | None = None) -> CompensatedTargets:
    """Every slider, or one, is off against its motion by these at 0, 0.2, 1 and 5 mm after a reversal."""
    pushes = [(k, k, 1.0) for k in range(6) if slider in (None, k + 1)]
    knots = [0.0, 0.2, 1.0, 5.0]
    table = _core.CompensationTable(
        effect="settling",
        port="slider",
        variable="since_reversal_mm",
        times="travel_direction",
        period=0.0,
        pushes=pushes,
        knots=knots,
        values_mm=values_mm,
    )
    data = _core.compensation_of(
        new_model(MACHINE, []).engine(),
        name="settling",
        model_sha256="",
        max_correction_mm=1.0,
        reversal_travel_mm=0.01,
        reference_temperature_c=np.nan,
        tables=[table],
    )
    return CompensatedTargets(data, LIMITS, "sp120.hexcomp")


SETTLING_MM = [0.002, 0.005, 0.008, 0.01]
MACHINES = {"worn": targets_of(model_of(**WORN)), "settling": settling_of(SETTLING_MM)}


@pytest.fixture(scope="module", params=MACHINES)
def worn(request: pytest.FixtureRequest) -> CompensatedTargets:
    return MACHINES[request.param]


def test_every_row_keeps_the_limits_though_play_is_crossed_at_every_reversal(worn: CompensatedTargets) -> None:
    programme = programme_of(worn)
    stand, status = inverse(MACHINE, np.array([[10.0, -20.0, 270.0]]), np.radians([[3.0, -2.0, 5.0]]))
    assert status[0] == 0
    way = approach(stand[0], programme, MACHINE, "plan")
    rate = np.vstack([way.sliders_mm, programme.table.sliders_mm])
    assert np.abs(rate[0] - stand[0]).max() < 1e-3
    for limit in (LIMITS.velocity_mm_s, LIMITS.acceleration_mm_s2, LIMITS.jerk_mm_s3):
        rate = np.diff(rate, axis=0) / CYCLE_S
        assert np.abs(rate).max() <= limit


@pytest.mark.parametrize("block_rows", [64, 1008])
def test_targets_do_not_depend_on_how_their_rows_are_divided(
    worn: CompensatedTargets, block_rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Play is crossed before and after the ends of blocks, and rests last longer than a block."""
    whole = programme_of(worn)
    monkeypatch.setattr(programme_module, "BLOCK_ROWS", block_rows)
    monkeypatch.setattr(targets_module, "LOOK_ROWS", block_rows)
    parts = programme_of(worn)
    np.testing.assert_allclose(parts.table.sliders_mm, whole.table.sliders_mm, rtol=0, atol=1e-8)
    assert parts.first_travel.tolist() == whole.first_travel.tolist()


def test_the_way_in_joins_the_programme_at_rest(worn: CompensatedTargets) -> None:
    programme = programme_of(worn)
    stand = programme.table.sliders_mm[len(programme.table) // 2]
    way = approach(stand, programme, MACHINE, "plan")
    assert np.abs(way.sliders_mm[-1] - programme.table.sliders_mm[0]).max() < 1e-4  # an encoder's count
    assert np.abs(np.diff(way.sliders_mm[-20:], axis=0)).max() < 1e-6


def test_without_effects_targets_are_the_nominal_ones() -> None:
    plan = fast_plan()
    nominal = plan_programme(plan, MACHINE, CYCLE_S, "plan").table.sliders_mm
    same = programme_of(targets_of(new_model(MACHINE, [])), plan).table.sliders_mm
    np.testing.assert_allclose(same, nominal, atol=1e-9)


def test_what_the_drives_cannot_follow_is_refused_by_circle_slider_and_limit() -> None:
    pitch = np.zeros((6, 4))
    pitch[3, 2] = 0.03  # twice a turn of the screw
    with pytest.raises(
        InputError, match=r"plan: circle 0, .* arc at .* deg: jerk of slider 4: .* \(expected at most 5"
    ):
        programme_of(targets_of(model_of(pitch_cyclic=pitch.ravel())))


def test_ways_slow_down_for_a_pitch_error_that_the_circles_feed_allows() -> None:
    pitch = np.zeros((6, 4))
    pitch[:, 2] = 0.02
    targets, plan = targets_of(model_of(pitch_cyclic=pitch.ravel())), fast_plan(754.0)
    slowed, nominal = programme_of(targets, plan), plan_programme(plan, MACHINE, CYCLE_S, "plan")
    assert slowed.limit_fraction < nominal.limit_fraction
    assert slowed.table.capture.sum() == nominal.table.capture.sum()


def test_a_correction_beyond_what_the_file_allows_is_refused() -> None:
    targets = targets_of(model_of(leg_length=[0.5] * 6), max_correction_mm=0.2)
    with pytest.raises(InputError, match=r"circle 0, .*slider \d: correction of \d+\.\d µm \(expected at most 200 µm"):
        programme_of(targets)


# --- directions of travel ---------------------------------------------------------------------------------------------


def column(*values: float) -> Floats:
    """Six sliders that all move so."""
    return np.tile(np.array(values)[:, None], (1, 6))


def test_a_resting_slider_changes_direction_in_mid_rest() -> None:
    found = travel_directions(column(0, 1, 1, 1, 1, 1, 0))[:, 0]
    assert found.tolist() == [1, 1, 1, 1, -1, -1, -1]


def test_ends_hold_their_direction_unless_stated() -> None:
    moving = column(0, 0, 0, 0, 1, 2, 2, 2, 2, 2)
    assert travel_directions(moving)[:, 0].tolist() == [1] * 10
    stated = travel_directions(moving, before=-np.ones(6), after=-np.ones(6))[:, 0]
    assert stated.tolist() == [-1, -1, 1, 1, 1, 1, 1, 1, -1, -1]


def test_a_slider_that_never_moves_has_no_direction() -> None:
    assert not travel_directions(column(3.0, 3.0 + 1e-12, 3.0 - 1e-12)).any()


def test_travel_since_a_reversal_is_kept_for_either_direction_until_it_has_changed_over() -> None:
    moving, never = column(0, 1, 2, 3, 2, 1, 0, 0, 2), _core.LONG_AGO
    travel = Travel()
    travel.take(moving[:5])
    travel.take(moving[5:])
    down, up = travel.since_reversal_mm(0, moving)
    assert down[:, 0].tolist() == [never, never, 0, 0, 1, 2, 3, 3, 0]
    assert up[:, 0].tolist() == [never] * 4 + [never, 0, 0, 0, 2]
    part = travel.since_reversal_mm(4, moving[4:7])
    np.testing.assert_array_equal(part, (down[4:7], up[4:7]))


def test_a_motion_that_leads_to_another_counts_no_reversals() -> None:
    travel = Travel(before=np.zeros(6), after=np.ones(6))
    travel.take(column(0, 1, 0))
    assert (np.array(travel.since_reversal_mm(0, column(0, 1, 0))) == _core.LONG_AGO).all()


@pytest.mark.parametrize("cycles", [1, 3, 9])
def test_a_change_of_direction_is_even_about_the_reversal(cycles: int) -> None:
    turn = np.repeat([1.0, -1.0], 40)
    smooth = smooth_changes(turn, cycles)
    np.testing.assert_allclose(smooth, -smooth[::-1], atol=1e-12)
    assert (np.diff(smooth) <= 1e-12).all()
    third = np.abs(np.diff(smooth, n=3)).max()
    assert third <= 2 * 2.0 / cycles**3 * (1 + 1e-9), "the jerk the module's formula promises"


# --- at the ball, on a machine that shares no code with the compensation ----------------------------------------------


def readings_um(mechanisms: list[dict[str, object]], model: Model | CompensatedTargets | None, plan: Plan) -> Floats:
    """True radial readings of a machine with these mechanisms, compensated by a model, by targets, or not."""
    tables = tuple(MECHANISMS[str(table["kind"])].model_validate(table) for table in mechanisms)
    drive = None
    if model is not None:
        targets = model if isinstance(model, CompensatedTargets) else targets_of(model)

        def drive(position_mm: Floats, rpy_rad: Floats, cycle_s: float) -> Floats:
            rows = targets.sliders(position_mm, rpy_rad, cycle_s)
            assert rows.refused is None
            return rows.sliders_mm

    record = simulate(silent(TruthFile(mechanism=tables)), plan, 0, PACE, drive=drive)
    return record.columns["reading_um"]


def rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


SPIKE = {"kind": "reversal_spike", "slider": 2, "breakaway_um": 15.0, "decay_s": 0.1}
LAG = {"kind": "servo_lag", "slider": 3, "lag_ms": 5.0}
PLAY = {"kind": "backlash", "slider": 4, "width_um": 20.0}
ONE_LAG, ONE_PLAY = {"servo_lag": [0, 0, 5e-3, 0, 0, 0]}, {"backlash": [0, 0, 0, 0.02, 0, 0]}


@pytest.mark.parametrize("feed_mm_min", [754.0, 3000.0])
def test_play_leaves_little_even_at_the_reversals(feed_mm_min: float) -> None:
    plan = fast_plan(feed_mm_min)
    before, after = readings_um([PLAY], None, plan), readings_um([PLAY], model_of(**ONE_PLAY), plan)
    assert rms(after) < rms(before) / 15.0
    assert np.abs(after).max() < np.abs(before).max() / 2.0


def test_play_is_undone_as_a_function_of_the_travel_since_a_reversal_too() -> None:
    """One half of the play against the motion, however long ago the slider reversed."""
    plan = fast_plan()
    undone = settling_of([-0.01] * 4, slider=4)
    before, after = readings_um([PLAY], None, plan), readings_um([PLAY], undone, plan)
    np.testing.assert_allclose(after, readings_um([PLAY], model_of(**ONE_PLAY), plan), atol=1e-3)
    assert rms(after) < rms(before) / 15.0


def test_lag_is_removed_at_the_reversals_too() -> None:
    plan = fast_plan()
    before, after = readings_um([LAG], None, plan), readings_um([LAG], model_of(**ONE_LAG), plan)
    assert rms(after) < rms(before) / 50.0
    assert np.abs(after).max() < np.abs(before).max() / 30.0


def test_a_spike_at_the_reversal_stays_and_nothing_is_added_to_it() -> None:
    plan = fast_plan()
    spike = {"reversal_spike": [v for k in range(6) for v in ((0.015, 0.7, 0.0) if k == 1 else (0.0, 0.0, 0.0))]}
    data = make_compensation(model_of(**spike))
    assert [name for name, _ in data.left_out] == ["reversal_spike"]
    all_three = [SPIKE, PLAY, LAG]
    alone = readings_um([SPIKE], None, plan)
    after = readings_um(all_three, model_of(**ONE_PLAY, **ONE_LAG, **spike), plan)
    others = readings_um([PLAY, LAG], model_of(**ONE_PLAY, **ONE_LAG), plan)
    np.testing.assert_allclose(after, alone + others, atol=0.2)
    assert rms(readings_um(all_three, None, plan)) > 3.0 * rms(after)
