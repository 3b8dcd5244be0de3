"""Whether a residual is noise: white ones pass as often as they should, smooth ones and loud ones do not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.diagnosis import FitTest, Noise
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE

NOISE = Noise(0.5e-3, "stated")


@pytest.fixture(scope="module")
def test_of_fit() -> tuple[FitTest, Record]:
    record = case("none-s3", replace(PACE, rate_hz=0.5 * PACE.rate_hz)).record()
    return FitTest(Samples.of([record]), NOISE), record


def white(record: Record, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(0.0, NOISE.sigma_mm, len(record))


def test_white_residuals_are_noise_as_often_as_stated(test_of_fit: tuple[FitTest, Record]) -> None:
    test, record = test_of_fit
    found = [test.of(white(record, seed), 0) for seed in range(200)]
    assert sum(each.is_significant for each in found) <= 2  # 0.2 are expected
    below = np.mean([each.shape_p < 0.1 for each in found])
    assert 0.04 < below < 0.17  # 0.1 with a standard error of 0.021
    assert all(abs(each.level) < 3.0 for each in found)


def test_a_smooth_residual_well_below_the_noise_is_seen(test_of_fit: tuple[FitTest, Record]) -> None:
    test, record = test_of_fit
    smooth = 0.25 * NOISE.sigma_mm * np.cos(2.0 * np.radians(record.columns["angle_deg"]))
    found = test.of(white(record, 1) + smooth, 0)
    assert found.shape_p < 1e-6
    assert found.level < 4.0  # the level alone would have let it pass
    assert found.is_significant
    assert found.unexplained_um == pytest.approx(0.25 * 0.5 / np.sqrt(2.0), rel=0.15)


def test_a_fast_residual_shows_in_the_level_alone(test_of_fit: tuple[FitTest, Record]) -> None:
    test, record = test_of_fit
    fast = NOISE.sigma_mm * np.where(np.arange(len(record)) % 2, 1.0, -1.0)
    found = test.of(white(record, 2) + fast, 0)
    assert found.level > 4.0 and found.shape_p > 1e-3
    assert found.is_significant
    assert found.unexplained_um == pytest.approx(0.5, rel=0.1)


def test_what_a_fit_has_adjusted_counts(test_of_fit: tuple[FitTest, Record]) -> None:
    test, record = test_of_fit
    found = [test.of(white(record, 3), fitted) for fitted in (0, 40)]
    assert found[1].rms_um > found[0].rms_um
    assert found[1].shape_p < found[0].shape_p


def test_a_gauge_noisier_than_stated_deceives_the_level_and_not_the_shape(
    test_of_fit: tuple[FitTest, Record],
) -> None:
    test, record = test_of_fit
    found = test.of(2.0 * white(record, 4), 0)
    assert found.level > 4.0
    assert found.shape_p > 1e-3


def lasting(record: Record, kept: float, draw: np.random.Generator) -> np.ndarray:
    """Noise of which a reading keeps a part from the one before it."""
    noise = np.zeros(len(record))
    for row, step in enumerate(draw.normal(0.0, NOISE.sigma_mm * np.sqrt(1.0 - kept**2), len(record))):
        noise[row] = kept * noise[row - 1] + step
    return noise


def slow_noise(record: Record, seed: int, kept: float = 0.95) -> np.ndarray:
    """White noise, and as much that keeps its value for some readings, twenty where not given."""
    draw = np.random.default_rng(seed)
    slow = lasting(record, kept, draw)
    return draw.normal(0.0, NOISE.sigma_mm, len(record)) + slow


def first_laps(record: Record) -> Record:
    return record.part(record.columns["lap"] == record.columns["lap"].min())


def test_noise_that_changes_slowly_is_noise_where_laps_are_repeated(test_of_fit: tuple[FitTest, Record]) -> None:
    _, record = test_of_fit
    test = FitTest(Samples.of([record]), Noise(np.sqrt(2.0) * NOISE.sigma_mm, "repeated laps"))
    found = [test.of(slow_noise(record, seed), 0) for seed in range(10)]
    assert not any(each.shape_p < 1e-4 for each in found)
    shared = 0.5 * NOISE.sigma_mm * np.cos(2.0 * np.radians(record.columns["angle_deg"]))
    assert test.of(slow_noise(record, 1) + shared, 0).shape_p < 1e-6


def test_noise_that_changes_slowly_is_seen_where_no_lap_is_repeated(test_of_fit: tuple[FitTest, Record]) -> None:
    _, record = test_of_fit
    first = first_laps(record)
    assert FitTest(Samples.of([first]), NOISE).of(slow_noise(first, 2), 0).shape_p < 1e-4


def test_white_noise_and_noise_that_lasts_are_told_from_a_fault_by_their_spectrum(
    test_of_fit: tuple[FitTest, Record],
) -> None:
    first = first_laps(test_of_fit[1])
    test = FitTest(Samples.of([first]), NOISE)
    found = [test.of(slow_noise(first, seed, kept), 0).shape_p for seed in range(20) for kept in (0.6, 0.8)]
    assert min(found) > 1e-3
    assert 0.2 < np.median(found) < 0.8
    fault = 4.0 * NOISE.sigma_mm * np.cos(2.0 * np.radians(first.columns["angle_deg"]))
    assert test.of(slow_noise(first, 1, 0.8) + fault, 0).shape_p < 1e-4


def test_noise_that_lasts_for_a_few_readings_is_noise_on_single_laps_too(test_of_fit: tuple[FitTest, Record]) -> None:
    """What neighbours share tells how much of it is in the lowest harmonics; a fault of its size is more."""
    first = first_laps(test_of_fit[1])
    test = FitTest(Samples.of([first]), NOISE)
    found = [test.of(lasting(first, 0.6, np.random.default_rng(seed)), 0) for seed in range(20)]
    assert not any(each.is_significant for each in found)
    assert np.median([each.shape_p for each in found]) > 0.3
    fault = NOISE.sigma_mm * np.cos(2.0 * np.radians(first.columns["angle_deg"]))
    seen = test.of(lasting(first, 0.6, np.random.default_rng(1)) + fault, 0)
    assert seen.shape_p < 1e-4  # how uncertain the noise is counts
    assert seen.smooth_um == pytest.approx(0.5 / np.sqrt(2.0), rel=0.2)
