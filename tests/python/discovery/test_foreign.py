"""Records of simulators that share nothing with the project: forms like the catalogue's, not equal to them.

`tests/data/foreign`: standard circles, two feeds, both directions, 0.5 µm noise, random geometry, one fault each; and
of another simulator, on plans and with noise of its own, what once went wrong. Asked is what a fitter needs: the right
class of verdict, the right place, no value that physics excludes.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.discovery import Discovery, discover
from hexdbb.kinematics import engine_machine
from hexdbb.model import new_model
from hexdbb.plots.analysis_pages import discovery_pages
from hexdbb.record import read_record
from hexdbb.samples import Samples

FOREIGN = Path(__file__).parents[2] / "data" / "foreign"
TRUTH = {
    "sag-10x": "gravity_sag",
    "bow-10x": "straightness:1",
    "bow-small": "straightness:1",
    "joint-friction-3x": "joint_friction:5",
    "joint-friction-10x": "joint_friction:2",
}
NUMBERS = {"rail-warms": 470.4, "fan-cools": 16.0, "nut-heats": 304.0, "cover-jams": 2.5}
NUMBERS |= {"legs-breathe": 702.0, "nut-lifts": 190.0, "motor-heats-foot": 94.6, "end-heats-leg": 18.26}
NUMBERS |= {"clamp-leaks": 20.432, "column-sways": 430.0, "mains-hums": 1.0 / 49.963, "post-shakes": 1.0 / 4.63}
"""True value of the number in the name of the cause, by record: s or mm."""
DIRECTION_DEG = {"hose-pulls": (40.1, 3.0), "foot-rocks": (70.0, 1.0), "foot-tips": (110.5, 3.0)}
"""The same of a direction, and how near: the hose's pull turns with the platform, which no function has, and which
moves the best direction by two degrees, a fifteenth of what lies between two that are tried."""


@lru_cache
def samples_of(name: str) -> Samples:
    return Samples.of([read_record(FOREIGN / f"{name}.parquet")])


@lru_cache
def found_in(name: str) -> Discovery:
    samples = samples_of(name)
    return discover(samples, new_model(samples.machine))


@pytest.mark.parametrize("name", sorted(set(TRUTH) - {"bow-small"}))
def test_the_main_cause_is_named_however_far_its_form_is_from_the_catalogues(name: str) -> None:
    found = found_in(name)
    assert found.best is not None and found.best.choice == TRUTH[name]
    assert found.verdict == "effect"
    assert found.best.share > 0.95
    assert {"circle", "feed", "direction"} <= found.heldout.keys()
    assert all(each.after_um < 0.5 * each.before_um for each in found.heldout.values())


def test_a_fault_of_half_the_noise_is_named_or_left_open_and_never_called_otherwise() -> None:
    found = found_in("bow-small")
    assert TRUTH["bow-small"] in [name for each in found.candidates for name in each.names]
    named = {each.choice for each in found.causes if each.verdict in ("effect", "ambiguous")}
    assert named <= {TRUTH["bow-small"]}


@pytest.mark.parametrize("name", sorted(TRUTH))
def test_no_value_is_impossible(name: str) -> None:
    found = found_in(name)
    machine = engine_machine(samples_of(name).machine)
    for cause in found.causes:
        if not cause.values:
            continue
        lower = {each.name: each.lower for each in _core.effect_info(machine, 1, cause.effect).parameters}
        assert all(each.value >= 0.0 or lower[each.name] < 0.0 for each in cause.values)


@pytest.mark.parametrize(
    ("name", "first"), [("bow-10x", 0), ("sag-10x", 0), ("joint-friction-10x", 0), ("joint-friction-3x", 13)]
)
def test_five_hundred_readings_are_enough_to_name_it(name: str, first: int) -> None:
    """Then a variable of all legs may have too few values at one of them, and friction's sign no reading between."""
    record = read_record(FOREIGN / f"{name}.parquet")
    samples = Samples.of([record.part(np.arange(len(record)) % 40 == first)])
    found = discover(samples, new_model(samples.machine))
    assert [each.choice for each in found.causes] == [TRUTH[name]]
    assert found.verdict in ("effect", "ambiguous")


