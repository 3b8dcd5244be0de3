"""Predictors of a residual: the right variable first, with its place, period or instant; of noise none."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from hexdbb.diagnosis import evaluate_fit, judging_noise
from hexdbb.machine import shipped_machine
from hexdbb.model import new_model
from hexdbb.plan import Circle, Gauge, Mount
from hexdbb.predictors import Predictor, Pushes, main_predictors, rank_predictors, sentence
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE

Made = Callable[[], Samples]


@lru_cache
def left(name: str) -> tuple[Samples, np.ndarray, Pushes, float]:
    """Samples of a case, the residual after a fit of geometry, the pushes, and the noise."""
    samples = Samples.of([case(name, replace(PACE, rate_hz=0.5 * PACE.rate_hz)).record()])
    known, noise = new_model(samples.machine).with_mounts(samples.mounts), judging_noise(samples).noise
    fitted, result = evaluate_fit(samples, known, known.free, noise)
    return samples, result.residual_mm, Pushes.of(samples, fitted), noise.sigma_mm


def found_in(name: str) -> tuple[Predictor, ...]:
    samples, residual_mm, pushes, noise_mm = left(name)
    return tuple(main_predictors(rank_predictors(samples, residual_mm, pushes, noise_mm, beyond_noise=True), 6))


def begin_s(name: str) -> float:
    """Time of the record's first sample, from which the table of samples counts."""
    return float(left(name)[0].records[0].columns["t_s"][0])


def hidden(name: str) -> SimpleNamespace:
    (only,) = case(name).hidden
    return SimpleNamespace(element=only.element, **only.mechanism.model_dump(exclude={"kind"}))


@pytest.mark.parametrize("name", ["dent-x3-s1", "dent-x3-s2", "dent-x10-s4"])
def test_a_dent_is_named_with_guideway_and_place(name: str) -> None:
    first, truth = found_in(name)[0], hidden(name)
    assert first.variable == f"guideway {truth.element} position (vertical)"
    assert first.place is not None and first.size_um is not None
    assert first.place.begin < truth.at_mm < first.place.end
    assert first.place.end - first.place.begin < 6.0 * truth.width_mm
    assert first.size_um == pytest.approx(truth.depth_um, rel=0.15)
    assert first.share > 0.9
    said = sentence(first)
    assert f"between {first.place.begin:.0f} and {first.place.end:.0f} mm" in said and said.endswith(" µm down")


@pytest.mark.parametrize("name", ["mains_pickup-x3-s1", "mains_pickup-x3-s2"])
def test_the_mains_show_as_the_frequency_they_fold_to(name: str) -> None:
    first, truth = found_in(name)[0], hidden(name)
    assert first.variable == "time, repeating"
    assert first.period is not None and first.size_um is not None
    assert 1.0 / first.period == pytest.approx(abs(truth.frequency_hz - 48.0), abs=0.002)
    assert first.size_um == pytest.approx(truth.amplitude_um, rel=0.05)
    assert "50 Hz would alias to it" in sentence(first)


@pytest.mark.parametrize("name", ["loose_cup-x3-s1", "loose_cup-x3-s3", "loose_cup-x10-s10"])
def test_a_cup_that_shifts_is_named_with_the_instant(name: str) -> None:
    first, truth = found_in(name)[0], hidden(name)
    # Cup and ball shift the reading alike, but for the platform's turns.
    assert first.subject in ("cup", "ball")
    assert first.variable == f"{first.subject}, shifting once"
    assert first.place is not None
    times_s = left(name)[0]["time_s"]
    # The noise may take a few samples more.
    at_s = truth.at_s - begin_s(name)
    before, after = times_s[times_s < at_s][-20], times_s[times_s >= at_s][20]
    assert before <= first.place.begin < first.place.end <= after


@pytest.mark.parametrize("name", ["stick_slip-x3-s1", "stick_slip-x3-s3", "stick_slip-x3-s5"])
def test_a_burst_of_stick_slip_is_named_with_slider_and_time(name: str) -> None:
    first, truth = found_in(name)[0], hidden(name)
    assert first.variable == f"slider {truth.element} direction of travel, over time"
    assert first.place is not None
    burst_s = truth.begin_s - begin_s(name)
    inside = min(first.place.end, burst_s + truth.duration_s) - max(first.place.begin, burst_s)
    assert inside > 0.6 * (first.place.end - first.place.begin)


