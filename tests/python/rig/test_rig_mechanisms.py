"""Mechanisms of the true machine: each follows its physics, at its ports, in stretches of any length."""

from __future__ import annotations

import math
import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hexdbb.files.validation import dump_toml
from hexdbb.machine import shipped_machine
from hexdbb.rig.geometry import rotation_rpy, true_geometry
from hexdbb.rig.mechanisms import CATALOGUED, MECHANISMS, OUTSIDE, MechanismTable, Motion, Push
from hexdbb.rig.mechanisms.guideway import arc
from hexdbb.rig.mechanisms.transmission import PlayOperator
from hexdbb.rig.plant import Machine, Mounted, Plant, SetupErrors
from hexdbb.rig.pose_solver import Hexapod, Poses, leg_forces_n
from hexdbb.rig.truth import GaugeTruth, random_truth

MACHINE = shipped_machine()
PERFECT = SetupErrors({}, (0.0, 0.0, 0.0), 0.0)
HOME = np.array([0.0, 0.0, 280.0])
DT_S = 0.004
MIDDLE_MM = sum(MACHINE.sliders.travel_mm) / 2.0
PORTS = ("slider_mm", "leg_mm", "slider_joint_mm", "platform_joint_mm", "ball_mm", "cup_mm", "reading_mm", "gain")

SOME: dict[str, dict[str, object]] = {
    "backlash": {"slider": 3, "width_um": 8.0},
    "reversal_spike": {"slider": 3, "breakaway_um": 6.0},
    "pitch_cyclic": {"slider": 3, "amplitude_um": 3.0, "second_amplitude_um": 1.0},
    "lead_error": {"slider": 3, "error_um_m": 40.0},
    "straightness": {"guideway": 2, "lateral_um": 20.0, "vertical_um": -30.0},
    "servo_lag": {"slider": 3, "lag_ms": 0.5},
    "leg_thermal": {"growth_um": 15.0},
    "screw_thermal": {"slider": 3, "growth_um_m": 60.0},
    "gravity_sag": {"compliance_um_n": 0.2},
    "joint_offset": {"leg": 3, "offset_um": [10.0, 0.0, -5.0]},
    "bar_drift": {"rate_um_min": 0.5},
    "bar_gain": {"error_percent": 0.5},
    "sample_delay": {"delay_ms": -1.0},
    "ball_eccentricity": {"offset_um": [5.0, 1.0, 0.0], "mount": 0},
    "dent": {"guideway": 2, "depth_um": 20.0, "at_mm": 300.0, "width_mm": 20.0},
    "mains_pickup": {"amplitude_um": 1.0, "frequency_hz": 49.9},
    "loose_cup": {"shift_um": [10.0, 0.0, 0.0], "at_s": 0.5},
    "stick_slip": {"slider": 3, "tooth_um": 8.0, "duration_s": 5.0, "below_mm_min": 9000.0},
    "guideway_bend": {"guideway": 2, "vertical_um": 25.0},
    "encoder_interpolation": {"slider": 3, "amplitude_um": 0.5},
}
"""One of each kind."""


def table(kind: str, **changed: object) -> MechanismTable:
    return MECHANISMS[kind].model_validate({**SOME[kind], **changed})


def motion_of(slider_mm: np.ndarray, slider: int = 3, dt_s: float = DT_S) -> Motion:
    """One slider (from 1) moves, the others stand in the middle."""
    drive = np.full((len(slider_mm), 6), MIDDLE_MM)
    drive[:, slider - 1] = slider_mm
    return Motion(dt_s * np.arange(len(slider_mm)), dt_s, drive, mount=0, circle=0)


def swing(n: int = 400) -> Motion:
    """There and back and there again: two reversals."""
    return motion_of(300.0 + 20.0 * np.sin(np.linspace(0.0, 7.0, n)))


def acted(mechanism: MechanismTable, motion: Motion) -> Push:
    push = Push(len(motion.time_s))
    mechanism.start(MACHINE).act(motion, push)
    return push


def slider_um(mechanism: MechanismTable, motion: Motion) -> np.ndarray:
    push = acted(mechanism, motion)
    assert np.count_nonzero(np.delete(push.slider_mm, 2, axis=1)) == 0, "no other slider than the third"
    return push.slider_mm[:, 2] * 1e3


def test_there_is_one_of_each_kind_here_and_none_is_both_in_the_catalogue_and_outside():
    assert list(SOME) == list(MECHANISMS) == [*CATALOGUED, *OUTSIDE]


