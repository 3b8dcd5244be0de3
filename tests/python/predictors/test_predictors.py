"""What hides in a residual is named: the right variable first, with its place, period or instant; noise is not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from types import SimpleNamespace

import numpy as np
import pytest
from tests.truth.cases import case
from tests.truth.plans import PACE

from hexdbb.diagnosis import evaluate_fit
from hexdbb.discovery.judging import judging_noise
from hexdbb.model import new_model
from hexdbb.predictors import Carrier, Columns, Pushes, carriers, sample_columns, sentence, telling
from hexdbb.samples import knowing, samples_of

Columned = Callable[[np.ndarray], Columns]


@lru_cache
def left(name: str) -> tuple[Columns, Pushes, float]:
    """Columns and pushes of a case's residual after a fit of geometry, and the noise."""
    record = case(name, replace(PACE, rate_hz=0.5 * PACE.rate_hz)).record()
    known, noise = knowing(new_model(record.machine), [record]), judging_noise([record]).noise
    fitted, result = evaluate_fit([record], known, known.free, noise)
    samples = samples_of([record], fitted)
    columns = sample_columns([record], [record.name], [record.reading_mm - result.residual_mm], [samples.state])
    return columns, Pushes.of(fitted, samples), noise.sigma_mm


def told(name: str) -> tuple[Carrier, ...]:
    columns, pushes, noise_mm = left(name)
    return tuple(telling(carriers(columns, pushes, noise_mm, beyond_noise=True), 6))


def hidden(name: str) -> SimpleNamespace:
    (only,) = case(name).hidden
    return SimpleNamespace(element=only.element, **only.mechanism.model_dump(exclude={"kind"}))


@pytest.mark.parametrize("name", ["dent-x3-s1", "dent-x3-s2", "dent-x10-s4"])
def test_a_dent_is_named_with_guideway_and_place(name: str) -> None:
    first, truth = told(name)[0], hidden(name)
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
    first, truth = told(name)[0], hidden(name)
    assert first.variable == "time, repeating"
    assert first.period is not None and first.size_um is not None
    assert 1.0 / first.period == pytest.approx(abs(truth.frequency_hz - 48.0), abs=0.002)
    assert first.size_um == pytest.approx(truth.amplitude_um, rel=0.05)
    assert "50 Hz would look so" in sentence(first)


@pytest.mark.parametrize("name", ["loose_cup-x3-s1", "loose_cup-x3-s3", "loose_cup-x10-s10"])
def test_a_cup_that_shifts_is_named_with_the_instant(name: str) -> None:
    first, truth = told(name)[0], hidden(name)
    # Cup and ball shift the reading alike, but for the platform's turns.
    assert first.subject in ("cup", "ball")
    assert first.variable == f"{first.subject}, shifting once"
    assert first.place is not None
    times_s = left(name)[0]["t_s"]
    # The noise may take a few samples more.
    before, after = times_s[times_s < truth.at_s][-20], times_s[times_s >= truth.at_s][20]
    assert before <= first.place.begin < first.place.end <= after


@pytest.mark.parametrize("name", ["stick_slip-x3-s1", "stick_slip-x3-s3", "stick_slip-x3-s5"])
def test_a_burst_of_stick_slip_is_named_with_slider_and_time(name: str) -> None:
    first, truth = told(name)[0], hidden(name)
    assert first.variable == f"slider {truth.element} way of moving, over time"
    assert first.place is not None
    inside = min(first.place.end, truth.begin_s + truth.duration_s) - max(first.place.begin, truth.begin_s)
    assert inside > 0.6 * (first.place.end - first.place.begin)


@pytest.mark.parametrize(
    ("name", "variable"),
    [
        ("guideway_bend-x3-s1", "guideway {} position (vertical), settling with time"),
        ("guideway_bend-x3-s2", "guideway {} position (vertical), settling with time"),
        ("guideway_bend-x3-s12", "guideway {} position (vertical), settling with time"),
        ("encoder_interpolation-x3-s1", "slider {} position, repeating"),
        ("encoder_interpolation-x3-s2", "slider {} position, repeating"),
        ("backlash-x3-s1", "slider {} way of moving"),
        ("reversal_spike-x3-s1", "time since slider {} reversed"),
        ("pitch_cyclic-x3-s3", "slider {} position, repeating"),
    ],
)
def test_the_first_variable_is_the_causes(name: str, variable: str) -> None:
    first = told(name)[0]
    assert first.variable == variable.format(hidden(name).element)
    assert first.share > 0.7


