"""What a run refuses sample by sample: jumps, spikes, steps, repetitions, answers to other SYNCs."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest

from hexdbb.capture.exchange import Feedback
from hexdbb.capture.lag import SETTLING
from hexdbb.capture.plausibility import Plausibility

SCALE, CYCLE_S, LAG_S = 1000.0, 0.004, 0.01
"""Counts per mm, SYNC period, lag of the position loops."""
NOISE_UM = 0.5


def histories() -> Plausibility:
    return Plausibility(
        counts_per_mm=SCALE, cycle_s=CYCLE_S, velocity_mm_s=250.0, ball_mm_s=50.0, noise_um=NOISE_UM, repeats=25
    )


def targets_mm(time_s: float) -> list[float]:
    """Six sliders of a circle driven at 12.6 mm/s."""
    return [300.0 + 60.0 * math.sin(0.21 * time_s + k) for k in range(6)]


def answers(count: int, late: int = 0, seed: int = 0) -> Iterator[tuple[list[int], Feedback]]:
    """Targets, and the answers of six loops that lag and a gauge with noise; those of slider 3 are `late` SYNCs old."""
    draw = np.random.default_rng(seed)
    for number in range(count):
        feedback = Feedback()
        feedback.settled = True
        time_s = number * CYCLE_S
        feedback.position = [round(each * SCALE) for each in targets_mm(time_s - LAG_S)]
        if number > count // 2:
            feedback.position[2] = round(targets_mm(time_s - LAG_S - late * CYCLE_S)[2] * SCALE)
        feedback.reading_um = round(100.0 * math.sin(0.42 * time_s) + draw.normal(0.0, NOISE_UM), 1)
        yield [round(each * SCALE) for each in targets_mm(time_s)], feedback


def test_a_plain_circle_raises_nothing() -> None:
    plausible = histories()
    for expected, feedback in answers(5000):
        plausible.update(feedback, expected, 0, gauge_watched=True)
        assert plausible.jump() is None
        assert plausible.position_spike() is None
        assert plausible.spike() is None
        assert not plausible.is_frozen()
        assert plausible.lag.shifted() is None


@pytest.mark.parametrize("late", [1, 2])
def test_answers_of_an_earlier_sync_show_as_lag(late: int) -> None:
    plausible, found, number = histories(), None, 0
    for expected, feedback in answers(4000, late):
        plausible.update(feedback, expected, 0, gauge_watched=True)
        found = plausible.lag.shifted()
        if found is not None:
            break
        number += 1
    assert found is not None
    slot, lag, first = found
    assert slot == 2
    assert first == pytest.approx(LAG_S / CYCLE_S, abs=0.2)
    assert lag > first + 0.6
    assert 2000 < number < 2000 + SETTLING


@pytest.mark.parametrize(("by_mm", "slot"), [(2.85, 1), (-0.3, 5)])
def test_a_position_that_jumps_is_found_at_once(by_mm: float, slot: int) -> None:
    plausible = histories()
    for number, (expected, feedback) in enumerate(answers(400)):
        if number == 300:
            feedback.position[slot] += round(by_mm * SCALE)
        plausible.update(feedback, expected, 0, gauge_watched=True)
        found = plausible.jump()
        assert (found is not None) == (number == 300), number
        if found is not None:
            assert found[0] == slot
            assert found[1] == pytest.approx(by_mm, abs=0.1)
            break


@pytest.mark.parametrize("missed", [(289,), (299,), (301,), (299, 301), (298, 299, 301, 302)])
def test_a_position_that_jumps_near_missed_cycles_is_found(missed: tuple[int, ...]) -> None:
    plausible, waiting, found, number = histories(), 0, None, 0
    for number, (expected, feedback) in enumerate(answers(400)):
        if number in missed:
            waiting += 1  # the controller was late and left out this SYNC
            continue
        if number == 300:
            feedback.position[1] += round(1.5 * SCALE)
        plausible.update(feedback, expected, waiting, gauge_watched=True)
        waiting = 0
        jump, found = plausible.jump(), plausible.position_spike()
        if found is None and jump is not None:
            found = (*jump, 0)
        if found is not None:
            break
    assert found is not None
    slot, off_mm, _, cycles = found
    assert (slot, number - cycles) == (1, 300)
    assert off_mm == pytest.approx(1.5, abs=0.1)


def test_a_slider_that_jams_has_not_jumped() -> None:
    plausible, stuck = histories(), None
    for number, (expected, feedback) in enumerate(answers(600)):
        stuck = feedback.position[4] if number == 300 else stuck
        if stuck is not None:
            feedback.position[4] = stuck
        plausible.update(feedback, expected, 0, gauge_watched=True)
        assert plausible.jump() is None
        assert plausible.position_spike() is None


@pytest.mark.parametrize("lasting", [False, True])
def test_a_reading_60_um_off_is_found(lasting: bool) -> None:
    plausible, found_at = histories(), None
    for number, (expected, feedback) in enumerate(answers(400)):
        if number == 300 or (lasting and number > 300):
            feedback.reading_um += 60.0
        plausible.update(feedback, expected, 0, gauge_watched=True)
        if plausible.spike() is not None:
            found_at = number
            break
    assert found_at in (300, 301)


def test_a_gauge_that_repeats_itself_is_frozen_and_counts_since_when() -> None:
    plausible, held = histories(), None
    for number, (expected, feedback) in enumerate(answers(400)):
        held = feedback.reading_um if number == 300 else held
        if held is not None:
            feedback.reading_um = held
        plausible.update(feedback, expected, 0, gauge_watched=True)
        if plausible.is_frozen():
            break
    assert number == 325
    assert plausible.same == 25


def test_a_frozen_gauge_is_found_although_cycles_are_missed() -> None:
    plausible = histories()
    for number, (expected, feedback) in enumerate(answers(200)):
        if number >= 100:
            feedback.reading_um = 7.5
        plausible.update(feedback, expected, 3 if number % 10 == 0 else 0, gauge_watched=True)
        if plausible.is_frozen():
            break
    assert number == 125
    assert plausible.same_cycles == 25 + 2 * 3


def test_missed_cycles_are_no_jump() -> None:
    plausible = histories()
    for number, (expected, feedback) in enumerate(answers(900)):
        if 300 <= number < 310:
            continue  # the controller stalled; the drives stood, then went on
        plausible.update(feedback, expected, 10 if number == 310 else 0, gauge_watched=True)
        assert plausible.jump() is None
        assert plausible.position_spike() is None
        assert plausible.spike() is None