@pytest.mark.parametrize(
    ("name", "variable"),
    [
        ("guideway_bend-x3-s1", "guideway {} position (vertical), settling with time"),
        ("guideway_bend-x3-s2", "guideway {} position (vertical), settling with time"),
        ("guideway_bend-x3-s12", "guideway {} position (vertical), settling with time"),
        ("encoder_interpolation-x3-s1", "slider {} position, repeating"),
        ("encoder_interpolation-x3-s2", "slider {} position, repeating"),
        ("backlash-x3-s1", "slider {} direction of travel"),
        ("reversal_spike-x3-s1", "time since slider {} reversed"),
        ("pitch_cyclic-x3-s3", "slider {} position, repeating"),
    ],
)
def test_the_first_variable_is_the_causes(name: str, variable: str) -> None:
    first = found_in(name)[0]
    assert first.variable == variable.format(hidden(name).element)
    assert first.share > 0.7


def test_what_repeats_along_a_screw_has_its_period() -> None:
    first, truth = found_in("encoder_interpolation-x3-s1")[0], hidden("encoder_interpolation-x3-s1")
    assert first.period == pytest.approx(truth.period_um * 1e-3, rel=1e-3)
    assert first.size_um == pytest.approx(truth.amplitude_um, rel=0.05)


def test_shares_fall_and_each_subject_is_named_once() -> None:
    for name in ("dent-x3-s1", "loose_cup-x3-s1"):
        found = found_in(name)
        shares = [each.share for each in found]
        assert shares == sorted(shares, reverse=True)
        assert 0.0 < shares[-1] <= shares[0] <= 1.0
        assert len({each.subject for each in found}) == len(found)


@pytest.mark.parametrize("seed", range(3))
def test_noise_has_no_predictor(seed: int) -> None:
    samples, _, pushes, noise_mm = left("dent-x3-s1")
    white = noise_mm * np.random.default_rng(seed).standard_normal(len(samples))
    found = rank_predictors(samples, white, pushes, noise_mm)
    assert max(each.share for each in found) < 0.03
    assert main_predictors(found, 6) in ([], [each for each in found if each.share > 0.02][:1])


def test_the_residual_of_a_model_that_is_not_fitted_is_taken_as_it_is() -> None:
    """Geometry that a fit would remove is there to be predicted, by the angle on each circle for one."""
    samples, _, pushes, noise_mm = left("dent-x3-s1")
    geometry_mm = pushes.own @ np.full(pushes.own.shape[1], 0.3)
    found = rank_predictors(samples, geometry_mm, pushes, noise_mm)
    assert {each.variable: each.share for each in found}["angle, each circle"] > 0.9


def test_without_pushes_a_slider_is_still_seen(make_samples: Made) -> None:
    samples = make_samples()
    residual_mm = 0.003 * np.exp(-0.5 * ((samples["sliders_mm"][:, 1] - 420.0) / 6.0) ** 2)
    first = main_predictors(rank_predictors(samples, residual_mm), 6)[0]
    assert first.variable == "slider 2 position"
    assert first.place is not None
    assert 400.0 < first.place.begin < 420.0 < first.place.end < 440.0
    assert first.size_um == pytest.approx(3.0, rel=0.1)


def test_a_step_in_one_of_two_records_is_stated_with_the_record(make_samples: Made) -> None:
    samples = make_samples()
    later = (samples["record"] == 1) & (samples["time_s"] >= 120.0)
    noise_mm = 0.0001 * np.random.default_rng(1).standard_normal(len(samples))
    found = rank_predictors(samples, np.where(later, 0.002, 0.0) + noise_mm)
    step = next(each for each in found if each.variable == "time, one shift")
    assert step.place is not None
    assert step.place.begin < 120.0 <= step.place.end < step.place.begin + 0.2
    assert step.place.words.endswith("of b.parquet")
    assert step.size_um == pytest.approx(2.0, rel=0.05)
    assert step.share > 0.95


@pytest.fixture
def make_samples() -> Made:
    """Return two records of slow sines of the sliders, each of its own period."""

    def one(name: str, count: int = 2000) -> Record:
        turn = np.arange(count) / count
        columns = {
            "t_s": 200.0 * turn,
            "circle": np.zeros(count),
            "sweep": np.zeros(count),
            "direction": np.ones(count),
            "lap": np.floor(4.0 * turn),
            "angle_deg": (4.0 * 360.0 * turn) % 360.0,
            "feed_mm_min": np.full(count, 1000.0),
            "reading_um": np.zeros(count),
        }
        columns |= {f"s{k}_mm": 400.0 + 100.0 * np.sin(2.0 * np.pi * (3.1 + 0.7 * k) * turn) for k in range(1, 7)}
        circle = Circle(id=0, mount=0, radius_mm=100.0, ball_offset_mm=(0.0, 0.0, 60.0))
        mount = Mount(id=0, cup_mm=(0.0, 0.0, 340.0))
        return Record(columns, Gauge(bar_length_mm=100.0), (mount,), (circle,), shipped_machine(), path=Path(name))

    return lambda: Samples.of([one("a.parquet"), one("b.parquet")])