@pytest.mark.parametrize("kind", SOME)
def test_it_does_the_same_however_time_is_cut_into_stretches(kind):
    motion, mechanism = swing(), table(kind).start(MACHINE)
    whole, at_once = Push(400), table(kind).start(MACHINE)
    at_once.act(motion, whole)
    for rows in (slice(0, 1), slice(1, 130), slice(130, 131), slice(131, 399), slice(399, 400)):
        push = Push(rows.stop - rows.start)
        mechanism.act(Motion(motion.time_s[rows], DT_S, motion.drive_mm[rows], 0, 0), push)
        for port in PORTS:
            np.testing.assert_allclose(getattr(push, port), getattr(whole, port)[rows], rtol=0, atol=1e-13)


@pytest.mark.parametrize("kind", SOME)
def test_it_acts_and_without_size_it_does_not(kind):
    def largest(mechanism: MechanismTable) -> float:
        push = acted(mechanism, swing())
        ports = max(float(np.abs(getattr(push, port)).max()) for port in PORTS)
        return max(ports, float(push.compliance_mm_n.max()), abs(push.delay_s))

    assert largest(table(kind)) > 1e-7
    assert largest(table(kind).scaled(0.0)) == 0.0


@pytest.mark.parametrize("kind", SOME)
def test_scaling_multiplies_the_size_and_leaves_the_rest(kind):
    one, three = table(kind), table(kind).scaled(3.0)
    for key, value in one.model_dump().items():
        times = 3.0 if key in one.sizes else None
        expected = value if times is None else np.multiply(value, times)
        assert getattr(three, key) == expected if times is None else np.allclose(getattr(three, key), expected)
    assert one.sizes and f'kind = "{kind}"' in dump_toml(three)


@given(st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=60), st.floats(0.001, 0.3))
def test_play_stays_within_its_width_and_moves_only_when_pushed(path, width):
    push, motion = Push(len(path)), motion_of(np.array(path))
    PlayOperator(2, width).act(motion, push)
    drive, slider = np.array(path), np.array(path) + push.slider_mm[:, 2]
    assert np.abs(slider - drive).max() <= width / 2.0 + 1e-12
    moved = np.flatnonzero(np.abs(np.diff(slider)) > 1e-12)
    assert np.all(np.sign(np.diff(slider)[moved]) == np.sign(np.diff(drive)[moved]))
    np.testing.assert_allclose(np.abs(slider - drive)[moved + 1], width / 2.0, atol=1e-12)


def test_play_has_memory_that_a_function_of_position_cannot_have():
    displaced = slider_um(table("backlash", width_um=10.0), motion_of(np.array([0.0, 0.1, 0.2, 0.1, 0.0])))
    assert displaced == pytest.approx([0.0, -5.0, -5.0, 5.0, 5.0])


def test_lag_at_even_speed_is_speed_times_time_constant_and_dies_out_at_rest():
    speed_mm_s, lag_s = 50.0, 0.02
    path = np.concatenate([speed_mm_s * DT_S * np.arange(100), np.full(50, speed_mm_s * DT_S * 99)])
    displaced = slider_um(table("servo_lag", lag_ms=lag_s * 1e3), motion_of(path))
    assert displaced[99] == pytest.approx(-speed_mm_s * lag_s * 1e3, rel=1e-6)
    assert displaced[110] / displaced[100] == pytest.approx(math.exp(-10 * DT_S / lag_s))


def test_stiction_holds_the_slider_at_a_reversal_then_lets_it_go():
    path = np.concatenate([0.001 * np.arange(50), 0.049 - 0.001 * np.arange(1, 100)])
    displaced = slider_um(table("reversal_spike", breakaway_um=6.0, decay_s=0.1), motion_of(path))
    assert np.all(displaced[:50] == 0.0), "the first motion is no reversal"
    stands = path[50:55] * 1e3 + displaced[50:55]
    np.testing.assert_allclose(stands, 49.0, atol=1e-9)
    assert displaced.max() == pytest.approx(6.0)
    release = int(np.argmax(displaced))
    after = displaced[release : release + 20]
    np.testing.assert_allclose(after, 6.0 * np.exp(-DT_S / 0.1 * np.arange(20)), rtol=1e-9)


def test_a_slider_that_turns_back_before_it_breaks_away_is_wound_up_no_further():
    path = np.concatenate([np.linspace(0.0, 1.0, 20), np.linspace(1.0, 0.998, 5), np.linspace(0.998, 1.0, 5)])
    displaced = slider_um(table("reversal_spike", breakaway_um=6.0), motion_of(path))
    assert displaced[24] == pytest.approx(2.0)
    assert np.abs(displaced).max() < 2.1


