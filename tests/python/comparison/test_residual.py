"""The residual looked at from all sides: each test hides one thing in it and finds that thing named."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.python.comparison.made_up import SAMPLES_PER_LAP, MakeRecord, compared

from hexdbb.comparison import Comparison
from hexdbb.comparison.harmonics import harmonics
from hexdbb.predictors.halves import halves
from hexdbb.record import Record
from hexdbb.samples import Samples

NOISE_MM = 0.0005
LAP_S = 48.0


def noise(record: Record, seed: int = 7) -> np.ndarray:
    return NOISE_MM * np.random.default_rng(seed).standard_normal(len(record))


def moving(record: Record) -> Record:
    """Let slider 4 go up and down once a turn of 48 s, and slider 1 slowly through three periods over the record."""
    angle = np.radians(record.columns["angle_deg"])
    record.columns["t_s"] = LAP_S / SAMPLES_PER_LAP * np.arange(len(record))
    record.columns["s4_mm"] = 400.0 + 100.0 * np.sin(angle)
    record.columns["s1_mm"] = 300.0 + 50.0 * np.sin(6.0 * np.pi * np.arange(len(record)) / len(record))
    return record


def travel_direction(record: Record) -> np.ndarray:
    """Where `moving`'s slider 4 goes: +1 up, -1 down; (n,)."""
    angle, direction = np.radians(record.columns["angle_deg"]), record.columns["direction"]
    return np.where(direction * np.cos(angle) >= 0.0, 1.0, -1.0)


def since_reversal_s(record: Record) -> np.ndarray:
    """Time since `moving`'s slider 4 reversed; (n,)."""
    angle, direction = np.radians(record.columns["angle_deg"]), record.columns["direction"]
    return np.mod(direction * (angle - np.pi / 2.0), np.pi) / np.pi * LAP_S / 2.0


def with_residual(record: Record, residual_mm: np.ndarray) -> Comparison:
    return compared([record], [record.reading_mm - residual_mm - noise(record)])


def flat(angle_rad: np.ndarray, direction: int) -> np.ndarray:
    return 0.0 * angle_rad


@pytest.fixture
def record(make_record: MakeRecord) -> Record:
    return moving(make_record(flat, circles=2, feeds=(753.98, 3000.0), laps=2))


def shares(comparison: Comparison) -> dict[str, float]:
    return {each.variable: each.share for each in comparison.predictors}


def test_noise_alone_has_no_predictor_and_nothing_is_over_represented(record: Record) -> None:
    comparison = with_residual(record, np.zeros(len(record)))
    assert max(shares(comparison).values()) < 0.03
    assert comparison.worst_samples.common == ()
    assert "no circumstance is over-represented" in comparison.worst_samples.sentences[0]
    assert comparison.worst_samples.samples == pytest.approx(0.1 * len(record), rel=0.05)


def test_lost_motion_is_predicted_by_the_slider_that_has_it(record: Record) -> None:
    residual_mm = 0.004 * travel_direction(record)
    found = shares(with_residual(record, residual_mm))
    best = max(found, key=found.__getitem__)
    assert "slider 4" in best or best == "angle, each direction"
    assert found["slider 4 direction of travel"] > 0.95
    assert found["slider 4 position, each direction of travel"] > 0.95
    assert found["slider 4 position"] < 0.05
    assert found["angle"] < 0.05


def test_a_variable_predicts_what_depends_on_it(record: Record) -> None:
    residual_mm = 0.003 * np.sin((record.columns["s1_mm"] - 300.0) / 20.0)
    found = shares(with_residual(record, residual_mm))
    assert found["slider 1 position"] > 0.85
    assert found["slider 4 position"] < 0.2


def test_the_means_drawn_are_those_of_the_residual(record: Record) -> None:
    comparison = with_residual(record, 0.002 * record.columns["direction"])
    direction = next(each for each in comparison.predictors if each.variable == "direction")
    (means,) = direction.profiles
    assert means.centre.tolist() == [-1.0, 1.0]
    assert means.mean_um == pytest.approx([-2.0, 2.0], abs=0.05)


def test_halves_hold_the_same_circles_and_whole_laps(record: Record) -> None:
    second = halves(Samples.of([record]))
    assert second.mean() == pytest.approx(0.5)
    assert np.array_equal(second, record.columns["lap"] == 1)


def test_a_single_lap_is_dealt_by_stretches(make_record: MakeRecord) -> None:
    record = make_record(flat)
    second = halves(Samples.of([record]))
    assert second[:8].tolist() == [False] * 4 + [True] * 4
    assert second.mean() == pytest.approx(0.5)


