"""Readings that stand alone are left out and told of; what comes again, or is wider, is the machine's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.diagnosis import diagnose, glitches_in
from hexdbb.discovery import discover
from hexdbb.model import Choice, new_model
from hexdbb.record import Record
from hexdbb.samples import Samples, predict
from hexdbb_truth.forms.cases import case

NOISE_MM = 0.5e-3


@pytest.fixture(scope="module")
def clean() -> Record:
    return case("none-calibrate-s1").record()


def with_readings(record: Record, readings_um: np.ndarray) -> Record:
    return replace(record, columns={**record.columns, "reading_um": readings_um})


def glitched(record: Record, share: float) -> tuple[Record, np.ndarray]:
    draw = np.random.default_rng(5)
    hit = draw.choice(len(record), round(share * len(record)), replace=False)
    readings = record.columns["reading_um"].copy()
    readings[hit] += draw.choice([-1.0, 1.0], len(hit)) * draw.uniform(8.0, 60.0, len(hit))
    return with_readings(record, readings), hit


def white(record: Record) -> np.ndarray:
    return np.random.default_rng(6).normal(0.0, NOISE_MM, len(record))


def test_noise_alone_has_no_glitch(clean: Record) -> None:
    assert not glitches_in(Samples.of([clean]), white(clean), NOISE_MM).any()


def test_glitches_are_found_and_nothing_else(clean: Record) -> None:
    left = white(clean)
    hit = np.arange(50, len(clean), 501)
    left[hit] += 12.0 * NOISE_MM
    exact = predict(Samples.of([clean]), new_model(clean.machine).with_mounts(Samples.of([clean]).mounts))
    samples = Samples.of([with_readings(clean, (exact.reading_mm + left) * 1e3)])
    found = glitches_in(samples, left, NOISE_MM)
    assert set(np.flatnonzero(found)) <= set(hit)
    assert found[hit].mean() > 0.9  # a few lie beside another by chance, or near a reversal


def test_what_comes_again_in_another_lap_is_the_machine(clean: Record) -> None:
    samples, left = Samples.of([clean]), white(clean)
    narrow = np.abs(np.remainder(samples["angle_rad"] - 1.0, 2.0 * np.pi)) < np.radians(0.8)
    assert 0 < narrow.mean() < 0.02
    left[narrow] += 20.0 * NOISE_MM
    assert not glitches_in(samples, left, NOISE_MM)[narrow].any()


def test_steps_and_wide_bumps_are_the_machine(clean: Record) -> None:
    samples, left = Samples.of([clean]), white(clean)
    left += 20.0 * NOISE_MM * (samples["angle_rad"] > 2.0)
    left[300:305] += 30.0 * NOISE_MM
    ends = [rows[end] for rows in samples.sweeps() for end in (0, -1)]
    found = glitches_in(samples, left, NOISE_MM)
    assert not np.delete(found, ends).any()  # of a step just behind a sweep's first reading nothing else tells


@pytest.mark.parametrize("end", [0, -1])
def test_ends_of_sweeps_stand_alone_too_but_where_most_do(clean: Record, end: int) -> None:
    samples, left = Samples.of([clean]), white(clean)
    ends = [rows[end] for rows in samples.sweeps()]
    left[ends[3]] += 40.0 * NOISE_MM
    assert np.flatnonzero(glitches_in(samples, left, NOISE_MM)).tolist() == [ends[3]]
    left[ends] += 40.0 * NOISE_MM  # what settles since the motion began
    assert not glitches_in(samples, left, NOISE_MM).any()


def test_glitches_that_meet_by_chance_are_not_the_machine(clean: Record) -> None:
    """One reading in a hundred glitches: some meet another at their place in the other lap."""
    samples, left = Samples.of([clean]), white(clean)
    draw = np.random.default_rng(8)
    hit = np.flatnonzero(draw.random(len(left)) < 0.01)
    left[hit] += draw.choice([-1.0, 1.0], len(hit)) * draw.uniform(16.0, 80.0, len(hit)) * NOISE_MM
    predicted = predict(samples, new_model(clean.machine)).reading_mm
    glitched = Samples.of([with_readings(clean, (predicted + left) * 1e3)])
    found = glitches_in(glitched, left, NOISE_MM)
    assert set(np.flatnonzero(found)) <= set(hit)
    assert found[hit].mean() > 0.97


def test_many_readings_that_stand_alone_are_noise(clean: Record) -> None:
    left = white(clean)
    left[::20] += 20.0 * NOISE_MM * np.random.default_rng(7).choice([-1.0, 1.0], len(left[::20]))
    assert not glitches_in(Samples.of([clean]), left, NOISE_MM).any()


def test_a_clean_machine_with_glitches_lacks_nothing(clean: Record) -> None:
    record, hit = glitched(clean, 0.004)
    samples = Samples.of([record])
    found = diagnose(samples, new_model(record.machine), check_held_out=False)
    assert found.sufficiency.is_sufficient
    left_out = len(record) - len(found.samples)
    assert 0.9 * len(hit) <= left_out <= len(hit)
    assert any(f"{left_out} readings stand alone" in each for each in found.warnings)
    verdict = discover(samples, found.model)
    assert verdict.verdict == "none"
    assert any("stand alone" in each for each in verdict.remarks)


def test_a_fault_with_glitches_keeps_its_name() -> None:
    record, _ = glitched(case("backlash-d10-x10-calibrate-s1").record(), 0.004)
    found = discover(Samples.of([record]), new_model(record.machine), known_only=True)
    assert [each.choice for each in found.causes] == ["backlash:5"]


def test_a_reading_taken_while_a_play_is_crossed_is_the_machine(clean: Record) -> None:
    """The model crosses a play from one reading to the next; the machine had not yet crossed it, in one lap of two."""
    mounts = Samples.of([clean]).mounts
    model = new_model(clean.machine).with_effect(Choice.parse("backlash:5")).with_mounts(mounts)
    play = np.array([each.label == "backlash:5 play" for each in model.parameters()])
    exact = predict(Samples.of([clean]), model.with_values(np.where(play, 0.03, 0.0))).reading_mm
    jumps = np.diff(exact, prepend=exact[0])
    turned = np.diff(Samples.of([clean])["travel_direction"][:, 4], prepend=0.0) != 0.0
    dense = Samples.of([clean])["feed_mm_s"] < 20.0
    row = int(np.argmax(np.where(turned & dense, np.abs(jumps - np.roll(jumps, 1)), 0.0)[10:])) + 10
    left = white(clean)
    left[row] -= 8.0 * NOISE_MM * np.sign(jumps[row])
    samples = Samples.of([with_readings(clean, (exact + left) * 1e3)])
    assert not glitches_in(samples, left, NOISE_MM)[row]
    far = left.copy()
    far[row] -= 200.0 * NOISE_MM * np.sign(jumps[row])
    assert glitches_in(Samples.of([with_readings(clean, (exact + far) * 1e3)]), far, NOISE_MM)[row]


@pytest.mark.parametrize("every", [1, 12], ids=["at every reversal", "at one of twelve"])
def test_what_one_lap_shows_at_a_reversal_is_the_machines_where_other_reversals_show_it(
    clean: Record, every: int
) -> None:
    """The second lap left out, no other reading of the circle's direction is at the place of one."""
    first = clean.columns["lap"] == 0
    one_lap = replace(clean, columns={name: each[first] for name, each in clean.columns.items()})
    samples = Samples.of([one_lap])
    turned = [np.flatnonzero(np.diff(samples["travel_direction"][rows, 2]) != 0.0)[:1] for rows in samples.sweeps()]
    hit = np.concatenate([rows[at] for rows, at in zip(samples.sweeps(), turned, strict=True)])[::every]
    left = np.random.default_rng(6).normal(0.0, NOISE_MM, len(samples))
    left[hit] += 40.0 * NOISE_MM
    exact = predict(samples, new_model(clean.machine).with_mounts(samples.mounts)).reading_mm
    found = glitches_in(Samples.of([with_readings(one_lap, (exact + left) * 1e3)]), left, NOISE_MM)
    assert found[hit].all() if every > 1 else not found[hit].any()
    assert set(np.flatnonzero(found)) <= set(hit)