def test_pitch_error_repeats_with_the_screw_and_has_both_harmonics():
    lead = MACHINE.sliders.screw_lead_mm
    position = 300.0 + lead * np.arange(64) / 32.0
    kwargs = {"amplitude_um": 3.0, "phase_deg": 30.0, "second_amplitude_um": 1.0, "second_phase_deg": -50.0}
    displaced = slider_um(table("pitch_cyclic", **kwargs), motion_of(position))
    np.testing.assert_allclose(displaced[:32], displaced[32:], atol=1e-9)
    amplitudes = np.abs(np.fft.rfft(displaced[:32])) / 16.0
    np.testing.assert_allclose(amplitudes[1:4], [3.0, 1.0, 0.0], atol=1e-9)
    assert displaced[0] == pytest.approx(3.0 * math.sin(math.radians(30.0)) - math.sin(math.radians(50.0)), abs=1e-9)


def test_lead_and_warm_screw_are_right_where_they_are_held():
    at = np.array([MIDDLE_MM, MIDDLE_MM + 100.0])
    assert slider_um(table("lead_error", error_um_m=40.0), motion_of(at)) == pytest.approx([0.0, 4.0])
    late = Motion(np.full(2, 1e9), DT_S, motion_of(at).drive_mm)
    held = {"growth_um_m": 60.0, "held_at_mm": MIDDLE_MM - 100.0}
    assert slider_um(table("screw_thermal", **held), late) == pytest.approx([6.0, 12.0])


@settings(max_examples=50)
@given(st.floats(-3.0, 3.0).filter(lambda height: abs(height) > 1e-6))
def test_bow_is_an_arc_of_a_circle_through_the_ends_of_travel(height):
    low, high = MACHINE.sliders.travel_mm
    at = np.linspace(low, high, 9)
    bow = arc(height, (low, high))(at)
    assert bow[[0, 4, 8]] == pytest.approx([0.0, height, 0.0], abs=1e-9)
    radius = ((high - low) ** 2 / 4.0 + height**2) / (2.0 * height)
    np.testing.assert_allclose(np.hypot(at - MIDDLE_MM, bow - (height - radius)), abs(radius), rtol=1e-12)


def test_bow_and_dent_displace_the_joints_of_both_sliders_of_the_guideway_across_it():
    motion = motion_of(np.array([MIDDLE_MM]))
    joints = acted(table("straightness", lateral_um=20.0, vertical_um=-30.0), motion).slider_joint_mm[0] * 1e3
    across = [20.0 * math.cos(math.radians(120)), 20.0 * math.sin(math.radians(120)), -30.0]
    np.testing.assert_allclose(joints[2:4], [across, across], atol=1e-9)
    assert np.count_nonzero(np.delete(joints, [2, 3], axis=0)) == 0
    passing = motion_of(np.array([250.0, 300.0, 304.0]))
    dip = acted(table("dent", width_mm=4.0, depth_um=20.0, at_mm=300.0), passing).slider_joint_mm[:, 2, 2] * 1e3
    assert dip == pytest.approx([0.0, -20.0, -20.0 * math.exp(-0.5)], abs=1e-9)


def test_bodies_warm_with_their_time_constant_and_the_thermometer_tells():
    motion = Motion(np.array([0.0, 1800.0, 1e9]), DT_S, np.full((3, 6), MIDDLE_MM))
    push = acted(table("leg_thermal", growth_um=15.0, rise_c=2.0, time_constant_s=1800.0), motion)
    share = [0.0, 1.0 - math.exp(-1.0), 1.0]
    np.testing.assert_allclose(push.leg_mm * 1e3, np.outer(np.multiply(share, 15.0), np.ones(6)), atol=1e-12)
    assert push.temperature_c == pytest.approx(np.multiply(share, 2.0))
    assert not acted(table("bar_drift"), motion).temperature_c.any()


def test_stick_slip_bursts_in_its_window_and_below_its_speed_only():
    path = 0.02 * np.arange(1000)
    burst = {"begin_s": 1.0, "duration_s": 1.0, "way_mm": 0.5, "tooth_um": 8.0, "below_mm_min": 400.0}
    displaced = slider_um(table("stick_slip", **burst), motion_of(path))
    inside = np.flatnonzero(displaced)
    assert inside.min() >= 250 and inside.max() < 500
    assert displaced.min() == pytest.approx(-8.0, abs=0.5)
    jumps = np.flatnonzero(np.diff(displaced[250:500]) > 4.0)
    assert np.all(np.diff(jumps) == 25), "a tooth each 0.5 mm"
    assert not slider_um(table("stick_slip", **burst), motion_of(2.0 * path)).any()