def test_with_the_true_effect_withheld_nothing_false_is_named() -> None:
    samples = samples_of("joint-friction-3x")
    others = [each for each in _core.effect_names("catalogue") if each != "joint_friction"]
    found = discover(samples, new_model(samples.machine), others)
    assert found.verdict in ("unknown", "ambiguous")
    assert found.causes[0].choice.startswith("learned:leg:5:")
    assert "leg 5" in found.sentence and "turning" in found.sentence
    assert found.structure or found.causes


@pytest.mark.long
def test_a_pitch_error_sampled_twice_a_turn_is_found_whole() -> None:
    """12,800 readings on a screw of 5 mm, which turns by half between them: thirty times the noise."""
    found = found_in("sparse-pitch")
    assert found.verdict == "effect"
    assert found.best is not None and found.best.choice == "pitch_cyclic:3"
    assert found.best.share > 0.9


@pytest.mark.long
def test_a_formula_that_explains_nearly_all_is_named_though_circles_hardly_hold_geometry() -> None:
    """Ten circles about three cups: functions of two screws together erred less there, and stood for a pitch error."""
    found = found_in("pitch-on-three-cups")
    assert (found.verdict, [each.choice for each in found.causes]) == ("effect", ["pitch_cyclic:1"])


@pytest.mark.long
def test_drives_that_lag_alike_are_one_cause_though_geometry_takes_most_of_their_lag() -> None:
    """Their form, half of what is seen of their sizes, was dropped; a joint's friction besides brought it back."""
    found = found_in("drives-lag")
    assert (found.verdict, [each.choice for each in found.causes]) == ("effect", ["servo_lag"])


@pytest.mark.long
def test_what_gives_way_to_fewer_faults_by_their_formulas_is_no_rival_of_them() -> None:
    """Six screws that warm, for a gauge that drifts: more evidence, by forms, and worse on all that was left out."""
    found = found_in("drift-and-spike")
    assert (found.verdict, {each.choice for each in found.causes}) == ("effect", {"bar_drift", "reversal_spike:6"})


@pytest.mark.long
def test_what_says_as_much_at_the_other_end_of_the_measuring_loop_is_named_too() -> None:
    """The cup's stand creeps along 58 degrees: a screw that cools by 30 kelvins was named for sure."""
    found = found_in("stand-creeps")
    assert found.verdict == "ambiguous"
    assert "learned:cup:time" in {name for each in found.causes for name in (each.choice, *each.rivals)}


@pytest.mark.long
def test_effects_that_nearly_cancel_are_no_causes_for_sure() -> None:
    """An arm of the platform warms: three screws, none of which is missed without, followed it by their forms."""
    found = found_in("platform-warms")
    assert found.verdict == "unknown"
    assert not [each for each in found.causes if each.verdict == "effect"]


def test_noise_that_lasts_for_some_readings_is_nothing_missing() -> None:
    """Each reading of single laps keeps half of the noise of the one before it."""
    assert found_in("lasting-noise").verdict == "none"


@pytest.mark.long
def test_what_circles_that_hardly_hold_geometry_predict_makes_nothing_sure() -> None:
    """A joint's ball with five lobes; centres off their places and a bow bend together to fit it."""
    found = found_in("joint-lobes")
    assert found.verdict in ("unknown", "ambiguous")
    assert not [each for each in found.causes if each.verdict == "effect"]


@pytest.mark.long
def test_what_is_seen_of_all_legs_is_how_they_differ() -> None:
    """Legs that grow, 18 % unequally: geometry takes what they do alike, and a guideway that grows said most of it."""
    found = found_in("legs-unequal")
    assert (found.verdict, [each.choice for each in found.causes]) == ("effect", ["leg_thermal"])


@pytest.mark.long
def test_a_fault_that_all_six_drives_share_is_one_cause() -> None:
    """All lag, alike but not the same; beside it play of one slider, of the same size."""
    found = found_in("lags-alike")
    assert found.verdict == "effect"
    assert {each.choice for each in found.causes} == {"servo_lag", "backlash:6"}
    (lag,) = [each for each in found.causes if each.choice == "servo_lag"]
    assert lag.elements == ("1", "2", "3", "4", "5", "6") and len(lag.values) == 6
    assert lag.clause.startswith("all 6 sliders: slider ") and "behind its drive's encoder, down to " in lag.clause


