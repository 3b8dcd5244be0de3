"""Faults that no known effect describes, in records of simulators that share nothing with the project.

Asked of `tests/foreign_records.py` is the place at which something is learned, the variable by which, and that it
predicts what was left out.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tests.foreign_records import found_in

import hexdbb as hx
from hexdbb.plots.analysis_pages import discovery_pages

NUMBERS = {"rail-warms": 470.4, "fan-cools": 16.0, "nut-heats": 304.0, "cover-jams": 2.5}
NUMBERS |= {"legs-breathe": 702.0, "nut-lifts": 190.0, "motor-heats-foot": 94.6, "end-heats-leg": 18.26}
NUMBERS |= {"rail-end-lifts": 522.0, "counterbalance-cycles": 147.0}
NUMBERS |= {"cogging-damped-by-speed": 20.0}
NUMBERS |= {"clamp-leaks": 20.432, "column-sways": 430.0, "mains-hums": 1.0 / 49.963, "post-shakes": 1.0 / 4.63}
"""True value of the number in the name of the cause, by record: s or mm."""
MISSED = 0.2**0.5
"""Error on what was left out, over that without the cause, of one that explains four fifths of the squares there."""
DIRECTION_DEG = {"hose-pulls": (40.1, 3.0), "foot-rocks": (70.0, 1.0), "foot-tips": (110.5, 3.0)}
"""The same of a direction, and how near: the hose's pull turns with the platform, which no function has, and which
moves the best direction by two degrees, a fifteenth of what lies between two that are tried."""


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
        # One end of a rail, which a coolant tank warms: a screw that shrank and another that grew, for sure.
        ("rail-end-lifts", "learned:vertical:3:time_position_settling@", {"feed", "direction", "lap"}),
        # Both carriages heat the beam on top, which humps: a function of time there, and a load beside it.
        ("carriages-heat-beam", "learned:vertical:3:position_heated@", {"circle", "feed", "direction", "lap"}),
        # A magnet that slips a little at each approach of the bar: a function of the speed and the time.
        ("cup-slips-each-time", "learned:cup:each_sweep", {"lap"}),
        # A compressor that cycles, by the pull of the counterbalance at elastic legs: the reading, and the cup besides.
        ("counterbalance-cycles", "learned:load:time_period@", {"circle", "feed", "lap"}),
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
        ("leg-unscrews", "learned:leg:5:wound", {"circle", "feed"}),
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
        # A joint that sticks, then slides as the leg inclines: a force that grows with time said four fifths of it.
        ("joint-sticks", "learned:leg:1:inclination_slipping@", {"circle", "feed", "direction", "lap"}),
        # A drive that falls behind above 12 mm/s only: a lag for sure, whose formula said nearly nine tenths of it.
        ("lags-above-a-speed", "learned:slider:2:velocity", {"circle", "feed", "direction", "lap"}),
        # Cogging that a drive holds down at speed, by exp(-v / 8 mm/s): a rail each way and a ball, after two minutes.
        ("cogging-damped-by-speed", "learned:slider:4:velocity_wave@", {"circle", "feed", "lap"}),
        # Round a post from lap to lap, and back the other way: a noisy gauge, since laps lie apart evenly.
        ("cable-winds-up", "learned:reading:wound", {"circle", "feed", "direction", "lap"}),
        # By 0.13 s late: all six drives lagged, each by as much as the functions of its form made of it.
        ("scale-creeps-after-its-neighbour", "learned:slider:6:neighbour_velocity", {"feed", "direction", "lap"}),
        # A gauge that reads short away from its middle, with a flaw at one place: a wrong gain for sure.
        ("gauge-saturates", "learned:reading:deflection", {"circle", "feed", "direction", "lap"}),
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
    assert all(found.heldout[each].after_um < MISSED * found.heldout[each].before_um for each in claimed)


@pytest.mark.long
def test_a_pitch_error_is_seen_beside_a_leg_that_swings_at_one_feed() -> None:
    """Alike at all feeds, beats of two periods said half of it, and what they left hid the pitch error."""
    found = found_in("leg-swings-at-one-feed")
    swings, pitch = found.causes
    name, _, period_s = swings.choice.partition("@")
    assert name == "learned:leg:6:time_period_by_feed"
    assert float(period_s) == pytest.approx(1.0 / 0.74, rel=0.01)
    assert "repeats every 1.351 s, otherwise at each feed" in swings.clause
    assert pitch.choice == "pitch_cyclic:3"
    assert found.heldout["circle"].after_um < MISSED * found.heldout["circle"].before_um


def test_a_dead_band_is_described_and_drafted(tmp_path: Path) -> None:
    """The drive was made to fall behind above 12 mm/s only, backwards by 57 % of what it does forwards."""
    found = found_in("lags-above-a-speed")
    (only,) = found.causes
    words = r"constant from -12\.\d mm/s to 12(\.\d)? mm/s; -1\.6\d µm per mm/s below, -2\.8\d µm per mm/s above"
    assert re.search(words, only.clause)
    hx.draft_effect(found, tmp_path / "mine.py")
    (mine,) = hx.load_effects(tmp_path / "mine.py")
    fitted = hx.add_effect(found.samples, found.base.knowing_effects([mine]), mine.name)
    assert fitted.rms_after_um < 1.05 * 0.4  # the gauge's noise


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


def test_one_leg_that_gives_is_no_sag_of_all() -> None:
    """A weld of leg 3 is cracked: by its form, which has functions of each leg, the sag of all explains as much."""
    found = found_in("one-leg-yields")
    assert found.verdict == "unknown"
    (only,) = found.causes
    assert only.choice == "learned:leg:3:leg_force"
    assert not any("gravity_sag" in each for each in only.rivals)


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
        # A cup that creeps after each fixing, one a circle: a screw that grows, by the functions of its form.
        ("creep-after-each-fixing", {"pitch_cyclic:2", "learned:cup:time_in_circle"}),
        # A dent beside legs that sag: a bow, by the functions of its form, which left three times the noise.
        ("dent-beside-sag", {"gravity_sag", "learned:vertical:2:fine_position"}),
        # A ball with five lobes, and play a quarter as large: lobes that differ by the way round said both.
        ("lobes-beside-play-of-three", {"learned:reading:bar_angle", "backlash:3", "backlash:4", "backlash:6"}),
        # A gauge that bends, by the way it moves besides, beside which the plain bend says nothing: it was not told.
        ("play-beside-a-gauge-that-bends", {"backlash:3", "learned:reading:deflection"}),
        # A leg that its motor warms; the bar is 10 um shorter than stated, which was a screw and two more lags.
        ("lag-and-warm-leg-longer-bar", {"servo_lag:4", "learned:leg:2:velocity_lingering"}),
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


@pytest.mark.long
def test_pictures_of_two_states_are_files_of_one_folder() -> None:
    """Their two numbers are parted by a slash, as instants of steps are."""
    names = [each.suffix for each in discovery_pages(found_in("spring-snaps"))]
    assert names[0].startswith("cause-learned-slider-6-drive_load_relay@")
    assert not any("/" in each or ":" in each for each in names)
