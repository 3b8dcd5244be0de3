"""A record that no machine and gauge can have given is told, with its rows and what was expected."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from hexdbb.cli.diagnose import command
from hexdbb.machine import CanSetup
from hexdbb.record import Record, doubts, read_record, write_record
from hexdbb.record.plausibility import FEWEST_REPEATS, MOST_REPEATS, frozen_after

FOREIGN = Path(__file__).parents[2] / "data" / "foreign" / "sag-10x.parquet"


@pytest.fixture(scope="module")
def whole() -> Record:
    """A record of a machine and gauge that nobody here built."""
    found = read_record(FOREIGN)
    return replace(found, gauge=found.gauge.model_copy(update={"noise_um": 0.5, "resolution_um": 0.1}))


def changed(record: Record, name: str, rows: slice | int, value: float) -> Record:
    column = record.columns[name].copy()
    column[rows] = value
    return replace(record, columns={**record.columns, name: column})


def told(record: Record) -> list[str]:
    return [str(each) for each in doubts(record)]


def test_a_plausible_record_raises_no_doubt(whole: Record) -> None:
    assert told(whole) == []


def test_a_frozen_gauge_is_told_with_its_rows(whole: Record) -> None:
    sweep = whole.columns["sweep"]
    first = int(np.flatnonzero(sweep == sweep[0])[100])
    frozen = changed(whole, "reading_um", slice(first, first + 300), 17.5)
    (doubt,) = told(frozen)
    assert doubt.startswith(f"rows {first + 1} to {first + 300}: reading_um stays 17.5 µm")
    assert "noise of 0.5 µm" in doubt


def test_a_gauge_stuck_at_zero_does_not_make_a_perfect_machine(whole: Record, tmp_path: Path) -> None:
    stuck = changed(whole, "reading_um", slice(None), 0.0)
    assert "reading_um stays 0 µm" in told(stuck)[0]
    path = tmp_path / "stuck.parquet"
    write_record(stuck, path)
    done = CliRunner().invoke(command, [str(path), "-m", str(tmp_path / "model.toml")])
    assert done.exit_code == 0, done.output
    assert f"warning: {path}: rows 1 to {len(stuck)}: reading_um stays 0 µm" in done.stderr


def test_readings_quieter_than_the_gauge_are_told(whole: Record) -> None:
    smooth = np.cos(np.radians(whole.columns["angle_deg"])) * 40.0
    quiet = replace(whole, columns={**whole.columns, "reading_um": smooth})
    assert any("has a noise of" in each and "0.5 µm as stated" in each for each in told(quiet))


@pytest.mark.parametrize(
    ("column", "by", "what"),
    [
        ("reading_um", 60.0, r"differs from both neighbours by \+(59|60)"),
        ("s3_mm", 2.85, r"differs from both neighbours by \+2\.8"),
    ],
)
def test_one_value_off_is_told_with_its_row(whole: Record, column: str, by: float, what: str) -> None:
    row = int(np.flatnonzero(np.diff(whole.columns["sweep"]) == 0)[500])
    off = changed(whole, column, row, float(whole.columns[column][row]) + by)
    assert any(re.match(f"row {row + 1}: {column} {what}", each) for each in told(off))


def test_a_slider_faster_than_its_limit_is_told(whole: Record) -> None:
    sweep = whole.columns["sweep"]
    row = int(np.flatnonzero(sweep == sweep[0])[400])
    last = int(np.flatnonzero(sweep == sweep[0])[-1]) + 1
    passed_s = float(whole.columns["t_s"][row] - whole.columns["t_s"][row - 1])
    shift_mm = 250.0 * passed_s * 1.2 + 5.0
    column = whole.columns["s2_mm"].copy()
    column[row:last] += shift_mm
    machine = whole.machine.model_copy(update={"can": CanSetup()})
    fast = replace(whole, columns={**whole.columns, "s2_mm": column}, machine=machine)
    assert any(each.startswith(f"row {row + 1}: s2_mm moves at") for each in told(fast))


def test_repetitions_follow_from_noise_and_resolution(whole: Record) -> None:
    def allowed(noise_um: float | None, resolution_um: float) -> int:
        return frozen_after(whole.gauge.model_copy(update={"noise_um": noise_um, "resolution_um": resolution_um}))

    assert allowed(0.5, 0.0) == FEWEST_REPEATS
    assert allowed(None, 0.1) == allowed(0.0, 0.1) == allowed(0.01, 1.0) == MOST_REPEATS
    assert FEWEST_REPEATS < allowed(0.5, 0.5) < allowed(0.5, 1.0) < MOST_REPEATS
    # None of a million seeds of a working gauge repeats so often: ten thousand runs of each length suffice to see it.
    draw = np.random.default_rng(1)
    readings = np.round(draw.normal(0.0, 0.5, 2_000_000) / 0.5) * 0.5
    edges = np.flatnonzero(np.diff(readings) != 0.0)
    assert np.diff(edges).max() < allowed(0.5, 0.5)