def test_what_repeats_along_a_screw_has_its_period() -> None:
    first, truth = told("encoder_interpolation-x3-s1")[0], hidden("encoder_interpolation-x3-s1")
    assert first.period == pytest.approx(truth.period_um * 1e-3, rel=1e-3)
    assert first.size_um == pytest.approx(truth.amplitude_um, rel=0.05)


def test_shares_fall_and_each_subject_is_named_once() -> None:
    for name in ("dent-x3-s1", "loose_cup-x3-s1"):
        found = told(name)
        shares = [each.share for each in found]
        assert shares == sorted(shares, reverse=True)
        assert 0.0 < shares[-1] <= shares[0] <= 1.0
        assert len({each.subject for each in found}) == len(found)


def columns_with(residual_mm: np.ndarray, columns: Columns) -> Columns:
    return {**columns, "residual_um": residual_mm * 1e3}


@pytest.mark.parametrize("seed", range(3))
def test_noise_is_carried_by_nothing(seed: int) -> None:
    columns, pushes, noise_mm = left("dent-x3-s1")
    white = noise_mm * np.random.default_rng(seed).standard_normal(len(columns["t_s"]))
    found = carriers(columns_with(white, columns), pushes, noise_mm)
    assert max(each.share for each in found) < 0.03
    assert telling(found, 6) in ([], [each for each in found if each.share > 0.02][:1])


def test_a_model_that_is_not_fitted_is_judged_by_the_residual_as_it_stands() -> None:
    """Geometry that a fit would mend is there to be carried, by the angle on each circle for one."""
    columns, pushes, noise_mm = left("dent-x3-s1")
    geometry = pushes.own @ np.full(pushes.own.shape[1], 0.3)
    found = carriers(columns_with(geometry, columns), pushes, noise_mm)
    assert {each.variable: each.share for each in found}["angle, each circle"] > 0.9


def test_without_pushes_a_slider_is_still_seen(make_columns: Columned) -> None:
    columns = make_columns(np.zeros(4000))
    columns["residual_um"] = 3.0 * np.exp(-0.5 * ((columns["s2_mm"] - 420.0) / 6.0) ** 2)
    first = telling(carriers(columns), 6)[0]
    assert first.variable == "slider 2 position"
    assert first.place is not None
    assert 400.0 < first.place.begin < 420.0 < first.place.end < 440.0
    assert first.size_um == pytest.approx(3.0, rel=0.1)


def test_a_step_in_one_of_two_records_is_told_with_the_record(make_columns: Columned) -> None:
    columns = make_columns(np.zeros(4000))
    later = (columns["record"] == "b") & (columns["t_s"] >= 120.0)
    columns["residual_um"] = np.where(later, 2.0, 0.0) + 0.1 * np.random.default_rng(1).standard_normal(4000)
    step = next(each for each in carriers(columns) if each.variable == "time, one shift")
    assert step.place is not None
    assert step.place.begin < 120.0 <= step.place.end < step.place.begin + 0.2
    assert step.place.words.endswith("of b")
    assert step.size_um == pytest.approx(2.0, rel=0.05)
    assert step.share > 0.95


@pytest.fixture
def make_columns() -> Columned:
    """Give two records of slow sines of the sliders, each of its own period."""

    def make(residual_mm: np.ndarray) -> Columns:
        count = len(residual_mm)
        half = count // 2
        turn = np.concatenate([np.arange(half), np.arange(count - half)]) / half
        columns: Columns = {
            "record": np.repeat(["a", "b"], [half, count - half]),
            "t_s": 200.0 * turn,
            "circle": np.zeros(count, int),
            "sweep": np.zeros(count, int),
            "direction": np.ones(count),
            "lap": (4.0 * turn).astype(int),
            "angle_deg": (4.0 * 360.0 * turn) % 360.0,
            "feed_mm_min": np.full(count, 1000.0),
            "residual_um": residual_mm * 1e3,
        }
        columns |= {f"s{k}_mm": 400.0 + 100.0 * np.sin(2.0 * np.pi * (3.1 + 0.7 * k) * turn) for k in range(1, 7)}
        return columns

    return make
