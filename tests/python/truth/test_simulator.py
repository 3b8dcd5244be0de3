"""The truth simulator: the rig's own machine without its bus, independent of what it is to test, sized as it says."""

from __future__ import annotations

import numpy as np
import pytest
from click.testing import CliRunner

from hexdbb.errors import InputError
from hexdbb.files.validation import load_toml
from hexdbb.plan import Plan, load_plan
from hexdbb.record import SLIDER_COLUMNS, read_record
from hexdbb.rig.geometry import rotation_rpy, true_geometry
from hexdbb.rig.mechanisms import CATALOGUED, MECHANISMS, OUTSIDE
from hexdbb.rig.plant import Plant
from hexdbb.rig.truth import TruthFile, random_truth
from hexdbb_truth.cases import MAKERS, PLANS, Case, alone, case, clean, every, pairs
from hexdbb_truth.places import true_balls_mm
from hexdbb_truth.plans import PACE, discovery_plan
from hexdbb_truth.repeatability import Approach
from hexdbb_truth.simulate import Pace, simulate, true_readings_mm
from hexdbb_truth.sizes import signature_um, sized
from hexdbb_truth.timeline import Arc, Timeline
from hexdbb_truth.write import main


def short_plan(**changed: object) -> Plan:
    """One circle, one lap each way."""
    plan = load_plan("standard")
    return plan.model_copy(
        update={"circles": plan.circles[1:2], "feeds_mm_min": (3000.0,), "laps": 1, "overshoot_deg": 10.0, **changed}
    )


SHORT_PACE = Pace(rate_hz=10.0, instants_per_sample=5, travel_s=2.0)


# --- the same machine as the rig's --------------------------------------------------------------------------------


@pytest.mark.parametrize("kinds", [(), ("gravity_sag", "joint_offset", "bar_gain"), tuple(MAKERS)[:6], tuple(OUTSIDE)])
def test_it_reads_what_the_rigs_plant_reads_cycle_by_cycle(kinds):
    plan = short_plan()
    draw = np.random.default_rng(5)
    tables = tuple(MECHANISMS[kind].model_validate(MAKERS[kind](draw)) for kind in kinds)
    truth = random_truth(2).model_copy(update={"mechanism": tables})
    fine = any(table.has_memory for table in tables)
    pace = SHORT_PACE if fine else Pace(10.0, 1, 2.0)
    machine = plan.machine_file()
    plant, readings = None, []
    for stretch in Timeline(plan, machine, pace.rate_hz, pace.instants_per_sample, pace.travel_s).stretches():
        motion = stretch.motion if isinstance(stretch, Arc) else stretch
        if plant is None:
            plant = Plant(truth.true_machine(machine), stretch.nominal.position_mm[0], stretch.nominal.rotation[0])
            plant.time_s = -motion.dt_s
        if not fine and motion.time_s[0] > 0.0:
            # Without memory nothing happens on the way, and no instants of it are made.
            plant.time_s = float(motion.time_s[0]) - motion.dt_s
            plant.poses = stretch.nominal.at(slice(0, 1))
        for row, drive in enumerate(motion.drive_mm):
            plant.step(drive, motion.dt_s, stretch.mounted if isinstance(stretch, Arc) else None)
            if isinstance(stretch, Arc) and row in stretch.samples:
                readings.append(plant.reading_mm(stretch.mounted))
    np.testing.assert_allclose(true_readings_mm(truth, plan, pace), readings, rtol=0, atol=1e-9)