def test_measuring_side():
    motion = Motion(np.array([0.0, 60.0]), DT_S, np.full((2, 6), MIDDLE_MM), mount=1, circle=4)
    assert acted(table("bar_drift", rate_um_min=0.5), motion).reading_mm == pytest.approx([0.0, 5e-4])
    quarter = Motion(np.array([0.0, 0.005]), 0.005, motion.drive_mm)
    pickup = acted(table("mains_pickup", amplitude_um=1.0, frequency_hz=50.0), quarter)
    assert pickup.reading_mm == pytest.approx([0.0, 1e-3])
    cup = acted(table("loose_cup", shift_um=[10.0, 0.0, 0.0], at_s=30.0), motion).cup_mm
    np.testing.assert_allclose(cup, [[0.0, 0.0, 0.0], [0.01, 0.0, 0.0]])
    for where, there in (({}, True), ({"mount": 1}, True), ({"mount": 0}, False), ({"mount": 1, "circle": 3}, False)):
        ball = acted(MECHANISMS["ball_eccentricity"].model_validate({"offset_um": [5.0, 0, 0], **where}), motion)
        assert ball.ball_mm.any() == there


# --- in the machine -------------------------------------------------------------------------------------------------


def machine_with(*tables: MechanismTable) -> Machine:
    return Machine(true_geometry(MACHINE), PERFECT, [each.start(MACHINE) for each in tables])


def stood(machine: Machine, position: np.ndarray = HOME, rotation: np.ndarray | None = None) -> Plant:
    rotation = np.eye(3) if rotation is None else rotation
    plant = Plant(machine, position, rotation)
    plant.step(true_geometry(MACHINE).sliders_for(position, rotation), DT_S)
    return plant


@settings(max_examples=30, deadline=None)
@given(
    st.tuples(*[st.floats(-60.0, 60.0)] * 2).map(lambda xy: HOME + np.array([*xy, 0.0])),
    st.tuples(*[st.floats(-0.15, 0.15)] * 3),
)
def test_legs_carry_the_weight_and_no_moment(position, rpy):
    geometry, rotation = true_geometry(MACHINE), rotation_rpy(*rpy)
    joints = geometry.slider_joints_mm(geometry.sliders_for(position, rotation))
    hexapod = Hexapod(joints[None], geometry.joints_mm[None], geometry.lengths_mm[None])
    forces = leg_forces_n(hexapod, Poses(position[None], rotation[None]), geometry.weight_n)[0]
    arms = geometry.joints_mm @ rotation.T
    thrusts = forces[:, None] * (arms + position - joints) / geometry.lengths_mm[:, None]
    np.testing.assert_allclose(thrusts.sum(axis=0), [0.0, 0.0, 12.0 * 9.80665], atol=1e-9)
    np.testing.assert_allclose(np.cross(arms, thrusts).sum(axis=0), 0.0, atol=1e-7)


def test_sag_of_the_centred_platform_is_that_of_six_equal_springs():
    compliance_mm_n = 0.5e-3
    plant = stood(machine_with(table("gravity_sag", compliance_um_n=0.5)))
    geometry = true_geometry(MACHINE)
    joints = geometry.slider_joints_mm(geometry.sliders_for(HOME, np.eye(3)))
    rise = (HOME[2] + MACHINE.platform.joint_plane_height_mm - joints[0, 2]) / MACHINE.legs.length_mm
    force = geometry.weight_n / 6.0 / rise
    drop = plant.poses.position_mm[0] - HOME
    np.testing.assert_allclose(drop[:2], 0.0, atol=1e-9)
    assert drop[2] == pytest.approx(-compliance_mm_n * force / rise, rel=1e-3)
    np.testing.assert_allclose(plant.poses.rotation[0], np.eye(3), atol=1e-12)


def test_sag_is_in_balance():
    """Pose and forces agree: legs as long as the pose says are shorter by what their forces press."""
    rotation, compliance_mm_n = rotation_rpy(0.1, -0.1, 0.05), 0.5e-3
    position = HOME + np.array([40.0, -30.0, 0.0])
    plant = stood(machine_with(table("gravity_sag", compliance_um_n=0.5)), position, rotation)
    geometry = true_geometry(MACHINE)
    joints = geometry.slider_joints_mm(geometry.sliders_for(position, rotation))
    reach = plant.poses.rotation[0] @ geometry.joints_mm.T + plant.poses.position_mm[0][:, None] - joints.T
    lengths = np.linalg.norm(reach, axis=0)
    hexapod = Hexapod(joints[None], geometry.joints_mm[None], lengths[None])
    forces = leg_forces_n(hexapod, plant.poses, geometry.weight_n)[0]
    np.testing.assert_allclose(geometry.lengths_mm - lengths, compliance_mm_n * forces, atol=1e-9)