@pytest.mark.long
def test_what_is_small_beside_another_fault_is_no_form_of_it() -> None:
    """A pitch error of thirty times the noise that grows along the screw, and another screw that warms, of five."""
    found = found_in("unequal-pair")
    assert found.verdict == "effect"
    assert {each.choice for each in found.causes} == {"pitch_cyclic:3", "screw_thermal:4"}


@pytest.mark.long
def test_a_carriage_that_cocks_is_found_at_the_joint_of_its_slider() -> None:
    """Loose in its rail, it leans over a few millimetres after each reversal, and its joint goes sideways and up."""
    found = found_in("carriage-cocks")
    assert found.verdict == "unknown"
    assert [each.choice for each in found.causes] == ["learned:slider_joint:5:since_reversal_travel"]
    assert "joint of slider 5" in found.sentence and "reversal" in found.sentence
    assert all(each.after_um < 0.6 * each.before_um for each in found.heldout.values())


@pytest.mark.long
def test_a_gauge_that_sticks_is_found_by_its_way_since_it_turned() -> None:
    found = found_in("gauge-sticks")
    assert found.verdict == "unknown"
    assert [each.choice for each in found.causes] == ["learned:reading:deflection_since_turn"]


@pytest.mark.long
def test_screws_that_all_warm_are_one_cause() -> None:
    """A gauge that drifts and legs that grow fit three times the noise as well, each with a form of its own."""
    found = found_in("screws-alike")
    assert found.verdict == "effect"
    assert [each.choice for each in found.causes] == ["screw_thermal"]
    assert found.causes[0].elements == ("1", "2", "3", "4", "5", "6")


@pytest.mark.long
def test_screws_that_all_warm_are_not_for_sure_where_a_drift_fits_better() -> None:
    """A gauge that drifts, and a joint off its place by which geometry leads away: other circles refute little."""
    found = found_in("drift-and-joint")
    assert found.causes[0].choice == "joint_offset:4"
    for each in found.causes[1:]:
        assert each.choice == "bar_drift" or any("bar_drift" in rival for rival in each.rivals)