def test_a_late_gauge_shows_what_is_true_later():
    plan, truth = short_plan(), random_truth(4)
    on_time = simulate(truth, plan, pace=Pace(100.0, 1, 2.0)).columns["t_s"]
    late = truth.model_copy(update={"mechanism": (MECHANISMS["sample_delay"].model_validate({"delay_ms": 30.0}),)})
    pace = Pace(100.0, 4, 2.0)
    shown, true = true_readings_mm(late, plan, pace), true_readings_mm(truth, plan, pace)
    first_sweep = np.arange(len(on_time) // 2 - 3)
    np.testing.assert_allclose(shown[first_sweep], true[first_sweep + 3], atol=1e-9)


# --- the record ---------------------------------------------------------------------------------------------------


def test_a_record_has_what_the_plan_asks_for_with_noise_and_rounding():
    plan, truth = short_plan(laps=2), random_truth(7)
    record = simulate(truth, plan, pace=Pace(40.0, 1, 2.0), temperature=True)
    columns, lap_s = record.columns, 2.0 * np.pi * 100.0 / 50.0
    assert len(record) == pytest.approx(2 * 2 * lap_s * 40.0, abs=2)
    assert [columns["direction"][rows[0]] for rows in record.sweeps()] == [-1, 1]
    for rows in record.sweeps():
        assert columns["angle_deg"][rows[0]] == 0.0
        assert set(columns["lap"][rows]) == {0, 1}
        turned = np.unwrap(np.radians(columns["angle_deg"][rows])) * columns["direction"][rows]
        np.testing.assert_allclose(np.diff(turned), 50.0 / 100.0 / 40.0, rtol=1e-9)
        np.testing.assert_allclose(np.diff(columns["t_s"][rows]), 1.0 / 40.0, rtol=1e-9)
    assert np.all(np.diff(columns["t_s"]) > 0.0)
    noise_um = columns["reading_um"] - 1e3 * true_readings_mm(truth, plan, Pace(40.0, 1, 2.0))
    assert np.std(noise_um) == pytest.approx(truth.gauge.noise_um, rel=0.1)
    np.testing.assert_allclose(columns["reading_um"] / 0.1, np.round(columns["reading_um"] / 0.1), atol=1e-6)
    np.testing.assert_allclose(record.sliders_mm * 1e4, np.round(record.sliders_mm * 1e4), atol=1e-6)
    assert np.std(columns["temperature_c"]) == pytest.approx(0.02, rel=0.2)
    assert not np.array_equal(columns["reading_um"], simulate(truth, plan, 8, Pace(40.0, 1, 2.0)).columns["reading_um"])


def test_the_nominal_machine_reads_nothing_and_drives_where_the_inverse_kinematics_says():
    plan = short_plan()
    assert np.abs(true_readings_mm(TruthFile(), plan, SHORT_PACE)).max() < 1e-9
    record, machine = simulate(TruthFile(), plan, pace=SHORT_PACE), plan.machine_file()
    circle, mount = plan.circles[0], plan.mounts[0]
    angle = np.radians(record.columns["angle_deg"])
    expected = true_geometry(machine).sliders_for(
        circle.poses(angle, mount.cup_mm), np.broadcast_to(_rotation(circle.platform_rpy_deg[0]), (len(angle), 3, 3))
    )
    np.testing.assert_allclose(record.sliders_mm, expected, atol=0.5e-4 + 1e-9)


def _rotation(roll_deg: float) -> np.ndarray:
    c, s = np.cos(np.radians(roll_deg)), np.sin(np.radians(roll_deg))
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def test_a_reading_beyond_the_gauge_is_refused():
    far = TruthFile.model_validate({"schema": "hexdbb.truth/1", "setup": {"cup_error_um": [[1500.0, 0.0, 0.0]]}})
    with pytest.raises(InputError, match=r"sweep 0: reading of 1\d\d\d µm \(expected within 1000 µm\)"):
        simulate(far, short_plan(), pace=SHORT_PACE)


def test_instants_between_samples_change_nothing_without_memory_and_little_with_it():
    plan, machine = short_plan(), random_truth(3)
    play = MECHANISMS["backlash"].model_validate({"slider": 4, "width_um": 15.0})
    wave = MECHANISMS["pitch_cyclic"].model_validate({"slider": 4, "amplitude_um": 5.0})
    for table, differs_um in ((wave, 1e-9), (play, 0.1)):
        truth = machine.model_copy(update={"mechanism": (table,)})
        coarse, fine = (true_readings_mm(truth, plan, Pace(10.0, n, 2.0)) * 1e3 for n in (10, 40))
        assert np.abs(coarse - fine).max() < differs_um


# --- sizes --------------------------------------------------------------------------------------------------------


def test_geometry_and_set_up_leave_no_signature_of_their_own():
    """A fault that geometry or set-up can imitate is found to be invisible, not merely small."""
    plan, pace, machine = discovery_plan(), Pace(2.0, 1, 10.0), random_truth(1)
    absorbed = MECHANISMS["ball_eccentricity"].model_validate({"offset_um": [10.0, 5.0, -5.0]})
    left_um = signature_um(absorbed, machine, plan, pace)
    alike = MECHANISMS["ball_eccentricity"].model_validate({"offset_um": [10.0, 5.0, -5.0], "circle": 2})
    assert left_um < 0.02, "what is left is of second order"
    assert signature_um(alike, machine, plan, pace) > 0.5
    with pytest.raises(ValueError, match="bar_drift: geometry and set-up absorb it"):
        sized(MECHANISMS["bar_drift"].model_validate({"rate_um_min": 0.0}), machine, plan, pace, 3.0)


@pytest.mark.parametrize(
    ("kind", "key", "expected"),
    [("backlash", "width_um", 15.0), ("pitch_cyclic", "amplitude_um", 10.0), ("gravity_sag", "compliance_um_n", 0.42)],
)
def test_sizes_of_three_times_the_noise_are_those_computed_when_the_plan_was_designed(kind, key, expected):
    hidden = Case((kind,), 3.0, 1).hidden[0]
    assert getattr(hidden.mechanism, key) == pytest.approx(expected, rel=0.1)


@pytest.mark.parametrize("name", ["backlash-x10-s1", "servo_lag-x1-s2", "leg_thermal-x10-s3", "dent-x3-s4"])
def test_a_case_shows_as_much_as_its_name_says(name):
    each = case(name)
    machine = random_truth(each.seed)
    shown_um = signature_um(each.hidden[0].mechanism, machine, each.plan, PACE)
    assert shown_um == pytest.approx(each.times_noise * machine.gauge.noise_um, rel=0.01)


# --- cases --------------------------------------------------------------------------------------------------------


def test_every_kind_is_drawn_and_every_effect_of_the_catalogue_has_its_mechanism():
    assert set(MAKERS) == set(MECHANISMS)
    assert {each.kinds for each in alone()} == {(kind,) for kind in CATALOGUED}
    assert all(not each.kinds for each in clean())
    everything = len(CATALOGUED) * (len(CATALOGUED) - 1) // 2
    assert len(list(pairs())) == everything - len(PLANS) * (len(PLANS) - 1) // 2
    assert set(PLANS) <= set(CATALOGUED)


def test_names_tell_cases():
    for each in every():
        assert case(each.name) == each


@pytest.mark.parametrize("name", ["backlash", "gremlin-x3-s1", "none-x3-s1", "backlash-x3-s1 ", "+backlash-x3-s1"])
def test_a_name_that_tells_no_case_is_refused(name):
    with pytest.raises(InputError, match=r"^case "):
        case(name)


def test_a_case_is_its_seeds():
    one, other = case("screw_thermal-x3-s5"), case("screw_thermal-x3-s5")
    assert one.truth == other.truth
    np.testing.assert_array_equal(one.record().columns["reading_um"], other.record().columns["reading_um"])
    assert one.hidden[0].element == one.hidden[0].mechanism.model_dump()["slider"]
    assert case("screw_thermal-x3-s6").truth != one.truth
    pair = case("backlash+bar_drift-x3-s5")
    assert [each.kind for each in pair.hidden] == ["backlash", "bar_drift"]
    assert pair.hidden[0] == case("backlash-x3-s5").hidden[0]
    assert pair.catalogued and not case("dent-x3-s5").catalogued


def test_a_warm_machine_and_its_thermometer_go_together_and_others_only_carry_one():
    warm, cold = case("leg_thermal-x3-s5"), case("none-s5")
    share = -np.expm1(-warm.record().columns["t_s"] / warm.hidden[0].mechanism.model_dump()["time_constant_s"])
    np.testing.assert_allclose(warm.record().columns["temperature_c"], 20.0 + 2.0 * share, atol=0.15)
    np.testing.assert_allclose(cold.record().columns["temperature_c"], 20.0, atol=0.15)
    assert "temperature_c" not in case("none-s6").record().columns


def test_cases_are_written_for_strangers_and_for_the_rig(tmp_path):
    name = "pitch_cyclic-x3-s2"
    done = CliRunner().invoke(main, [name, "-o", str(tmp_path), "--temperature"])
    assert done.exit_code == 0, done.output
    assert 'kind = "pitch_cyclic"' in done.output
    record = read_record(tmp_path / f"{name}.csv")
    expected = case(name).record(temperature=True)
    np.testing.assert_array_equal(record.columns["reading_um"], expected.columns["reading_um"])
    np.testing.assert_array_equal(record.sliders_mm, expected.sliders_mm)
    assert set(record.columns) >= {"temperature_c", *SLIDER_COLUMNS}
    assert load_toml(tmp_path / f"{name}.truth.toml", TruthFile) == case(name).truth
    refused = CliRunner().invoke(main, ["gremlin-x1-s1", "-o", str(tmp_path)])
    assert refused.exit_code == 2
    assert "gremlin" in refused.output


# --- a machine that does not repeat -------------------------------------------------------------------------------


def test_laps_repeat_and_runs_do_not():
    """Twice the same circle: within a run every lap reads the same, from run to run the sliders stand elsewhere."""
    plan = short_plan(laps=2, directions=(1, 1))
    truth = TruthFile().model_copy(update={"mechanism": (Approach(sigma_um=5.0, seed=3),)})
    # A lap of 4 pi s, cut so that both have samples at the same angles.
    readings_um = 1e3 * true_readings_mm(truth, plan, Pace(rate_hz=100.0 / (4.0 * np.pi), instants_per_sample=1))
    runs = readings_um.reshape(2, 2, 100)
    np.testing.assert_allclose(runs[:, 0], runs[:, 1], atol=1e-6)
    assert 1.0 < np.abs(runs[0, 0] - runs[1, 0]).max() < 50.0
    other = truth.model_copy(update={"mechanism": (Approach(sigma_um=5.0, seed=4),)})
    pace = Pace(rate_hz=100.0 / (4.0 * np.pi), instants_per_sample=1)
    assert not np.allclose(1e3 * true_readings_mm(other, plan, pace), readings_um, atol=0.1)


def test_the_nominal_machines_ball_is_where_it_is_commanded():
    machine = discovery_plan().machine_file()
    position, rpy = np.array([[10.0, -20.0, 280.0], [0.0, 30.0, 275.0]]), np.array([[0.1, 0.0, -0.1], [0.0, 0.05, 0.0]])
    ball = (1.0, 2.0, 60.0)
    expected = position + np.array([rotation_rpy(*each) for each in rpy]) @ ball
    np.testing.assert_allclose(true_balls_mm(TruthFile(), machine, position, rpy, ball), expected, atol=1e-9)
    moved = TruthFile.model_validate({"schema": "hexdbb.truth/1", "setup": {"ball_offset_error_um": [0.0, 0.0, 50.0]}})
    shift = true_balls_mm(moved, machine, position, rpy, ball) - expected
    np.testing.assert_allclose(np.linalg.norm(shift, axis=1), 0.05, atol=1e-9)