def test_joint_offsets_of_all_legs_alike_shift_the_platform_and_nothing_else():
    offsets = [table("joint_offset", leg=leg, offset_um=[10.0, -20.0, 5.0]) for leg in range(1, 7)]
    plant = stood(machine_with(*offsets))
    np.testing.assert_allclose(plant.poses.position_mm[0] - HOME, [-0.01, 0.02, -0.005], atol=1e-9)


def test_mechanisms_between_drive_and_slider_act_one_after_the_other():
    """Play behind a lag sees the lagging position: it turns over later than play alone."""
    lag, play = table("servo_lag", lag_ms=100.0), table("backlash", width_um=10.0)
    motion, both = swing(), Push(400)
    for each in (lag, play):
        each.start(MACHINE).act(motion, both)
    added = acted(lag, motion).slider_mm + acted(play, motion).slider_mm
    np.testing.assert_allclose(np.abs(both.slider_mm - acted(lag, motion).slider_mm).max(), 0.005, atol=1e-12)
    assert np.abs(both.slider_mm - added).max() == pytest.approx(0.01, abs=1e-3)


def read_at(plant: Plant, offset_mm: float) -> float:
    return plant.reading_mm(Mounted(0, (0.0, 0.0, 340.0), (0.0, 0.0, 60.0), 100.0 - offset_mm))


def test_gain_and_delay_in_the_reading():
    geometry = true_geometry(MACHINE)

    def after_two_cycles(*tables: MechanismTable) -> float:
        start = HOME + np.array([100.0, 0.0, 0.0])
        plant = Plant(machine_with(*tables), start, np.eye(3))
        for way in (0.0, 0.02):
            plant.step(geometry.sliders_for(start + np.array([way, 0.0, 0.0]), np.eye(3)), DT_S)
        return read_at(plant, 0.3)

    assert after_two_cycles() == pytest.approx(0.32, abs=1e-9)
    assert after_two_cycles(table("bar_gain", error_percent=0.5)) == pytest.approx(0.32 * 1.005, abs=1e-9)
    late, early = table("sample_delay", delay_ms=1.0), table("sample_delay", delay_ms=-1.0)
    assert after_two_cycles(late) == pytest.approx(0.325, abs=1e-9)
    assert after_two_cycles(early) == pytest.approx(0.315, abs=1e-9)


# --- on the bus -----------------------------------------------------------------------------------------------------

BALL_MM = (100.0, 0.0, 80.0)
"""With the cup at z 340 and the platform at 260, the bar lies flat."""


def test_mechanisms_act_on_the_bus_as_they_do_offline(start, tmp_path):
    """Play that turns over, sag, a joint and a ball out of place: what the gauge's frames say, cycle by cycle."""
    truth = random_truth(6).model_copy(
        update={
            "gauge": GaugeTruth(noise_um=0.0, resolution_um=0.0),
            "mechanism": tuple(
                table(kind, **({"width_um": 60.0} if kind == "backlash" else {}))
                for kind in ("gravity_sag", "joint_offset", "ball_eccentricity", "straightness", "backlash")
            ),
        }
    )
    path = tmp_path / "truth.toml"
    path.write_text(dump_toml(truth), encoding="utf-8")
    controller = start("--truth", str(path))
    controller.mount(ball_mm=BALL_MM)
    at = controller.ready()
    here = Plant(truth.true_machine(MACHINE), np.array(truth.start.position_mm), np.eye(3))
    mounted = Mounted(0, (0.0, 0.0, 340.0), BALL_MM, 100.0)
    shown_um, expected_um = [], []
    for step in range(160):
        way = 20 * min(step, 160 - step)
        answers = controller.cycle(0x0F, [count + way * (k == 2) for k, count in enumerate(at)])
        counts = [struct.unpack_from("<i", answers[node], 2)[0] for node in range(1, 7)]
        here.step(np.array(counts) / MACHINE.can_setup.counts_per_mm, DT_S, mounted)
        expected_um.append(here.reading_mm(mounted) * 1e3)
        shown_um.append(struct.unpack("<fB", answers[7])[0])
    np.testing.assert_allclose(shown_um, expected_um, atol=0.2, err_msg="encoders tell tenths of a micrometre")
    # With 60 um of play, the way back starts where the way there has ended.
    assert np.ptp(shown_um[80:90]) < 1.0 < np.ptp(shown_um[60:75])
