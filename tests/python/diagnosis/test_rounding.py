"""Rounding that is the same in all laps counts as noise; other rounding is in the laps' differences already."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from hexdbb.diagnosis import diagnose, noise_of
from hexdbb.diagnosis.rounding import step_mm, with_rounding
from hexdbb.discovery import discover
from hexdbb.model import new_model
from hexdbb.record import Record, read_record
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case

SLIDERS = tuple(f"s{each}_mm" for each in range(1, 7))
STEP_UM = 1.0
UNIFORM_UM = STEP_UM / np.sqrt(12.0)


@pytest.fixture(scope="module")
def clean() -> Record:
    return case("none-calibrate-s1").record()


@cache
def exact_um() -> np.ndarray:
    """Return what a machine with errors of its geometry alone reads, without noise."""
    record = case("none-calibrate-s1").record()
    found = diagnose(Samples.of([record]), new_model(record.machine), check_held_out=False)
    exact: np.ndarray = (found.samples.reading_mm - found.residual_mm) * 1e3
    return exact


def read_to_a_step(record: Record, noise_um: float) -> Samples:
    """Return the samples of a machine whose gauge shows whole micrometres."""
    noisy = exact_um() + np.random.default_rng(3).normal(0.0, noise_um, len(record))
    return Samples.of([replace(record, columns={**record.columns, "reading_um": np.round(noisy / STEP_UM) * STEP_UM})])


@pytest.mark.parametrize("step", [0.1, 0.01, 5e-3, 1e-3, 1e-4, 2e-5])
def test_a_step_is_that_of_the_values(step: float) -> None:
    values = 17.1234567 + step * np.random.default_rng(1).integers(-3000, 3000, 300)
    assert step_mm(values) == pytest.approx(step)


def test_values_that_are_not_rounded_have_none() -> None:
    assert step_mm(np.random.default_rng(1).normal(0.0, 1.0, 300)) == 0.0
    assert step_mm(np.full(300, 2.5)) == 0.0


@pytest.mark.parametrize("noise_um", [0.02, 0.15, 0.5, 2.0])
def test_readings_rounded_to_a_step_are_off_by_noise_and_rounding(clean: Record, noise_um: float) -> None:
    """The lap differences alone would show only a part of this error when the noise is below half a step."""
    samples = read_to_a_step(clean, noise_um)
    assert noise_of(samples).sigma_mm * 1e3 == pytest.approx(np.hypot(noise_um, UNIFORM_UM), rel=0.15)


def test_noise_beyond_a_step_is_as_laps_say(clean: Record) -> None:
    samples = read_to_a_step(clean, 2.0)
    assert with_rounding(samples, 2.0e-3) == 2.0e-3


def test_encoders_that_show_the_same_in_every_lap_add_their_rounding() -> None:
    """A simulator writes commanded positions, to a step of 5 nm here; 10 µm of encoders are 1.5 µm of the reading."""
    record = read_record(Path(__file__).parents[2] / "data" / "foreign" / "socket-ridged.parquet")
    columns = {name: record.columns[name] for name in record.columns if name in SLIDERS}
    assert len(columns) == len(SLIDERS)
    assert with_rounding(Samples.of([record]), 0.5e-3) == 0.5e-3
    rounded = {name: np.round(each, 2) for name, each in columns.items()}
    coarse = Samples.of([replace(record, columns={**record.columns, **rounded})])
    assert 1e-3 < with_rounding(coarse, 0.5e-3) < 5e-3
    assert with_rounding(coarse, 0.1) == 0.1, "what is far below the noise adds nothing"


def test_a_clean_machine_whose_gauge_shows_micrometres_lacks_nothing(clean: Record) -> None:
    samples = read_to_a_step(clean, 0.1)
    assert discover(samples, new_model(clean.machine), known_only=True).verdict == "none"