def test_what_the_worst_samples_share_is_said(record: Record) -> None:
    angle_deg, direction = record.columns["angle_deg"], record.columns["direction"]
    bad = (direction == -1) & (angle_deg >= 340.0) | (direction == -1) & (angle_deg < 10.0)
    found = with_residual(record, 0.010 * bad).worst_samples
    said = "\n".join(found.sentences)
    assert found.common[0].what.startswith("angle 3")
    assert "clockwise" in {trait.what for trait in found.common}
    assert "counter-clockwise" not in {trait.what for trait in found.common}
    clockwise = next(trait for trait in found.common if trait.what == "clockwise")
    assert clockwise.in_worst > 0.9
    assert clockwise.in_all == pytest.approx(0.5)
    assert clockwise.rms_with_um > 2.0 > clockwise.rms_without_um
    assert "% of them" in said and found.rms_um > found.rms_elsewhere_um


def test_a_spike_at_reversals_is_said(record: Record) -> None:
    since_s = since_reversal_s(record)
    found = with_residual(record, 0.010 * (since_s < 1.0)).worst_samples
    assert "within 1 s after a reversal of slider 4" in {trait.what for trait in found.common}


def test_a_circumstance_that_only_repeats_another_is_left_out(make_record: MakeRecord) -> None:
    """Slider 4 goes with the angle, and so would its positions be over-represented: they add nothing."""
    record = moving(make_record(flat, circles=2, directions=(1,), laps=2))
    angle_deg = record.columns["angle_deg"]
    found = with_residual(record, 0.010 * ((angle_deg >= 100.0) & (angle_deg < 110.0))).worst_samples
    assert [each.what.split()[0] for each in found.common] == ["angle"]
    assert found.common[0].in_worst >= 0.7 > 10.0 * found.common[0].in_all


@given(st.integers(1, 12), st.floats(-3.0, 3.0), st.floats(0.001, 0.1))
def test_a_harmonic_is_found_with_amplitude_and_phase(order: int, phase_rad: float, amplitude_mm: float) -> None:
    angle_rad = np.arange(360) * 2.0 * np.pi / 360.0
    found = harmonics(angle_rad, 0.02 + amplitude_mm * np.cos(order * angle_rad - phase_rad))
    assert [each.order for each in found] == list(range(1, 13))
    assert found[order - 1].amplitude_mm == pytest.approx(amplitude_mm)
    assert found[order - 1].phase_rad == pytest.approx(phase_rad, abs=1e-9)
    assert sum(each.amplitude_mm for each in found) == pytest.approx(amplitude_mm)


def test_half_a_circle_has_no_harmonics(make_record: MakeRecord) -> None:
    record = make_record(flat)
    half = record.part(record.columns["angle_deg"] < 180.0)
    (circle,) = compared([half], [half.reading_mm]).circles
    assert [part.harmonics for part in circle.directions] == [(), ()]


def test_sum_and_difference_take_the_two_directions_apart(record: Record) -> None:
    angle = np.radians(record.columns["angle_deg"])
    residual_mm = 0.005 * np.cos(2.0 * angle) + 0.003 * record.columns["direction"] * np.sin(angle)
    for circle in compared([record], [record.reading_mm - residual_mm]).circles:
        both = circle.both_directions
        assert both is not None and len(both.angle_rad) == 72
        assert both.half_sum_mm == pytest.approx(0.005 * np.cos(2.0 * both.angle_rad), abs=1.5e-4)
        assert both.half_difference_mm == pytest.approx(0.003 * np.sin(both.angle_rad), abs=1.5e-4)


def test_one_direction_has_no_sum(make_record: MakeRecord) -> None:
    record = make_record(flat, directions=(1,))
    assert compared([record], [record.reading_mm]).circles[0].both_directions is None


def test_a_comparison_shows_itself_in_a_notebook(record: Record) -> None:
    comparison = with_residual(record, np.zeros(len(record)))
    frame = comparison.to_frame()
    assert len(frame) == len(record)
    assert (frame["reading_mm"] - frame["predicted_mm"]).to_numpy() == pytest.approx(frame["residual_mm"].to_numpy())
    assert np.array_equal(frame["sliders_mm_4"].to_numpy(), record.columns["s4_mm"])
    shown = comparison._repr_html_()
    assert shown.count("<tr>") == 1 + 8 + 1 + 8
    assert "µm RMS" in shown