@pytest.mark.long
def test_leads_of_both_screws_of_a_guideway_are_two_leads() -> None:
    found = found_in("two-leads")
    assert found.verdict == "effect"
    assert {each.choice for each in found.causes} == {"lead_error:1", "lead_error:2"}


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "cause", "claimed"),
    [
        # Where one direction is left out, hardly any reading says how the gauge lags: a joint that turns over with the
        # direction, far behind in evidence, only expected to err there.
        ("gauge-hysteresis", "learned:reading:deflection_since_turn", {"circle", "feed", "lap"}),
        # Twenty-six lobes: a first fit leaves some of them, which was put down to both legs of the pair.
        ("joint-waves", "learned:leg:5:joint_angle", {"circle", "feed", "direction", "lap"}),
        # A dent, of which twelve splines say half: two bows and a third guideway stood before the leg. No circle is
        # asked of, since the others hardly hold geometry.
        ("dent-in-joint", "learned:leg:6:joint_angle", {"feed", "direction"}),
        # Disc springs that snap through at one force along the guideway and back at another: nothing predicted.
        ("spring-snaps", "learned:slider:6:drive_load_relay@", {"circle", "feed", "direction"}),
        # A lip that catches on the way up only: what is alike both ways and what turns over are one cause.
        ("lip-catches", "learned:slider:1:position_each_way", {"feed", "direction", "lap"}),
        # By 1 - exp(-t/470 s), the truth: three known effects, legs and two screws, explained as much.
        ("rail-warms", "learned:vertical:2:time_position_settling@", {"circle", "feed", "direction"}),
        # It pulls more with every turn, and the other way round in the other direction.
        ("cable-winds", "learned:reading:turned", {"circle", "feed"}),
        # A brake disc that rubs once a turn of the screw, against the travel: by no function of either alone.
        ("brake-rubs", "learned:slider:1:direction_screw_phase", {"circle", "direction", "lap"}),
        # The current of drive 4, by its friction, in the gauge's line: functions of all other places said it worse.
        ("ground-loop", "learned:reading:slider_4_velocity", {"circle", "feed", "direction", "lap"}),
        # Lobes of a platform joint's ball: a joint off its place left as little, with geometry far beyond its priors.
        ("lobed-joint", "learned:leg:6:platform_joint_angle", {"circle", "feed", "direction", "lap"}),
        # A feed-forward of the jerk: two functions of velocities and a lag of all drives stood in for it.
        ("jerk-forward", "learned:slider:3:jerk", {"circle", "direction"}),
        # An operator who takes the bar in hand where a circle begins: it was a gauge that drifts, or one that is read
        # otherwise in either direction.
        ("bar-in-hand", "learned:reading:time_in_circle", {"circle", "direction"}),
        # A carriage that rises as it floats on its oil again, alike at both ends of the travel.
        ("oil-film", "learned:slider_joint:2:since_reversal_travel_each_way", {"feed", "direction"}),
        # A threaded end that yields to the leg's force and slips: a joint's friction and the bar's angle stood in.
        # Circles were run up to along half a circle.
        ("loose-thread", "learned:leg:2:leg_force_slipping180", {"feed", "direction", "lap"}),
        # The inertia of one carriage moves another guideway along itself, both sliders alike: it was the cup.
        ("guideway-shakes", "learned:slider:5-6:slider_1_acceleration", {"circle", "feed", "direction"}),
        # A hose pulls the platform aside by elastic legs: a sag, a gain and joints off their places left as little.
        ("hose-pulls", "learned:load:position_along@", {"feed", "direction"}),
        # A cable dragged over a cover, tied beside the platform's middle: functions of the direction stood in.
        ("cable-drags", "learned:load:course", {"circle", "feed", "direction", "lap"}),
        # A fan cools the bar on one side of the circle: it was a function of time.
        ("fan-cools", "learned:reading:angle_lingering@", {"feed", "direction"}),
        # A nut that its own travel heats, and that cools between the sweeps: so was it.
        ("nut-heats", "learned:slider:3:velocity_lingering@", {"circle", "feed", "direction"}),
        # A cover between two carriages jams: it yields by 2.5 mm, then slips. It was the reversals of their joints.
        ("cover-jams", "learned:slider:5-6:gap_slipping@", {"circle", "feed", "direction"}),
        # Mains hum, seven times and thirty times as fast as readings are taken: a period of the gauge's scale stood in.
        ("mains-hums", "learned:reading:time_period@", {"circle", "feed", "direction", "lap"}),
        # Lobes of a ball in two angles, of which no function of one says half: two bows and a joint stood in.
        ("lobes-both-ways", "learned:leg:3:leg_in_platform", {"feed", "direction", "lap"}),
        # A bent screw that drags its carriage round, most in mid-travel: a pitch error, and one of nearly its period.
        ("screw-bent", "learned:slider_joint:6:screw_wave_position", {"circle", "feed", "direction", "lap"}),
        # A joint between two pieces of rail, 5 mm long: the joint of one slider in two directions stood in.
        ("rail-steps", "learned:vertical:3:fine_position", {"circle", "feed", "direction", "lap"}),
        # Ridges every 27 degrees, of which twelve splines leave more than a function of the distance of two carriages.
        ("socket-ridged", "learned:leg:2:joint_angle", {"circle", "feed", "direction", "lap"}),
        # The spindle sinks in its clamp as the platform tilts: two joints off their places, for sure.
        ("clamp-leans", "learned:ball:gravity_along@", {"circle", "feed", "direction", "lap"}),
        # A cable carrier that drags more the faster it is pulled: a load without the speed, and all sliders beside it.
        ("carrier-drags", "learned:load:course_speed", {"circle", "direction", "lap"}),
        # The air conditioning sways one column along its guideway: the cup repeats itself nearly as well.
        ("column-sways", "learned:slider:5-6:time_period@", {"circle", "feed", "direction", "lap"}),
        # A drive that cannot feed power back overshoots where it brakes: its load's changes and reversals stood in.
        ("brakes-overshoot", "learned:slider:5:direction_power", {"direction", "lap"}),
        # A gauge's plunger that sticks the more the deeper it goes: a cup that moves along three axes stood in.
        (
            "plunger-sticks",
            "learned:reading:deflection_since_turn_by_deflection",
            {"circle", "feed", "direction", "lap"},
        ),
        # Six legs that swing with the room, each by its own amount: the cup, in three directions, said most.
        ("legs-breathe", "learned:leg:each:time_period@", {"circle", "feed", "direction", "lap"}),
        # Six balls of thirteen lobes: no leg alone shows them, and with a dozen splines all six hardly do.
        ("balls-lobed", "learned:leg:each:joint_angle", {"circle", "feed", "direction", "lap"}),
        # A base that rocks as the platform passes a line: with few splines directions beside the true one fit best.
        ("foot-rocks", "learned:cup:position_along@", {"circle", "feed", "direction", "lap"}),
        # Drives that take the lead in turn, with a step between: the cup, along three axes, said as much.
        ("sectors-step", "learned:reading:fine_bar_azimuth", {"circle", "feed", "direction", "lap"}),
        # A cable that winds up and pulls the stand along one direction: the reading, by many values, said as much.
        ("cable-pulls", "learned:cup:turned", {"circle", "feed", "lap"}),
        # A nut whose heat lifts the carriage: a free function of time, of 320 splines, had more evidence than the law.
        ("nut-lifts", "learned:slider_joint:3:velocity_lingering@", {"circle", "feed", "direction", "lap"}),
        # A leg that turns in its thread as the platform circles: two functions of the reading said most of it.
        ("leg-unscrews", "learned:leg:5:turned", {"circle", "feed"}),
        # A motor heats the leg's foot by its own motion: a function of time, which says nothing of another time.
        ("motor-heats-foot", "learned:leg:5:velocity_lingering@", {"circle", "feed", "direction", "lap"}),
        # A leg that is warmed where its slider stands near the guideway's end: a load of the drive, as it was before.
        ("end-heats-leg", "learned:leg:5:position_lingering@", {"feed", "lap"}),
        # The ball's holder falls over as the platform tilts: a joint off its place, which settled it.
        ("holder-falls-over", "learned:ball:gravity_along@", {"feed", "direction", "lap"}),
        # A rail that rolls outward where its carriages come close: the same function along it said it nearly as well.
        ("rail-rolls", "learned:guideway:3:gap", {"circle", "feed", "direction", "lap"}),
        # A base that tips over a loose foot, and back later: two functions, of the cup and of the reading, said most.
        ("foot-tips", "learned:cup:position_along@", {"circle", "feed", "lap"}),
        # A clamp that leaks pushes one carriage sideways every 20 s: its leg said nine tenths of it.
        ("clamp-leaks", "learned:slider_joint:2:time_period@", {"circle", "feed", "direction", "lap"}),
        # Fourteen lobes of a joint's ball: a joint off its place, for sure, whose form described most of them.
        ("joint-flats", "learned:leg:2:platform_joint_angle", {"circle", "feed", "direction", "lap"}),
    ],
)
def test_the_place_and_the_variable_are_found_where_no_known_effect_is(
    name: str, cause: str, claimed: set[str]
) -> None:
    found = found_in(name)
    assert found.verdict == "unknown"
    (only,) = found.causes
    assert only.choice.startswith(cause)
    if name in NUMBERS:
        assert float(only.choice.partition("@")[2]) == pytest.approx(NUMBERS[name], rel=0.05)
    if name in DIRECTION_DEG:
        true_deg, near_deg = DIRECTION_DEG[name]
        assert float(only.choice.split("@")[1].partition("_")[0]) == pytest.approx(true_deg, abs=near_deg)
    assert all(found.heldout[each].after_um < 0.4 * found.heldout[each].before_um for each in claimed)


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "causes"),
    [
        # Waves of 1.8 degrees, of which twelve splines say nothing: a rail's fine form stood before the leg.
        ("fluted-and-lag", {"servo_lag:4", "learned:leg:1:joint_angle"}),
        # A cable that tugs where the bar points upward, and play: a function of the same slider stood before the play,
        # beside which nothing else was looked for.
        ("cable-beside-play", {"backlash:4", "learned:reading:bar_elevation"}),
        # A base that tips over one foot where the platform is beyond y = 28 mm: a bow explained 98 % beside the spikes.
        ("foot-lifts", {"reversal_spike:1", "learned:cup:position_along"}),
        # A coupling that slips three times explains 4,000 times the noise, of which its shape leaves 16; beside it legs
        # that sag explained less than the form of such an effect might hide.
        ("steps-and-sag", {"gravity_sag", "learned:slider:3:step"}),
        # A chip in the cup, and a stiction that stands at once: a reading or two at a reversal have it or not.
        ("spike-and-chip", {"reversal_spike:5", "learned:reading:fine_bar_azimuth"}),
        # A battery of the gauge that sags every 9.6 s explains less than a lag's form might hide, and is no form of it.
        # A gauge of another gain stood for it, which left most of it.
        ("battery-sags", {"servo_lag:3", "learned:reading:time_period"}),
        # The cage of a screw's bearing, whose period is no part of the lead's, and legs that grow.
        ("bearing-and-legs", {"leg_thermal", "learned:slider:1:fine_position"}),
    ],
)
def test_what_no_effect_says_is_found_beside_one(name: str, causes: set[str]) -> None:
    found = found_in(name)
    assert {each.choice.partition("@")[0] for each in found.causes} == causes


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "causes"),
    [
        # Two screws that whip, each at a speed of its own: the cup, by the platform's speed and the angle.
        ("screws-whip", {"learned:slider:3:velocity", "learned:slider:6:velocity"}),
        # A beam fell on two rails: a bow beside the other dent, of which its formula says nothing.
        ("two-dents", {"learned:vertical:2:position", "learned:lateral:1:position"}),
        # A lobed ball in the cup, a worn patch on the platform's: the platform's along three axes said as much.
        ("two-balls", {"learned:reading:bar_angle", "learned:reading:bar_azimuth"}),
        # Locknuts of two legs that slip, each at instants of its own: a screw that warms stood in for one.
        ("nuts-slip", {"learned:leg:3:time", "learned:leg:5:step"}),
    ],
)
def test_two_elements_with_functions_of_their_own_are_found_together(name: str, causes: set[str]) -> None:
    found = found_in(name)
    assert found.verdict == "unknown"
    named = (each.choice.partition("_turning@")[0].partition("@")[0] for each in found.causes)
    assert {each.replace("fine_", "") for each in named} == causes
    assert all(each.after_um < 0.2 * each.before_um for each in found.heldout.values())


