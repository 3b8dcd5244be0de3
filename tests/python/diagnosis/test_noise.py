"""Noise of one reading: from repeated laps, however the gauge rounds; jumps do not count."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from scipy.signal import lfilter

from hexdbb.diagnosis import JudgingNoise, judging_noise, noise_of
from hexdbb.diagnosis.noise import MIN_REPEATS, PARTS, lap_differences
from hexdbb.model import new_model
from hexdbb.record import Record
from hexdbb.samples import Samples, predict
from hexdbb_truth.cases import case


@lru_cache
def clean(seed: int) -> Record:
    return case(f"none-s{seed}").record()


def rounded(record: Record, noise_um: float, step_um: float, seed: int) -> Record:
    """Return a record whose readings repeat from lap to lap but for noise, rounded."""
    angle = np.radians(record.columns["angle_deg"])
    smooth_um = 30.0 * np.cos(angle) + 5.0 * np.cos(2.0 * angle)
    noisy_um = smooth_um + noise_um * np.random.default_rng(seed).standard_normal(len(record))
    shown_um = np.round(noisy_um / step_um) * step_um if step_um else noisy_um
    return replace(record, columns={**record.columns, "reading_um": shown_um})


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("noise_um", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("step_um", [0.0, 0.1, 0.5])
def test_laps_tell_the_noise_with_its_rounding(seed: int, noise_um: float, step_um: float) -> None:
    found = noise_of(Samples.of([rounded(clean(1), noise_um, step_um, seed)]))
    assert found.source == "repeated laps"
    assert found.sigma_mm * 1e3 == pytest.approx(np.hypot(noise_um, step_um / np.sqrt(12.0)), rel=0.05)


@pytest.mark.parametrize("seed", [1, 2, 3, 6, 11])
def test_it_is_the_truths_noise_and_each_circle_tells_it(seed: int) -> None:
    record = clean(seed)
    assert noise_of(Samples.of([record])).sigma_mm * 1e3 == pytest.approx(0.5, rel=0.03)
    for circle in range(7):
        own = record.part(record.columns["circle"] == circle)
        assert noise_of(Samples.of([own])).sigma_mm * 1e3 == pytest.approx(0.5, rel=0.1)


def test_jumps_do_not_count() -> None:
    record = rounded(clean(1), 0.5, 0.1, 7)
    reading_um = record.columns["reading_um"].copy()
    reading_um[::40] += 20.0
    found = noise_of(Samples.of([replace(record, columns={**record.columns, "reading_um": reading_um})]))
    assert found.sigma_mm * 1e3 == pytest.approx(0.5, rel=0.06)


def test_what_settles_in_the_first_lap_of_each_run_is_no_noise() -> None:
    record = rounded(clean(1), 0.5, 0.1, 7)
    settles_s, size_um = 2.0, 8.0
    settling_um = size_um * np.exp(-Samples.of([record])["time_in_sweep_s"] / settles_s)
    columns = {**record.columns, "reading_um": record.columns["reading_um"] + settling_um}
    found = noise_of(Samples.of([replace(record, columns=columns)]))
    assert found.source == "repeated laps"
    assert found.sigma_mm * 1e3 == pytest.approx(0.5, rel=0.1)


def test_laps_that_are_too_short_for_parts_count_whole() -> None:
    """Parts of fewer differences than `MIN_REPEATS` would scatter by more than what settles."""
    record = rounded(clean(1), 0.5, 0.1, 7)
    short = record.part((record.columns["circle"] == 0) & (np.arange(len(record)) % 4 == 0))
    differences = sum(map(len, lap_differences(Samples.of([short]))))
    assert MIN_REPEATS < differences < MIN_REPEATS * PARTS
    found = noise_of(Samples.of([short]))
    assert found.source == "repeated laps"
    assert found.sigma_mm * 1e3 == pytest.approx(0.5, rel=0.1)


def test_one_lap_has_its_roughness() -> None:
    record = clean(2)
    single = record.part(record.columns["lap"] == 0)
    silent = replace(single, gauge=single.gauge.model_copy(update={"noise_um": None}))
    found = noise_of(Samples.of([silent]))
    assert found.source == "roughness"
    assert found.sigma_mm * 1e3 == pytest.approx(0.5, rel=0.1)


def test_a_circle_driven_again_tells_noise_from_what_is_rough_along_it() -> None:
    """A pitch error of 5 mm, of which two readings are 3 mm apart: neighbours differ by it, the next time does not."""
    record = clean(2)
    slow = record.part((record.columns["lap"] == 0) & (record.columns["feed_mm_min"] < 1000.0))
    once = slow.part(np.arange(len(slow)) % 4 == 0)
    again = {each: np.concatenate([column, column]) for each, column in once.columns.items()}
    second = np.arange(2 * len(once)) >= len(once)
    again["sweep"] = again["sweep"] + (1 + again["sweep"].max()) * second
    again["t_s"] = again["t_s"] + (60.0 + np.ptp(again["t_s"])) * second
    silent = replace(once, columns=again, gauge=once.gauge.model_copy(update={"noise_um": None}))
    noise_um = np.random.default_rng(5).normal(0.0, 0.5, 2 * len(once))
    for wave_um, source in ((0.0, "roughness"), (4.0, "repeated circles")):
        rough_um = wave_um * np.sin(2.0 * np.pi * again["s4_mm"] / 5.0)
        found = noise_of(Samples.of([of_the_machine(silent, rough_um + noise_um)]))
        assert found.source == source
        assert found.sigma_mm * 1e3 == pytest.approx(0.5, rel=0.1)


def of_the_machine(record: Record, noise_um: np.ndarray) -> Record:
    """Return a record as a machine without errors makes it, but for some noise, shape (n,)."""
    samples = Samples.of([record])
    reading_um = 1e3 * predict(samples, new_model(samples.machine)).reading_mm + noise_um
    return replace(record, columns={**record.columns, "reading_um": reading_um})


def test_readings_that_are_the_machines_own_are_as_good_as_a_gauge_can_be() -> None:
    record = clean(1)
    assert noise_of(Samples.of([of_the_machine(record, np.zeros(len(record)))])).sigma_mm == 1e-6


@pytest.mark.parametrize("seed", range(3))
def test_noise_of_long_tails_is_in_doubt_by_them(seed: int) -> None:
    record = clean(1)
    drawn = np.random.default_rng(seed).standard_t(5, len(record))
    found = noise_of(Samples.of([of_the_machine(record, 0.5 * drawn / np.sqrt(5.0 / 3.0))]))
    assert found.sigma_mm * 1e3 < 0.48
    assert found.sigma_mm * (1.0 + found.tail) * 1e3 == pytest.approx(0.5, rel=0.04)


def test_normal_noise_has_no_tails() -> None:
    assert noise_of(Samples.of([clean(1)])).tail < 0.005


def test_axes_that_hunt_are_no_noise() -> None:
    """Their encoders show it; so do the readings."""
    record, draw = clean(1), np.random.default_rng(4)
    time_s = record.columns["t_s"]
    columns = dict(record.columns)
    for slider in range(1, 7):
        columns[f"s{slider}_mm"] = columns[f"s{slider}_mm"] + 1.5e-3 * np.sin(draw.uniform(20.0, 40.0) * time_s)
    hunting = replace(record, columns=columns)
    found = noise_of(Samples.of([of_the_machine(hunting, draw.normal(0.0, 0.5, len(record)))]))
    assert found.sigma_mm * 1e3 == pytest.approx(0.5, rel=0.03)


@pytest.mark.parametrize("seed", range(3))
def test_a_contour_sampled_sparsely_and_unevenly_is_no_noise(seed: int) -> None:
    record = clean(1)
    draw = np.random.default_rng(seed)
    sparse = record.part(draw.random(len(record)) < 0.3)
    assert noise_of(Samples.of([sparse])).sigma_mm * 1e3 == pytest.approx(0.5, rel=0.05)


def test_laps_that_differ_by_what_neighbours_share_are_no_noise() -> None:
    """An axis that hunts by 8 µm, its phase wandering, beside noise of half a micrometre: no gauge is so noisy."""
    record, draw = clean(1), np.random.default_rng(5)
    time_s = record.columns["t_s"]
    phase = 2.0 * np.pi * 0.43 * time_s + np.cumsum(draw.normal(0.0, 0.05, len(record)))
    reading_um = of_the_machine(record, draw.normal(0.0, 0.5, len(record))).columns["reading_um"] + 8.0 * np.sin(phase)
    samples = Samples.of([unstated(replace(record, columns={**record.columns, "reading_um": reading_um}))])
    judging = judging_noise(samples)
    assert not judging.is_steady and judging.remark is not None
    assert "something changes from lap to lap" in judging.remark
    assert judging.noise.sigma_mm * 1e3 < 2.5 < noise_of(samples).sigma_mm * 1e3


def test_laps_that_lie_apart_evenly_are_no_noisy_gauge() -> None:
    """The second lap 3 µm above the first, as a cable winds up: within each the gauge is as good as stated."""
    record = clean(1)
    noise_um = np.random.default_rng(8).normal(0.0, 0.5, len(record))
    level = of_the_machine(record, noise_um + 3.0 * record.columns["lap"])
    judging = judging_noise(Samples.of([level]))
    assert not judging.is_steady and judging.remark is not None
    assert "something changes from lap to lap" in judging.remark
    assert (judging.noise.source, judging.noise.sigma_mm) == ("stated", record.gauge.stated_noise_mm)
    # Where the gauge is noisier besides, laps tell by how much.
    noisier = judging_noise(Samples.of([of_the_machine(record, 4.0 * noise_um + 0.2 * record.columns["lap"])]))
    assert noisier.is_steady and noisier.remark is not None
    assert "noisier than stated" in noisier.remark


def test_noise_that_lasts_is_steady() -> None:
    """Nine tenths of it are kept from one reading to the next."""
    record, draw = clean(1), np.random.default_rng(6)
    kept = 0.9
    lasting = lfilter([np.sqrt(1.0 - kept**2)], [1.0, -kept], draw.normal(0.0, 0.5, len(record)))
    assert judging_noise(Samples.of([unstated(of_the_machine(record, lasting))])).is_steady


def test_what_a_model_explains_was_no_noise() -> None:
    record = clean(1)
    samples = Samples.of([of_the_machine(record, np.random.default_rng(7).normal(0.0, 0.5, len(record)))])
    left_mm = predict(samples, new_model(samples.machine)).residual_mm
    noise = noise_of(samples)
    assert JudgingNoise(noise).beside(samples, left_mm).noise is noise
    noisy = JudgingNoise(
        replace(noise, sigma_mm=3.0 * noise.sigma_mm)
    )  # a pitch error that no lap shares with the next
    assert noisy.beside(samples, left_mm).noise.sigma_mm == pytest.approx(noise.sigma_mm, rel=0.01)
    stated = JudgingNoise(replace(noisy.noise, source="stated"))
    assert stated.beside(samples, left_mm) is stated


def unstated(record: Record) -> Record:
    """Return a record whose gauge states no noise."""
    return replace(record, gauge=record.gauge.model_copy(update={"noise_um": None}))
