"""The residual looked at from all sides: each test hides one thing in it and finds that thing named."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hexdbb.compare import Comparison, compare
from hexdbb.compare.harmonics import harmonics
from hexdbb.record import Record
from hexdbb.variables.columns import halves

MakeRecord = Callable[..., Record]
NOISE_MM = 0.0005


def noise(record: Record, seed: int = 7) -> np.ndarray:
    return NOISE_MM * np.random.default_rng(seed).standard_normal(len(record))


def moving(record: Record) -> Record:
    """Let slider 4 go up and down once a turn, and slider 1 slowly through three periods over the record."""
    angle = np.radians(record.columns["angle_deg"])
    record.columns["s4_mm"] = 400.0 + 100.0 * np.sin(angle)
    record.columns["s1_mm"] = 300.0 + 50.0 * np.sin(6.0 * np.pi * np.arange(len(record)) / len(record))
    return record


def state(record: Record) -> dict[str, np.ndarray]:
    """Where each slider last moved to, and how long ago it reversed, of `moving`'s slider 4; the others never did."""
    angle, direction = np.radians(record.columns["angle_deg"]), record.columns["direction"]
    side = np.ones((len(record), 6))
    side[:, 3] = np.where(direction * np.cos(angle) >= 0.0, 1.0, -1.0)
    since_s = np.full((len(record), 6), 1e6)
    since_s[:, 3] = np.mod(direction * (angle - np.pi / 2.0), np.pi) / np.pi * 24.0
    return {"travel_direction": side, "since_reversal_s": since_s, "velocity_mm_s": side}


def with_residual(record: Record, residual_mm: np.ndarray, states: bool = True) -> Comparison:
    predicted_mm = record.reading_mm - residual_mm - noise(record)
    return compare([record], [predicted_mm], [state(record)] if states else None)


def flat(angle_rad: np.ndarray, direction: int) -> np.ndarray:
    return 0.0 * angle_rad


@pytest.fixture
def record(make_record: MakeRecord) -> Record:
    return moving(make_record(flat, circles=2, feeds=(753.98, 3000.0), laps=2))


def shares(comparison: Comparison) -> dict[str, float]:
    return {each.variable: each.share for each in comparison.dependences}


def test_noise_alone_is_carried_by_nothing_and_has_nothing_in_common(record: Record) -> None:
    comparison = with_residual(record, np.zeros(len(record)))
    assert max(shares(comparison).values()) < 0.03
    assert comparison.failures.common == ()
    assert "nothing in common" in comparison.failures.sentences[0]
    assert comparison.failures.samples == pytest.approx(0.1 * len(record), rel=0.05)


def test_lost_motion_is_carried_by_the_slider_that_has_it(record: Record) -> None:
    residual_mm = 0.004 * state(record)["travel_direction"][:, 3]
    found = shares(with_residual(record, residual_mm))
    best = max(found, key=found.__getitem__)
    assert "slider 4" in best or best == "angle, each direction"
    assert found["slider 4 way of moving"] > 0.95
    assert found["slider 4 position, each way"] > 0.95
    assert found["slider 4 position"] < 0.05
    assert found["angle"] < 0.05


def test_a_variable_carries_what_depends_on_it(record: Record) -> None:
    residual_mm = 0.003 * np.sin((record.columns["s1_mm"] - 300.0) / 20.0)
    found = shares(with_residual(record, residual_mm))
    assert found["slider 1 position"] > 0.85
    assert found["slider 4 position"] < 0.2


def test_the_means_drawn_are_those_of_the_residual(record: Record) -> None:
    comparison = with_residual(record, 0.002 * record.columns["direction"])
    direction = next(each for each in comparison.dependences if each.variable == "direction")
    (means,) = direction.profiles
    assert means.centre.tolist() == [-1.0, 1.0]
    assert means.mean_um == pytest.approx([-2.0, 2.0], abs=0.05)


def test_halves_hold_the_same_circles_and_whole_laps(record: Record) -> None:
    columns = with_residual(record, np.zeros(len(record))).columns
    second = halves(columns)
    assert second.mean() == pytest.approx(0.5)
    assert np.array_equal(second, columns["lap"] == 1)


def test_a_single_lap_is_dealt_by_stretches(make_record: MakeRecord) -> None:
    record = make_record(flat)
    second = halves(compare([record], [record.reading_mm]).columns)
    assert second[:8].tolist() == [False] * 4 + [True] * 4
    assert second.mean() == pytest.approx(0.5)


def test_what_the_worst_samples_share_is_said(record: Record) -> None:
    angle_deg, direction = record.columns["angle_deg"], record.columns["direction"]
    bad = (direction == -1) & (angle_deg >= 340.0) | (direction == -1) & (angle_deg < 10.0)
    found = with_residual(record, 0.010 * bad).failures
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
    since_s = state(record)["since_reversal_s"][:, 3]
    found = with_residual(record, 0.010 * (since_s < 1.0)).failures
    assert "within 1 s after a reversal of slider 4" in {trait.what for trait in found.common}


def test_without_a_state_nothing_is_said_of_reversals(record: Record) -> None:
    comparison = with_residual(record, np.zeros(len(record)), states=False)
    assert not [name for name in shares(comparison) if "revers" in name or "each way" in name]
    assert "slider 4 position" in shares(comparison)


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
    (circle,) = compare([half], [half.reading_mm]).circles
    assert [part.harmonics for part in circle.directions] == [(), ()]


def test_sum_and_difference_take_the_two_directions_apart(record: Record) -> None:
    angle = np.radians(record.columns["angle_deg"])
    residual_mm = 0.005 * np.cos(2.0 * angle) + 0.003 * record.columns["direction"] * np.sin(angle)
    for circle in compare([record], [record.reading_mm - residual_mm]).circles:
        both = circle.both_ways
        assert both is not None and len(both.angle_rad) == 72
        assert both.sum_mm == pytest.approx(0.005 * np.cos(2.0 * both.angle_rad), abs=1.5e-4)
        assert both.difference_mm == pytest.approx(0.003 * np.sin(both.angle_rad), abs=1.5e-4)


def test_one_direction_has_no_sum(make_record: MakeRecord) -> None:
    record = make_record(flat, directions=(1,))
    assert compare([record], [record.reading_mm]).circles[0].both_ways is None


def test_a_comparison_shows_itself_in_a_notebook(record: Record) -> None:
    comparison = with_residual(record, np.zeros(len(record)))
    frame = comparison.to_frame()
    assert len(frame) == len(record)
    assert (frame["measured_um"] - frame["predicted_um"]).to_numpy() == pytest.approx(frame["residual_um"].to_numpy())
    assert np.array_equal(frame["s4_mm"].to_numpy(), record.columns["s4_mm"])
    shown = comparison._repr_html_()
    assert shown.count("<tr>") == 1 + 8 + 1 + 8
    assert "µm rms" in shown