def test_one_leg_that_gives_is_no_sag_of_all() -> None:
    """A weld of leg 3 is cracked: by its form, which has functions of each leg, the sag of all explains as much."""
    found = found_in("one-leg-yields")
    assert found.verdict == "unknown"
    (only,) = found.causes
    assert only.choice == "learned:leg:3:leg_force"
    assert not any("gravity_sag" in each for each in only.rivals)


def test_one_drive_that_lags_is_no_lag_of_all() -> None:
    """By the speed of all; five others that lag alike, as geometry imitates, fit better and predict worse."""
    found = found_in("bus-droops")
    assert (found.verdict, [each.choice for each in found.causes]) == ("effect", ["servo_lag:2"])
    assert not any("servo_lag" in each for each in found.causes[0].rivals)


@pytest.mark.long
def test_what_shakes_faster_than_readings_are_taken_is_found_where_it_shakes() -> None:
    """A compressor in the building sways the cup's post for some minutes at a time, at 4.63 Hz.

    A function of one period says what all of these bursts have in common.
    """
    found = found_in("post-shakes")
    assert found.verdict == "unknown"
    places = {each.choice.partition("@")[0] for each in found.causes}
    periods_s = [float(each.choice.partition("@")[2]) for each in found.causes]
    assert places == {"learned:cup:time_period"}
    assert periods_s == pytest.approx([NUMBERS["post-shakes"]] * len(periods_s), rel=1e-3)


@pytest.mark.long
def test_what_time_alone_says_better_is_no_screw_that_warms_for_sure() -> None:
    """A coupling that creeps at each reversal, beside legs that sag: by its form the screw leaves nearly as little."""
    found = found_in("coupling-creeps")
    assert found.verdict == "ambiguous"
    grades = {each.choice: each.verdict for each in found.causes}
    assert grades == {"screw_thermal:2": "ambiguous", "gravity_sag": "effect"}
    rivals = [rival for each in found.causes for rival in each.rivals]
    assert any("learned:slider:2:fine_time" in rival for rival in rivals)


def test_a_slider_that_reversed_along_the_run_up_had_its_spike() -> None:
    """It reverses a degree before the first reading of each circle; its stiction rings, legs sag."""
    found = found_in("sag-and-ripple")
    assert found.verdict == "effect"
    assert {each.choice for each in found.causes} == {"gravity_sag", "reversal_spike:3"}


def test_a_delay_that_scatters_is_a_delay() -> None:
    """By 12 % from sweep to sweep: functions of the path's direction and time describe what that leaves, too."""
    found = found_in("delay-scatters")
    assert found.verdict == "effect"
    assert [each.choice for each in found.causes] == ["sample_delay"]


@pytest.mark.long
def test_a_delay_that_swings_is_no_drives_that_lead_besides() -> None:
    """Each by less than what is refused as negative: what six of them do together, a longer delay undoes."""
    found = found_in("delay-swings")
    assert found.verdict == "effect"
    assert [each.choice for each in found.causes] == ["sample_delay"]


@pytest.mark.long
def test_two_drives_that_hang_back_are_not_six() -> None:
    """By the velocity, each in its own way: six lags say it as well, since what they have in common is hardly seen."""
    found = found_in("drives-hang-back")
    assert found.verdict == "unknown"
    names = {each.choice.partition("_turning@")[0] for each in found.causes}
    assert names == {"servo_lag:4", "learned:slider:6:velocity"}


@pytest.mark.long
def test_a_gauge_that_drifts_slowly_is_no_gauge_of_another_gain() -> None:
    """That explains a third by functions of time, its form; the drift explains all by its formula."""
    found = found_in("gauge-drifts")
    assert found.verdict == "effect"
    assert [each.choice for each in found.causes] == ["bar_drift"]


@pytest.mark.long
def test_play_and_spikes_of_two_sliders_are_told_apart_from_a_lag_of_all() -> None:
    """Each leaves three times the noise; a lag of all six drives and both spikes explain as much, by their forms."""
    found = found_in("play-and-spikes")
    assert found.verdict == "effect"
    assert {each.choice for each in found.causes} == {
        "backlash:1",
        "backlash:6",
        "reversal_spike:1",
        "reversal_spike:6",
    }


@pytest.mark.parametrize(
    ("name", "causes"),
    [
        ("play-differs", {"backlash:2"}),
        ("lead-bends", {"lead_error:5"}),
        ("spike-and-bow", {"reversal_spike:5", "straightness:3"}),
        # A gauge read a quarter of a second late: 10 um of a slider, and more than that where its motion turns.
        ("delay-and-gain", {"bar_gain", "sample_delay"}),
        # In the words of learned functions it gave way to a guideway's side by position and direction.
        pytest.param("screws-and-lag", {"screw_thermal:1", "screw_thermal:5", "servo_lag:3"}, marks=pytest.mark.long),
        pytest.param("two-frictions", {"joint_friction:3", "joint_friction:6"}, marks=pytest.mark.long),
    ],
)
def test_forms_of_their_own_do_not_hide_effects(name: str, causes: set[str]) -> None:
    """Play and friction that differ by place and load, a lead that bends, stiction by acceleration, a filter that lags.

    Their forms are up to a fifth off the formulas, and more in what geometry leaves of them.
    """
    found = found_in(name)
    assert found.verdict == "effect"
    assert {each.choice for each in found.causes} == causes
    deviations = [each.form_deviation for each in found.causes]
    assert max(deviations) < 0.25


@pytest.mark.long
def test_pictures_of_two_states_are_files_of_one_folder() -> None:
    """Their two numbers are parted by a slash, as instants of steps are."""
    names = [each.suffix for each in discovery_pages(found_in("spring-snaps"))]
    assert names[0].startswith("cause-learned-slider-6-drive_load_relay@")
    assert not any("/" in each or ":" in each for each in names)
